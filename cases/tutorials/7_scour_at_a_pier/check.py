#!/usr/bin/env python3
"""Finds the scour hole of tutorial 7 and the vortex in front of the pier, and draws them."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

import pier
from pier import RADIUS
from thalweg.checks import check_main
from thalweg.plan_view import upper_sides
from thalweg.run import Run

PIER = np.array([pier.X, pier.Y])                  # m
AT_REST = 0.03                                     # m/s: slower grains are bed
PIXEL = 1e-3                                       # m


def grid_of(run):
    """Middles of the pixels along x and along y, and each pixel's distance (m) from the axis of the pier."""
    x, y = (PIXEL * (np.arange(round(length / PIXEL)) + 0.5) for length in run.size[:2])
    return x, y, np.hypot(x[None, :] - PIER[0], y[:, None] - PIER[1])


def surface_of(run, frame, x, y):
    """Height (m) of the upper sides of grains at rest as [y, x], on periodic axes."""
    bed = np.linalg.norm(frame.velocity, axis=1) <= AT_REST
    return upper_sides(frame.position[bed], frame.radius[bed], x, y, run.size[:2]).T


def depths_of(run):
    """Times, and how far (m) the bed at the sides of the pier has sunk against the bed away from it since the start, as
    mean of five frames. Sides: within one and a half grains of the pier, where the flow is fastest, 45 to 135 degrees
    from its direction."""
    x, y, distance = grid_of(run)
    along, across = np.abs(x[None, :] - PIER[0]), np.abs(y[:, None] - PIER[1])
    sides, away = (distance > RADIUS) & (distance < RADIUS + 7.5e-3) & (across > along), distance > 2.5 * RADIUS
    times, depths = [], []
    for frame in run.grains:
        heights = surface_of(run, frame, x, y)
        times.append(frame.time)
        depths.append(heights[away].mean() - heights[sides].mean())
    depths = np.array(depths) - depths[0]
    return np.array(times), np.convolve(np.pad(depths, 2, mode="edge"), np.full(5, 0.2), mode="valid")


def flow_in_front(run):
    """Times, the downward velocity (m/s) at the upstream face of the pier, and the backward velocity in front of its
    foot."""
    times, down, back = [], [], []
    for frame in run.fluid:
        velocity, water = frame.arrays["velocity"][:, 0].astype(float), frame.arrays["grain_id"][:, 0] == -1
        x = frame.corner[0] + frame.spacing[0] * (np.arange(velocity.shape[1]) + 0.5)
        z = frame.corner[2] + frame.spacing[2] * (np.arange(velocity.shape[0]) + 0.5)
        front = PIER[0] - RADIUS
        face = water & (x > front - 2.5e-3) & (x < front) & (z[:, None] > 25e-3) & (z[:, None] < 45e-3)
        foot = water & (x > front - 5e-3) & (x < front) & (z[:, None] > 15e-3) & (z[:, None] < 25e-3)
        times.append(frame.time)
        down.append(-velocity[face][:, 2].mean())
        back.append(-velocity[foot][:, 0].min())
    return np.array(times), np.array(down), np.array(back)


def draw(run, depths, flow, path):
    figure, (plan, graph) = plt.subplots(1, 2, figsize=(10.5, 3.6), layout="constrained")
    x, y, distance = grid_of(run)
    heights = np.mean([surface_of(run, frame, x, y) for frame in list(run.grains)[-10:]], axis=0)
    image = plan.imshow(
        np.ma.masked_where(distance < RADIUS, 1e3 * heights), origin="lower", cmap="terrain", vmin=8, vmax=30,
        extent=(0, 1e3 * run.size[0], 0, 1e3 * run.size[1]),
    )
    plan.add_patch(plt.Circle(1e3 * PIER, 1e3 * RADIUS, color="0.4"))
    plan.set(xlabel="x [mm], flow to the right", ylabel="y [mm]", title="height of the bed [mm], last 0.4 s")
    figure.colorbar(image, ax=plan, shrink=0.8)
    graph.plot(depths[0], 1e3 * depths[1], color="#14496e")
    graph.set(xlabel="time [s]", ylabel="bed at the sides of the pier, lower by [mm]", ylim=(0, 5))
    graph.yaxis.label.set_color("#14496e")
    speeds = graph.twinx()
    speeds.plot(flow[0], 1e2 * flow[1], "o-", ms=3, lw=0.8, color="#c0392b", label="down the face of the pier")
    speeds.plot(flow[0], 1e2 * flow[2], "s-", ms=3, lw=0.8, color="#d98c2b", label="back in front of its foot")
    speeds.set(ylabel="water [cm/s]")
    speeds.legend(frameon=False, fontsize=8, loc="upper left", ncols=2)
    figure.savefig(path, dpi=110)


def check(checks, folder, figure):
    run = Run(folder)
    checks.finished(run)
    depths, flow = depths_of(run), flow_in_front(run)
    last, moving = depths[0] > depths[0][-1] - 0.5, flow[0] > 0.5
    hole = depths[1][last].mean()
    checks.expect("bed at the sides of the pier, lower than at the start by", 1e3 * hole, 1.0, 4.0, "mm")
    checks.compare(
        "the same in diameters of the pier", hole / (2 * RADIUS), 1.3, "equilibrium after days: Melville and Sutherland",
    )
    checks.expect("water down the face", 1e2 * flow[1][moving].mean(), 4.0, 12.0, "cm/s")
    checks.expect("water back in front of the foot", 1e2 * flow[2][moving].mean(), 3.0, 15.0, "cm/s")
    if figure:
        draw(run, depths, flow, figure)


if __name__ == "__main__":
    sys.exit(check_main(__doc__, check, ["run/pier"], figure=True))
