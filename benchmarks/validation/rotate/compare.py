#!/usr/bin/env python3
"""Compares the torque on a rotating sphere with Stokes' 8 pi eta R^3 Omega: compare.py RUN_FOLDER... [--figure FILE]

Takes the torque from the last checkpoint of every run, divides it by Stokes' in the periodic box, prints the difference
and pass or fail (3 %). Exit code 0 if all pass.
"""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import h5py
import matplotlib.pyplot as plt

import thalweg
from thalweg.checks import Verdict
from thalweg.comparison import files_and_figure

ACCEPTED = 0.03
OF_THE_PAPER = 0.11


def torque_ratio(run):
    """Collision, angular velocity (rad/s), torque over Stokes' in this box."""
    folder = thalweg.Run(run)
    case = folder.case
    radius = 0.5 * case["grains"][0]["diameter"]
    omega = case["grains"][0]["prescribed_angular_velocity"][2]
    viscosity = case["fluid"]["density"] * case["fluid"]["kinematic_viscosity"]
    box = case["domain"]["size"][0]
    fraction = 4.0 / 3.0 * math.pi * (radius / box) ** 3
    with h5py.File(folder.latest_checkpoint) as file:
        torque = file["grains/load_torque"][0][2]
    return case["fluid"]["collision"], omega, -torque / (8 * math.pi * viscosity * radius ** 3 * omega / (1 - fraction))


def main():
    runs, figure_name = files_and_figure(__doc__, "RUN_FOLDER", "rotate.png")

    curves, verdict = {}, Verdict()
    for run in runs:
        collision, omega, ratio = torque_ratio(run)
        good = abs(ratio - 1.0) <= ACCEPTED
        print(f"{run.name}: {collision}, {omega:g} rad/s: torque {ratio:.4f} of Stokes' in this box, difference "
              f"{100 * (ratio - 1):+.2f} %: {verdict(good)}")
        curves.setdefault(collision, []).append((omega, ratio))

    plt.figure(figsize=(6, 3.5))
    for collision, points in curves.items():
        plt.semilogx(*zip(*sorted(points)), "o-", label=collision)
    plt.axhspan(1 - ACCEPTED, 1 + ACCEPTED, color="0.85", label="3 %")
    plt.axhline(1 - OF_THE_PAPER, color="k", linestyle=":", label="largest error of the paper")
    plt.axhline(1 + OF_THE_PAPER, color="k", linestyle=":")
    plt.xlabel("angular velocity [rad/s]")
    plt.ylabel("torque / (8 pi eta R^3 Omega/(1 - c))")
    plt.legend(loc="upper left", ncol=2, fontsize=8)
    plt.ylim(0.85, 1.2)
    plt.tight_layout()
    plt.savefig(figure_name, dpi=110)
    return verdict.exit_code


if __name__ == "__main__":
    sys.exit(main())
