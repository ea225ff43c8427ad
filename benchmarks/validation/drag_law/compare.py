#!/usr/bin/env python3
"""Drag on random arrays of spheres compared with published drag laws: compare.py [RUN...] [--table FILE] [--figure
FILE]

RUN: folders of runs of drag_law.yaml; each becomes a row of the table (rows of other runs stay). F is the force on a
sphere without the part from the mean pressure gradient, over 3 pi eta d U with the superficial velocity U. The force is
the driving force on the fluid minus the part that accelerates it, per sphere, over the last half of the run. Prints the
mean over the arrays of each setting with its standard error, Beetstra et al. (2007) and Tenneti et al. (2011), and pass
or fail. Exit code 0 if all pass.
"""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

from thalweg.checks import Verdict
from thalweg.comparison import compared_rows
from thalweg.literature import beetstra_drag, tenneti_drag
from thalweg.random_array import RandomArray

COLUMNS = ["run", "setting", "cells [1]", "collision", "solid_fraction [1]", "reynolds_number [1]", "drag [1]"]
# Between the two laws, or beyond them by as much as their authors' own data scatter.
ACCEPTED = 0.1


def measured(folder):
    array = RandomArray(folder)
    run, phi, mass = array.run, array.solid_fraction, array.density * array.volume
    time, momentum = run.series["time"], run.series["fluid_momentum_x"]
    later = time >= 0.5 * time[-1]
    time, momentum = time[later], momentum[later]
    velocity = np.trapz(momentum, time) / (time[-1] - time[0]) / mass
    acceleration = (momentum[-1] - momentum[0]) / (time[-1] - time[0])
    driving = mass * array.acceleration * (1.0 - phi)
    stokes = 3.0 * np.pi * array.density * array.viscosity * array.diameter * velocity
    values = [run.folder.name, array.case["name"], f"{array.cells:.4g}", array.case["fluid"]["collision"]]
    numbers = phi, velocity * array.diameter / array.viscosity, (driving - acceleration) / array.count / stokes
    return dict(zip(COLUMNS, values + [f"{value:.6g}" for value in numbers]))


def means(rows):
    """For each setting: cells, collision, solid fraction, Reynolds number, drag and its standard error."""
    settings = {}
    for row in rows:
        settings.setdefault((row["setting"], float(row["cells [1]"]), row["collision"]), []).append(
            [float(row[column]) for column in COLUMNS[4:]])
    for (_, cells, collision), values in settings.items():
        phi, reynolds, drag = np.mean(values, axis=0)
        error = np.std(np.array(values)[:, 2], ddof=1) / np.sqrt(len(values)) if len(values) > 1 else np.nan
        yield cells, collision, phi, reynolds, drag, error


def report(points):
    verdict = Verdict()
    for cells, collision, phi, reynolds, drag, error in points:
        laws = beetstra_drag(phi, reynolds), tenneti_drag(phi, reynolds)
        good = min(laws) * (1.0 - ACCEPTED) <= drag <= max(laws) * (1.0 + ACCEPTED)
        print(
            f"solid fraction {phi:.3f}, Re {reynolds:6.4g}, {cells:g} cells, {collision}: F {drag:.2f} +- {error:.2f};"
            f" Beetstra {laws[0]:.2f} ({100 * (drag / laws[0] - 1):+.0f} %), Tenneti"
            f" {laws[1]:.2f} ({100 * (drag / laws[1] - 1):+.0f} %): {verdict(good)}"
        )
    return verdict.exit_code


def draw(points, name):
    figure, axes = plt.subplots(figsize=(7, 5), layout="constrained")
    reynolds = np.logspace(-1.5, 2.6, 200)
    points = np.array([[p[2], p[3], p[4], p[5]] for p in points])
    fractions = np.unique(np.round(points[:, 0], 1))
    for fraction, colour in zip(fractions, plt.cm.viridis(np.linspace(0.0, 0.9, len(fractions)))):
        near = points[np.isclose(points[:, 0], fraction, atol=0.03)]
        axes.errorbar(near[:, 1], near[:, 2], near[:, 3], fmt="o", color=colour, capsize=3, label=f"φ = {fraction:g}")
        axes.plot(reynolds, beetstra_drag(near[:, 0].mean(), reynolds), color=colour, lw=1.0)
        axes.plot(reynolds, tenneti_drag(near[:, 0].mean(), reynolds), color=colour, lw=1.0, ls="--")
    axes.plot([], [], "k-", lw=1.0, label="Beetstra et al. 2007")
    axes.plot([], [], "k--", lw=1.0, label="Tenneti et al. 2011")
    axes.set(xscale="log", yscale="log", xlabel="Reynolds number U d/ν", ylabel="drag F over 3πηdU")
    axes.grid(color="#e5e8ea", linewidth=0.8)
    axes.legend(fontsize=8, ncols=2)
    figure.savefig(name, dpi=110)
    print(name)


def main():
    rows, figure_name = compared_rows(__doc__, HERE / "drag.csv", "drag_law.png", lambda folder: [measured(folder)])
    points = sorted(means(rows), key=lambda point: (round(point[2], 1), point[3]))
    exit_code = report(points)
    draw(points, figure_name)
    return exit_code


if __name__ == "__main__":
    sys.exit(main())
