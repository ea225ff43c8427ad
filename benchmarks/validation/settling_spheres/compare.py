#!/usr/bin/env python3
"""Compares settling spheres with Uhlmann and Dusek (2014): compare.py [RUN...] [--table FILE] [--figure FILE]

RUN: folders of runs by run.py; each becomes a row of the table (rows of other runs stay), and the figure shows their
velocities. Velocities are means over the last 40 % of the way (in a run that begins with the flow of another one,
after four diameters of it), in u_ref = sqrt((s - 1) g d), with their error by python/thalweg/means.py. Prints the
Reynolds number, the reference, the difference, what the path is like, and pass or fail (3 %) for 20 cells. Exit code
0 if all that have a bound pass.

The path is vertical where the horizontal velocity is below 0.03 u_ref on average, else oblique; steady where the
vertical velocity deviates by less than 0.01 u_ref from its mean (root mean square), else unsteady.
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
from thalweg.tables import read_rows

GRAVITY, BELOW_TOP = 9.81, 2.0   # m/s^2; diameters, where the way begins
COLUMNS = ["run", "galileo_number [1]", "cells [1]", "collision", "height [d]", "averaged [d]",
           "vertical_velocity [u_ref]", "error [u_ref]", "deviation [u_ref]", "horizontal_velocity [u_ref]"]
ACCEPTED, BOUND_FROM, LATE = 0.03, 20, 0.4
VERTICAL, STEADY = 0.03, 0.01    # u_ref
ADAPTED = 4.0                    # diameters, after which a run that begins with the flow of another one counts


def history(folder):
    """Run, way (diameters), time (d/u_ref), vertical and horizontal velocity (u_ref), Galileo number."""
    run = Run(folder)
    grain, fluid = run.case["grains"][0], run.case["fluid"]
    diameter = float(grain["diameter"])
    speed = np.sqrt((float(grain["density"]) / float(fluid["density"]) - 1.0) * GRAVITY * diameter)
    tracks = run.tracks
    way = (run.size[2] - tracks["position"][:, 0, 2]) / diameter - BELOW_TOP
    velocity = tracks["velocity"][:, 0] / speed
    return (run, way, tracks["time"] * speed / diameter, -velocity[:, 2], np.hypot(velocity[:, 0], velocity[:, 1]),
            speed * diameter / float(fluid["kinematic_viscosity"]))


def measured(folder):
    run, way, _, vertical, horizontal, galileo = history(folder)
    late = way >= max((1.0 - LATE) * way[-1], way[0] + ADAPTED)
    mean = mean_with_error(vertical[late])
    diameter, spacing = float(run.case["grains"][0]["diameter"]), float(run.case["domain"]["spacing"])
    values = [run.folder.name, f"{galileo:.5g}", f"{diameter / spacing:.3g}", run.case["fluid"]["collision"]]
    numbers = run.size[2] / diameter, np.ptp(way[late]), mean.mean, mean.error, mean.deviation, horizontal[late].mean()
    return dict(zip(COLUMNS, values + [f"{value:.4g}" for value in numbers]))


def reynolds_number(row, reference):
    """As the reference has it: of the magnitude of the velocity where that has a horizontal part, else of the vertical
    one."""
    vertical, horizontal = float(row["vertical_velocity [u_ref]"]), float(row["horizontal_velocity [u_ref]"])
    velocity = np.hypot(vertical, horizontal) if reference["horizontal_velocity [u_ref]"] else vertical
    return float(row["galileo_number [1]"]) * velocity


def path(row):
    steady = float(row["deviation [u_ref]"]) < STEADY
    vertical = float(row["horizontal_velocity [u_ref]"]) < VERTICAL
    return f"{'steady' if steady else 'unsteady'} {'vertical' if vertical else 'oblique'}"


def report(rows, references):
    verdict = Verdict()
    for row in sorted(rows, key=lambda row: (float(row["galileo_number [1]"]), float(row["cells [1]"]))):
        reference = nearest(references, row)
        reynolds, expected, said = reynolds_number(row, reference), float(reference["reynolds_number [1]"]), ""
        if float(row["cells [1]"]) >= BOUND_FROM:
            said = f": {verdict(abs(reynolds / expected - 1.0) <= ACCEPTED)}"
        vertical, horizontal = float(row["vertical_velocity [u_ref]"]), float(row["horizontal_velocity [u_ref]"])
        angle, error, deviation = np.degrees(np.arctan(horizontal / vertical)), *(
            float(row[name]) for name in COLUMNS[7:9]
        )
        print(
            f"{row['run']}: {row['cells [1]']} cells, {row['collision']}: Re {reynolds:.1f}, reference {expected:.1f},"
            f" {100 * (reynolds / expected - 1):+.1f} %; vertical {vertical:.3f} +- {error:.3f}, deviation"
            f" {deviation:.3f}, horizontal {horizontal:.3f}, {angle:.1f} degrees,"
            f" {path(row)} ({reference['regime']}){said}"
        )
    return verdict.exit_code


def nearest(references, row):
    return min(references, key=lambda entry: abs(float(entry["galileo_number [1]"]) - float(row["galileo_number [1]"])))


def draw(folders, references, name):
    numbers = [float(entry["galileo_number [1]"]) for entry in references]
    figure, axes = plt.subplots(2, len(numbers), figsize=(11, 5), sharex="col", sharey="row", constrained_layout=True)
    for folder in folders:
        run, way, _, vertical, horizontal, galileo = history(folder)
        column = int(np.argmin(np.abs(np.array(numbers) - galileo)))
        cells = float(run.case["grains"][0]["diameter"]) / float(run.case["domain"]["spacing"])
        collision = run.case["fluid"]["collision"]
        colour = {8: "C1", 10: "C2", 15: "C0", 20: "C4"}[round(cells)]
        style = dict(color=colour, linestyle="-" if collision == "trt_at_bodies" else "--", linewidth=1.0,
                     label=f"{cells:.0f} cells" + ("" if collision == "trt_at_bodies" else f", {collision}"))
        axes[0, column].plot(way, vertical, **style)
        axes[1, column].plot(way, horizontal, **style)
    for column, entry in enumerate(references):
        axes[0, column].set_title(f"Ga = {numbers[column]:g}: {entry['regime']}", fontsize=9)
        axes[0, column].axhline(float(entry["vertical_velocity [u_ref]"]), color="k", linewidth=0.8)
        if entry["horizontal_velocity [u_ref]"]:
            axes[1, column].axhline(float(entry["horizontal_velocity [u_ref]"]), color="k", linewidth=0.8)
        axes[1, column].set_xlabel("way [d]")
        if axes[0, column].lines[:-1]:
            axes[0, column].legend(fontsize=7, loc="lower right")
    axes[0, 0].set_ylabel("vertical velocity [u_ref]")
    axes[1, 0].set_ylabel("horizontal velocity [u_ref]")
    axes[0, 0].set_ylim(0.7, 1.6)
    axes[1, 0].set_ylim(0.0, 0.3)
    figure.savefig(name, dpi=100)


def main():
    rows, figure = compared_rows(__doc__, HERE / "velocities.csv", "settling_spheres.png",
                                 lambda folder: [measured(folder)])
    references = read_rows(HERE / "reference.csv")
    exit_code = report(rows, references)
    folders = [argument for argument in sys.argv[1:] if (Path(argument) / "tracks.h5").exists()]
    if folders:
        draw(folders, references, figure)
    return exit_code


if __name__ == "__main__":
    sys.exit(main())
