#!/usr/bin/env python3
"""Compares the spin of a free sphere in simple shear with half the shear rate: compare.py RUN_FOLDER... [--figure FILE]

Prints the spin over the shear rate at the end of every run, the reference, their difference, and pass or fail (3 %);
draws the spin against time. Exit code 0 if all pass.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt

import thalweg
from thalweg.checks import Verdict
from thalweg.comparison import files_and_figure

ACCEPTED = 0.03


def spins(run):
    """Times (s) and angular velocities about y (rad/s) of the only grain."""
    found = [(frame.time, frame.angular_velocity[0, 1]) for frame in run.grains]
    return [time for time, _ in found], [spin for _, spin in found]


def main():
    runs, figure_name = files_and_figure(__doc__, "RUN_FOLDER", "shear_spin.png")

    plt.figure(figsize=(6, 3.5))
    verdict = Verdict()
    for run in runs:
        folder = thalweg.Run(run)
        case = folder.case
        top, bottom = (case["domain"]["boundaries"][face]["velocity"][0] for face in ("top", "bottom"))
        rate = (top - bottom) / case["domain"]["size"][2]
        radius = 0.5 * case["grains"][0]["diameter"]
        reynolds = rate * radius ** 2 / case["fluid"]["kinematic_viscosity"]
        reference = 0.5 - 0.1538 * reynolds ** 1.5
        times, values = spins(folder)
        ratio = values[-1] / rate
        good = abs(ratio / reference - 1.0) <= ACCEPTED
        print(
            f"{run.name}: Reynolds number {reynolds:.3g}, spin {ratio:.4f} of the shear rate, reference"
            f" {reference:.4f}, difference {100 * (ratio / reference - 1):+.2f} %: {verdict(good)}"
        )
        plt.plot(times, [v / rate for v in values], label=f"Re {reynolds:.2g}")
    plt.axhline(0.5, color="k", linestyle=":", label="Jeffery 1922")
    plt.xlabel("time [s]")
    plt.ylabel("spin / shear rate")
    plt.ylim(0, 0.6)
    plt.legend(loc="lower right")
    plt.tight_layout()
    plt.savefig(figure_name, dpi=110)
    return verdict.exit_code


if __name__ == "__main__":
    sys.exit(main())
