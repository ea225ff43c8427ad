#!/usr/bin/env python3
"""Compares settling runs with ten Cate et al. 2002: compare.py E1=RUN_FOLDER [E2=RUN_FOLDER] [--figure FILE]

Prints for every run the largest settling velocity, the measured one, their difference, and pass or fail (2 %); draws
velocity and height against time. Exit code 0 if all pass.
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

ACCEPTED = 0.02
RADIUS = 7.5e-3   # m


def main():
    runs, figure_name = files_and_figure(__doc__, "CASE=RUN_FOLDER", "settle.png")

    rows = read_rows(Path(__file__).with_name("reference.csv"))
    measured = {row["case"]: float(row["u_inf [m/s]"]) * float(row["u_max_over_u_inf [1]"]) for row in rows}

    figure, (top, bottom) = plt.subplots(2, 1, sharex=True, figsize=(7, 6))
    verdict = Verdict()
    for run in runs:
        name, folder = str(run).split("=", 1)
        case = name.split("_")[0]
        times, positions, motions = trajectory(thalweg.Run(folder).grains)
        heights, velocities = positions[:, 2], motions[:, 2]
        fastest = -min(velocities)
        difference = fastest / measured[case] - 1.0
        good = abs(difference) <= ACCEPTED
        print(
            f"{name}: u_max {fastest:.5f} m/s, measured {measured[case]:.5f} m/s, difference {100 * difference:+.1f} %:"
            f" {verdict(good)}"
        )
        line, = top.plot(times, velocities, label=name)
        top.axhline(-measured[case], color=line.get_color(), linestyle="--", linewidth=0.8)
        bottom.plot(times, [1e3 * (h - RADIUS) for h in heights], color=line.get_color())
    top.set_ylabel("velocity [m/s]")
    top.legend(title="dashed: largest measured", loc="lower right")
    bottom.set_ylabel("lowest point above the floor [mm]")
    bottom.set_xlabel("time [s]")
    figure.tight_layout()
    figure.savefig(figure_name, dpi=110)
    return verdict.exit_code


if __name__ == "__main__":
    sys.exit(main())
