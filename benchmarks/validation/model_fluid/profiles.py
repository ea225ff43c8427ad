#!/usr/bin/env python3
"""Profiles of beds in motion beside figure 6 of Clark et al. (2017): profiles.py [RUN...] [--table FILE] [--figure
FILE]

RUN: folders of runs of profiles.yaml, whose profiles go into the table (one row a run and height; those of other runs
in it stay). The second half of each run is averaged. Prints, by Re_*, the height that grains in motion reach above the
top of the bed, and in the mobile region the ratio of grain and fluid velocity and the acceleration; and what the paper
says of each. Exit code 0 if all is as there.

The velocity of the fluid at a grain follows from the fluid force on it, and the solid fraction from that velocity.
"""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

from thalweg import Run
from thalweg.comparison import compared_rows
from thalweg.tables import HEADING

BIN = 0.25         # D
TOP_FRACTION = 0.42   # of the grains of the top layer (figure 4 of the paper)
MOBILE = 0.25      # D above the top of the bed; in the paper 5.25 D above the floor, under beds 5 D high
MOVING = 0.1       # of v_0: grains that are faster are in motion, for the height they reach
COLUMNS = [
    "run", "reynolds_number [1]", "shields_number [1]", "z [D]", "grains [1]", "solid_fraction [1]", "v_grain [v_0]",
    "v_fluid [v_0]", "acceleration [shields_number g']",
]


class Fluid:
    """The coefficients of a case in grain units (docs/theory.md, section 4b)."""

    def __init__(self, keys):
        self.shields, self.reynolds = float(keys["shields_number"]), float(keys["reynolds_number"])
        self.viscous = np.sqrt(3.0 * self.shields) / self.reynolds
        self.inertial = 0.0 if keys["drag"] == "linear" else float(keys.get("inertial_coefficient", 0.5))
        weight = 1.5 * self.shields
        self.velocity = 2.0 * weight / (self.viscous + np.sqrt(self.viscous**2 + 4.0 * self.inertial * weight))

    def relative_velocity(self, force, size):
        """Of the fluid at grains of these sizes (D) that feel these forces (m g'), as [grain, axis]."""
        b1, b2 = self.viscous * size, self.inertial * size**2
        drag = np.linalg.norm(force, axis=1)
        speed = 2.0 * drag / (b1 + np.sqrt(b1**2 + 4.0 * b2 * drag))
        return force / (b1 + b2 * speed)[:, None]

    @staticmethod
    def solid_fraction(velocity):
        """From the velocity of the fluid over v_0, of spheres."""
        b, top, densest = 5.0, 0.42, 0.7
        least = np.exp(-b * densest)
        return -np.log(least + velocity * (np.exp(-b * top) - least)) / b


def samples(run):
    """One row a grain and frame of the second half: z, solid fraction, grain and fluid velocity over v_0,
    acceleration."""
    fluid = Fluid(run.case["model_fluid"])
    density = float(run.case["grains"][0]["density"])
    half = 0.5 * run.grains[-1].time
    rows = []
    for frame in run.grains:
        if frame.time < half:
            continue
        w = fluid.relative_velocity(frame.fluid_force, frame.diameter)
        of_fluid = (w[:, 0] + frame.velocity[:, 0]) / fluid.velocity
        acceleration = (frame.fluid_force[:, 0] + frame.contact_force[:, 0]) / (density * frame.volume * fluid.shields)
        rows.append(np.column_stack([frame.position[:, 2], fluid.solid_fraction(of_fluid),
                                     frame.velocity[:, 0] / fluid.velocity, of_fluid, acceleration]))
    return fluid, np.vstack(rows)


def profile(folder):
    run = Run(folder)
    fluid, rows = samples(run)
    layer = np.floor(rows[:, 0] / BIN).astype(int)
    table = []
    for number in np.unique(layer):
        here = rows[layer == number]
        values = [fluid.reynolds, fluid.shields, (number + 0.5) * BIN, len(here), *here[:, 1:].mean(axis=0)]
        table.append(dict(zip(COLUMNS, [run.folder.name] + [f"{value:.6g}" for value in values])))
    return table


