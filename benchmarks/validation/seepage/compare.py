#!/usr/bin/env python3
"""Speed of seepage through dense random arrays compared with published drag laws: compare.py [RUN...] [--table FILE]
[--figure FILE]

RUN: folders of runs of seepage.yaml; each becomes a row of the table (rows of other runs stay). The speed is the
superficial velocity at the end of the run over the one at which a drag law balances the same driving force. The bound
is that of drag_law: the drag between the laws of Beetstra et al. (2007) and Tenneti et al. (2011), or at most 10 %
beyond. Prints the mean over the arrays of each setting, and pass or fail. Exit code 0 if all pass.
"""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import brentq

from thalweg.checks import Verdict
from thalweg.comparison import compared_rows
from thalweg.literature import beetstra_drag, tenneti_drag
from thalweg.random_array import RandomArray

COLUMNS = ["run", "cells [1]", "method", "solid_fraction [1]", "speed [m/s]", "beetstra [m/s]", "tenneti [m/s]"]
ACCEPTED = 0.1   # of the drag
METHODS = ["default", "bgk, as published"]


def speed_of_law(law, array):
    """Superficial velocity U at which spheres with the drag 3 pi eta d U law(phi, U d/nu) hold the driven fluid
    back."""
    phi, viscosity, diameter = array.solid_fraction, array.viscosity, array.diameter
    given = array.acceleration * (1.0 - phi) * array.volume / array.count   # over the fluid's density, per sphere
    return brentq(
        lambda u: 3.0 * np.pi * viscosity * diameter * u * law(phi, u * diameter / viscosity) - given, 1e-9, 1.0
    )


def measured(folder):
    array = RandomArray(folder)
    speed = array.run.series["fluid_momentum_x"][-3:].mean() / (array.density * array.volume)
    laws = [speed_of_law(law, array) for law in (beetstra_drag, tenneti_drag)]
    method = array.case["name"].split(", ", 1)[1]
    values = [array.run.folder.name, f"{array.cells:.4g}", method]
    return dict(zip(COLUMNS, values + [f"{value:.5g}" for value in (array.solid_fraction, speed, *laws)]))


def means(rows):
    """For each number of cells and method: the speed over those of the two laws."""
    settings = {}
    for row in rows:
        settings.setdefault((float(row["cells [1]"]), row["method"]), []).append(
            [float(row[column]) for column in COLUMNS[4:]]
        )
    for (cells, method), values in sorted(settings.items(), key=lambda item: (item[0][0], METHODS.index(item[0][1]))):
        speed, beetstra, tenneti = np.array(values).T
        yield cells, method, len(values), np.mean(speed / beetstra), np.mean(speed / tenneti)


def report(points):
    verdict = Verdict()
    for cells, method, arrays, by_beetstra, by_tenneti in points:
        # Nearly linear at these Reynolds numbers: a drag higher by a tenth is a speed lower by as much.
        good = min(by_beetstra, by_tenneti) <= 1.0 + ACCEPTED and max(by_beetstra, by_tenneti) >= 1.0 - ACCEPTED
        print(
            f"{cells:g} cells, {method}, arrays: {arrays}: speed {by_beetstra:.3f} of Beetstra's, {by_tenneti:.3f} of"
            f" Tenneti's: {verdict(good)}"
        )
    return verdict.exit_code


def draw(points, name):
    figure, axes = plt.subplots(figsize=(6.5, 4.5), layout="constrained")
    for method, marker in zip(METHODS, "os"):
        at = [(cells, speed) for cells, other, _, speed, _ in points if other == method]
        axes.plot(*np.array(at).T, marker=marker, label=method)
    axes.axhline(1.0, color="k", lw=1.0, label="Beetstra et al. 2007")
    axes.set(yscale="log", xlabel="cells per diameter", ylabel="speed of seepage over that of the law")
    axes.grid(color="#e5e8ea", linewidth=0.8)
    axes.legend(fontsize=8)
    figure.savefig(name, dpi=110)
    print(name)


def main():
    rows, figure_name = compared_rows(__doc__, HERE / "seepage.csv", "seepage.png", lambda folder: [measured(folder)])
    points = list(means(rows))
    exit_code = report(points)
    draw(points, figure_name)
    return exit_code


if __name__ == "__main__":
    sys.exit(main())
