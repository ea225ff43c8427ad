#!/usr/bin/env python3
"""Slopes behind the step: angle.py RUN [RUN ...] [--figure FILE]"""
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import numpy as np
from matplotlib import pyplot

from thalweg.drawing import draw_outlines
from thalweg.plan_view import upper_sides
from thalweg.run import read_bed

STEP, WIDTH = (0.08, 0.02), 0.030  # m: the upper edge of the step, and the period across
PIXEL = 1e-3                       # m
FITTED = (0.010, 0.070)            # m: away from the wall and from the toe


def spheres(run):
    """Centres and radii (m) of the grains behind the step, or of their members."""
    bed = read_bed(run / "bed.h5")
    behind = bed["position"][:, 0] < STEP[0]
    return bed["position"][behind], bed["radius"][behind]


def surface(run):
    """x and the height (m) of the upper sides of the grains above the edge of the step, mean across."""
    x, y = PIXEL * (np.arange(round(STEP[0] / PIXEL)) + 0.5), PIXEL * (np.arange(round(WIDTH / PIXEL)) + 0.5)
    return x, upper_sides(*spheres(run), x, y, (None, WIDTH)).mean(axis=1) - STEP[1]


def line(x, height):
    """Slope and height at x = 0 (m) of the straight line through the surface."""
    fitted = (x > FITTED[0]) & (x < FITTED[1])
    return np.polyfit(x[fitted], height[fitted], 1)


def draw(file, runs):
    figure, all_axes = pyplot.subplots(1, len(runs), figsize=(2.6 * len(runs), 2.7), layout="constrained", sharey=True)
    for axes, run in zip(np.atleast_1d(all_axes), runs):
        draw_outlines(axes, *spheres(run), linewidth=0.2)
        slope, crest = line(*surface(run))
        axes.plot([0, 1e3 * STEP[0]], 1e3 * (STEP[1] + crest + np.array([0, slope * STEP[0]])), color="#1f4e79")
        axes.fill_between([1e3 * STEP[0], 110], 0, 1e3 * STEP[1], color="0.4")
        axes.set(xlim=(0, 110), ylim=(0, 95), aspect="equal", xlabel="x (mm)",
                 title=f"{run.name}, {np.degrees(np.arctan(-slope)):.1f}°")
    np.atleast_1d(all_axes)[0].set_ylabel("height (mm)")
    figure.savefig(file, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=pathlib.Path, nargs="+")
    parser.add_argument("--figure", type=pathlib.Path, help="draw the slopes side by side")
    arguments = parser.parse_args()
    for run in arguments.run:
        slope, crest = line(*surface(run))
        print(f"{run}: {np.degrees(np.arctan(-slope)):.1f} degrees, {1e3 * crest:.1f} mm high")
    if arguments.figure:
        draw(arguments.figure, arguments.run)


if __name__ == "__main__":
    main()