def columns_of(rows):
    names = {head: HEADING.match(head)[1] for head in COLUMNS[1:]}
    return {name: np.array([float(row[head]) for row in rows]) for head, name in names.items()}


def top_of(column):
    """Of the bed, D: half a diameter above where the solid fraction is that of the top layer."""
    dense = np.flatnonzero(column["solid_fraction"] > TOP_FRACTION)[-1]
    here, above = slice(dense, dense + 2), column["solid_fraction"][dense:dense + 2]
    return 0.5 + np.interp(-TOP_FRACTION, -above, column["z"][here])


def means(column):
    """(height above the top that grains in motion reach, v_grain/v_fluid and acceleration of the mobile region), by
    numbers of grains."""
    height = column["z"] - top_of(column)
    mobile = height > MOBILE
    count = column["grains"][mobile]
    grain, fluid, acceleration = (np.sum(count * column[name][mobile]) / np.sum(count)
                                  for name in ("v_grain", "v_fluid", "acceleration"))
    return height[column["v_grain"] > MOVING].max(), grain / fluid, acceleration


def draw(profiles, figure):
    panels, axes = plt.subplots(1, 4, figsize=(15, 4.2), layout="constrained")
    colours = plt.cm.viridis(np.linspace(0.0, 0.9, len(profiles)))
    for (reynolds, column), colour in zip(profiles.items(), colours):
        label = f"Re$_*$ {reynolds:g}"
        axes[0].plot(column["solid_fraction"], column["z"], color=colour, label=label)
        axes[1].plot(column["v_grain"], column["z"], color=colour, label=label)
        axes[1].plot(column["v_fluid"], column["z"], color=colour, ls="--")
        axes[2].plot(column["acceleration"], column["z"], color=colour)
    numbers = np.array(list(profiles))
    highest, ratio, acceleration = np.array([means(column) for column in profiles.values()]).T
    axes[3].plot(numbers, ratio, "ks-", label="v$_{grain}$/v$_{fluid}$ of the mobile region")
    axes[3].plot(numbers, acceleration / 10.0, "bo-", mfc="none", label="its acceleration/(10 Θg')")
    axes[3].plot(numbers, highest, "r^-", mfc="none", label="highest grains in motion, D above the bed")
    axes[3].set(xscale="log", xlabel="Re$_*$, as printed")
    axes[0].set(xlabel="solid fraction around grains", ylabel="z/D")
    axes[1].set(xlabel="velocity over v$_0$ (dashed: fluid)", xlim=(0.0, 4.0))
    axes[2].set(xlabel="acceleration over Θg'")
    for panel in axes:
        panel.grid(color="#e5e8ea", linewidth=0.8)
    for panel in (axes[0], axes[3]):
        panel.legend(fontsize=8)
    panels.savefig(figure, dpi=110)


def main():
    rows, figure_name = compared_rows(__doc__, HERE / "profiles.csv", "profiles.png", profile)
    numbers = sorted({float(row[COLUMNS[1]]) for row in rows})
    profiles = {number: columns_of([row for row in rows if float(row[COLUMNS[1]]) == number]) for number in numbers}
    found = np.array([means(column) for column in profiles.values()])
    print("Re_*      highest in motion, D above the bed   v_grain/v_fluid   acceleration/(Theta g')")
    for number, (highest, ratio, acceleration) in zip(numbers, found):
        print(f"{number:<8g}  {highest:34.2f}   {ratio:15.2f}   {acceleration:23.3f}")
    draw(profiles, figure_name)
    print(figure_name)
    first, last = found[0], found[-1]
    of_the_paper = {"fast grains are carried higher": last[0] > first[0],   # section III B
                    "they are accelerated, slow ones hardly": last[2] > 10.0 * abs(first[2]),
                    "v_grain/v_fluid falls as Re_* rises": last[1] < first[1]}
    for statement, holds in of_the_paper.items():
        print(f"{statement}: {'as in the paper' if holds else 'NOT so here'}")
    return 0 if all(of_the_paper.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
