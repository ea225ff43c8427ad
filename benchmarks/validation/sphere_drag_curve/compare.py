#!/usr/bin/env python3
"""Drag coefficients of single spheres compared with the standard drag curve: compare.py [RUN...] [--table FILE]
[--figure FILE]

RUN: folders of runs by run.py; each becomes a row of the table (rows of other runs stay). The drag coefficient of a
towed sphere is its mean force over that of the dynamic pressure, from 5.5 diameters of the way on; that of a falling
one follows from its weight in water and its mean speed, from ten diameters on; both end three diameters above the
floor. Errors: python/thalweg/means.py. Prints both beside Brown and Lawler (2003) at the Reynolds number of the run,
and pass or fail (10 %) for 20 cells. Exit code 0 if all that have a bound pass.
"""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

from thalweg import Run
from thalweg.checks import Verdict
from thalweg.comparison import compared_rows
from thalweg.means import mean_with_error

DIAMETER, VISCOSITY, DENSITY, GRAVITY = 5.0e-3, 1.0e-6, 1000.0, 9.81   # m, m^2/s, kg/m^3, m/s^2
COLUMNS = ["run", "kind", "cells [1]", "width [d]", "height [d]", "reynolds_number [1]",
           "drag_coefficient [1]", "error [1]", "independent [1]", "averaged [d]"]
ACCEPTED, BOUND_FROM = 0.10, 20            # cells per diameter
FROM = {"towed": 5.5, "falling": 10.0}     # diameters of the way


def standard_drag(reynolds):
    """Standard drag curve of a sphere, Brown and Lawler (2003), equation 19: Re below 2e5."""
    return 24.0 / reynolds * (1.0 + 0.150 * reynolds**0.681) + 0.407 / (1.0 + 8710.0 / reynolds)


def towed(run, steady):
    tracks = run.tracks
    speed = -float(run.case["grains"][0]["prescribed_velocity"][2])
    mean = mean_with_error(tracks["fluid_force"][steady, 0, 2])
    pressure = 0.5 * DENSITY * speed**2 * np.pi / 4.0 * DIAMETER**2
    return speed, mean.mean / pressure, mean.error / pressure, mean.independent


def falling(run, steady):
    mean = mean_with_error(-run.tracks["velocity"][steady, 0, 2])
    density = float(run.case["grains"][0]["density"])
    drag = 4.0 * (density / DENSITY - 1.0) * GRAVITY * DIAMETER / (3.0 * mean.mean**2)
    return mean.mean, drag, 2.0 * drag * mean.error / mean.mean, mean.independent


def measured(folder):
    run = Run(folder)
    height = run.tracks["position"][:, 0, 2]
    kind = "towed" if "prescribed_velocity" in run.case["grains"][0] else "falling"
    steady = (run.size[2] - 2.0 * DIAMETER - height > FROM[kind] * DIAMETER) & (height > 3.5 * DIAMETER)
    speed, drag, error, independent = (towed if kind == "towed" else falling)(run, steady)
    cells = DIAMETER / float(run.case["domain"]["spacing"])
    values = [run.folder.name, kind, f"{cells:.4g}", f"{run.size[0] / DIAMETER:.3g}", f"{run.size[2] / DIAMETER:.3g}"]
    numbers = speed * DIAMETER / VISCOSITY, drag, error, independent, np.ptp(height[steady]) / DIAMETER
    return dict(zip(COLUMNS, values + [f"{value:.4g}" for value in numbers]))


def report(rows):
    verdict = Verdict()
    for row in sorted(rows, key=lambda row: (row["kind"], float(row["reynolds_number [1]"]))):
        reynolds, drag, error = (float(row[name]) for name in COLUMNS[5:8])
        difference, said = drag / standard_drag(reynolds) - 1.0, ""
        if float(row["cells [1]"]) >= BOUND_FROM:
            said = f": {verdict(abs(difference) <= ACCEPTED)}"
        print(
            f"{row['run']}: {row['kind']}, {row['cells [1]']} cells, Re {reynolds:.0f}: drag coefficient {drag:.3f} +-"
            f" {error:.3f} ({float(row['independent [1]']):.0f} independent values, over {row['averaged [d]']} d),"
            f" standard {standard_drag(reynolds):.3f}, {100 * difference:+.1f} %{said}"
        )
    return verdict.exit_code


def figure(rows, path):
    plt.figure(figsize=(6.5, 4))
    curve = np.geomspace(100.0, 5000.0, 100)
    plt.plot(curve, standard_drag(curve), "k-", label="Brown and Lawler (2003)")
    plt.fill_between(curve, 0.9 * standard_drag(curve), 1.1 * standard_drag(curve), color="0.9")
    colours = {6: "C3", 8: "C1", 10: "C2", 15: "C0", 20: "C4"}
    for cells, colour in colours.items():
        for kind, marker in (("towed", "o"), ("falling", "v")):
            chosen = [row for row in rows if row["kind"] == kind and round(float(row["cells [1]"])) == cells
                      and float(row["width [d]"]) < 5.5]
            if chosen:
                plt.errorbar(*([float(row[name]) for row in chosen] for name in COLUMNS[5:7]),
                             yerr=[float(row["error [1]"]) for row in chosen], fmt=marker, color=colour,
                             label=f"{kind}, {cells} cells")
    plt.xscale("log")
    plt.yscale("log")
    plt.yticks([0.3, 0.4, 0.5, 0.6, 0.8, 1.0], ["0.3", "0.4", "0.5", "0.6", "0.8", "1.0"])
    plt.minorticks_off()
    plt.xticks([100, 300, 1000, 3000], ["100", "300", "1000", "3000"])
    plt.xlabel("Reynolds number, U d / nu")
    plt.ylabel("drag coefficient")
    plt.legend(fontsize=7, ncol=2)
    plt.tight_layout()
    plt.savefig(path, dpi=110)


def main():
    rows, name = compared_rows(__doc__, HERE / "drag.csv", "sphere_drag_curve.png", lambda folder: [measured(folder)])
    exit_code = report(rows)
    figure(rows, name)
    return exit_code


if __name__ == "__main__":
    sys.exit(main())
