#!/usr/bin/env python3
"""Rebounds of glass spheres in water: compare.py RUN_FOLDER... [--figure FILE]

Prints for the first impact of every run: duration of the contact in fluid steps, velocity and Stokes number of the
impact, restitution over dry restitution, exp(-35/St), and pass or fail (0.1). Velocities as in
benchmarks/validation/bounce. Exit code 0 if all pass.
"""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt

import thalweg
from thalweg.checks import Verdict
from thalweg.comparison import files_and_figure
from thalweg.frames import trajectory
from thalweg.rebound import impacts, settling_time

ACCEPTED = 0.1


def contact_steps(case):
    """Duration of the first grain's contact with a body that does not move, in fluid steps."""
    grain, contact = case["grains"][0], case["contact"]
    mass = grain["density"] * math.pi / 6.0 * grain["diameter"] ** 3
    return math.pi * math.sqrt(mass / contact["normal_stiffness"]) / case["fluid"]["time_step"]


def main():
    runs, figure_name = files_and_figure(__doc__, "RUN_FOLDER", "rebound_in_water.png")

    plt.figure(figsize=(7, 4))
    verdict = Verdict()
    for run in runs:
        folder = thalweg.Run(run)
        case = folder.case
        diameter, density = case["grains"][0]["diameter"], case["grains"][0]["density"]
        viscosity = case["fluid"]["density"] * case["fluid"]["kinematic_viscosity"]
        times, positions, motions = trajectory(folder.grains)
        below = 0.5 * diameter
        if len(case["grains"]) > 1:
            below = case["grains"][1]["placement"]["positions"][0][2] + diameter
        gaps = (positions[:, 2] - below) / diameter
        plt.plot(times, gaps, label=run.name)
        found = impacts(times, gaps, motions[:, 2], settling_time(case))
        if not found:
            print(f"{run.name}: no impact before the run ended: {verdict(False)}")
            continue
        before, after = found[0]
        stokes = density * before * diameter / (9.0 * viscosity)
        ratio, reference = after / before / case["contact"]["restitution"], math.exp(-35.0 / stokes)
        good = abs(ratio - reference) <= ACCEPTED
        print(f"{run.name}: contact of {contact_steps(case):.1f} steps, {before:.3f} m/s, St {stokes:.0f}: "
              f"e/e_dry {ratio:.3f}, reference {reference:.3f}, difference {ratio - reference:+.3f}: "
              f"{verdict(good)}")
    plt.xlabel("time [s]")
    plt.ylabel("gap [diameters]")
    plt.legend(fontsize=8)
    plt.tight_layout()
    plt.savefig(figure_name, dpi=100)
    return verdict.exit_code


if __name__ == "__main__":
    sys.exit(main())
