#!/usr/bin/env python3
"""Compares spheres settling in water with Schiller and Naumann: compare.py RUN_FOLDER... [--figure FILE]

The terminal velocity is the mean over the fall from the tenth diameter to three diameters above the floor. Prints it,
the reference, the difference, the drag coefficient, and pass or fail (10 %). Exit code 0 if all pass.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt

import thalweg
from thalweg.checks import Verdict
from thalweg.comparison import files_and_figure
from thalweg.frames import trajectory
from thalweg.tables import read_rows

ACCEPTED = 0.10


def main():
    runs, figure_name = files_and_figure(__doc__, "RUN_FOLDER", "settle_in_water.png")

    reference = float(read_rows(Path(__file__).with_name("reference.csv"))[0]["velocity [m/s]"])
    plt.figure(figsize=(6, 3.5))
    verdict = Verdict()
    for run in runs:
        folder = thalweg.Run(run)
        grain = folder.case["grains"][0]
        diameter = grain["diameter"]
        times, positions, motions = trajectory(folder.grains)
        heights, velocities = positions[:, 2], motions[:, 2]
        steady = [k for k, z in enumerate(heights) if heights[0] - z > 10 * diameter and z > 3.5 * diameter]
        if len(steady) < 2:
            print(f"{run.name}: fell no ten diameters before it ended: {verdict(False)}")
            continue
        first, last = steady[0], steady[-1]
        velocity = (heights[first] - heights[last]) / (times[last] - times[first])
        drag = 4.0 * (grain["density"] / 1000.0 - 1.0) * 9.8 * diameter / (3.0 * velocity ** 2)
        good = abs(velocity / reference - 1.0) <= ACCEPTED
        print(
            f"{run.name}: {velocity:.4f} m/s over {(heights[first] - heights[last]) / diameter:.1f} diameters,"
            f" reference {reference:.3f} m/s, difference {100 * (velocity / reference - 1):+.1f} %, drag coefficient"
            f" {drag:.3f}: {verdict(good)}"
        )
        plt.plot(times, [-v for v in velocities], label=run.name)
    plt.axhline(reference, color="k", linestyle="--", label="Schiller and Naumann")
    plt.xlabel("time [s]")
    plt.ylabel("settling velocity [m/s]")
    plt.legend(loc="lower right")
    plt.tight_layout()
    plt.savefig(figure_name, dpi=110)
    return verdict.exit_code


if __name__ == "__main__":
    sys.exit(main())
