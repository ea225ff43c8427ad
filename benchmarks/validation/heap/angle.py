#!/usr/bin/env python3
"""Angle of repose of heaps on a plate: angle.py RUN [RUN ...] [--figure FILE]"""
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import numpy as np
from matplotlib import pyplot

from thalweg.drawing import draw_outlines
from thalweg.run import read_bed

PLATE = (0.006, 0.046)  # m: its ends; the crest is half-way between
TOP = 0.04              # m
COLUMN, WIDTH = 1e-3, 0.012  # m: columns in which the highest grain is looked for, and the period across
MEASURED, BOUND = 25.2, 3.0  # degrees: Sunday et al. 2020; how much like heaps differ, Zhou et al. 2002
FITTED = (0.15, 0.85)   # of the way from crest to edge: the crest is round, and grains are missing at the edge


def surface(run):
    """Distance from the crest and height of the surface (m; of the highest grains, mean across), and number of
    grains."""
    bed = read_bed(run / "bed.h5")
    place, radius = bed["position"], bed["radius"]
    on_plate = place[:, 2] > TOP
    column = np.floor(place[on_plate, 0] / COLUMN).astype(int)
    row = np.floor(place[on_plate, 1] / COLUMN).astype(int) % round(WIDTH / COLUMN)
    highest = np.full((column.max() + 1, row.max() + 1), TOP)
    np.maximum.at(highest, (column, row), place[on_plate, 2] + radius[on_plate])
    x = (np.arange(highest.shape[0]) + 0.5) * COLUMN
    inside = (x > PLATE[0]) & (x < PLATE[1])
    return x[inside] - 0.5 * sum(PLATE), highest[inside].mean(axis=1) - TOP, on_plate.sum()


def flanks(x, height):
    """Straight lines through the left and the right flank: side, slope outwards and height at the crest."""
    half = 0.5 * (PLATE[1] - PLATE[0])
    for side in (-1.0, 1.0):
        fitted = (side * x > FITTED[0] * half) & (side * x < FITTED[1] * half)
        yield side, *np.polyfit(side * x[fitted], height[fitted], 1)


def draw(file, runs):
    """Side view of the first heap, with the lines fitted to all heaps."""
    bed = read_bed(runs[0] / "bed.h5")
    figure, axes = pyplot.subplots(figsize=(8, 3.6), layout="constrained")
    draw_outlines(axes, bed["position"] - [0.5 * sum(PLATE), 0.0, TOP], bed["radius"], linewidth=0.3)
    reach = np.array([0.0, 0.5e3 * (PLATE[1] - PLATE[0])])
    for run in runs:
        for side, slope, crest in flanks(*surface(run)[:2]):
            axes.plot(side * reach, 1e3 * crest + slope * reach, color="#1f4e79", linewidth=1)
    axes.set(xlim=(-26, 26), ylim=(-3, 13), aspect="equal", xlabel="distance from the crest (mm)",
             ylabel="height (mm)")
    figure.savefig(file, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=pathlib.Path, nargs="+")
    parser.add_argument("--figure", type=pathlib.Path, help="draw the first heap and the lines of all")
    arguments = parser.parse_args()
    found = []
    for run in arguments.run:
        x, height, grains = surface(run)
        left, right = (np.degrees(np.arctan(-slope)) for _, slope, _ in flanks(x, height))
        found += [left, right]
        print(f"{run}: {left:.1f} and {right:.1f} degrees, {grains} grains on the plate")
    mean = np.mean(found)
    print(f"mean {mean:.1f} degrees, standard deviation {np.std(found, ddof=1):.1f} "
          f"(glass beads {MEASURED:g}, bound {BOUND:g})")
    if arguments.figure:
        draw(arguments.figure, arguments.run)
    return 0 if abs(mean - MEASURED) <= BOUND else 1


if __name__ == "__main__":
    sys.exit(main())
