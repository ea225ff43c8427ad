#!/usr/bin/env python3
"""Restitution of spheres that rebound in a liquid: compare.py RUN_FOLDER... [--figure FILE]

Up to three impacts of a run above the Stokes number 8 count. The impact velocity is the largest since the last impact;
the rebound velocity is that at the time when sound has gone around the sphere after the end of the contact (pi R/c_s,
27 steps at ten cells per diameter), before which the fluid has not responded to the reversal. Prints Stokes number,
restitution over dry restitution, exp(-35/St), their difference, and pass or fail (0.1). Exit code 0 if all pass.
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
SLOWEST = 8.0             # Stokes number below which nothing rebounds and no impact is counted


def main():
    runs, figure_name = files_and_figure(__doc__, "RUN_FOLDER", "bounce.png")

    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    verdict, colours, shown = Verdict(), {}, set()
    for run in runs:
        folder = thalweg.Run(run)
        case = folder.case
        diameter, density = case["grains"][0]["diameter"], case["grains"][0]["density"]
        viscosity = case["fluid"]["density"] * case["fluid"]["kinematic_viscosity"]
        option = (case.get("coupling") or {}).get("lubrication")
        kind = f"lubrication, gaps from {option['minimum_gap']:g} R" if option else "no lubrication"
        colour = colours.setdefault(kind, f"C{len(colours)}")
        times, positions, motions = trajectory(folder.grains)
        heights, velocities = positions[:, 2], motions[:, 2]
        gaps = [(h - 0.5 * diameter) / diameter for h in heights]   # diameters
        for number, (before, after) in enumerate(impacts(times, gaps, velocities, settling_time(case))):
            stokes = density * before * diameter / (9.0 * viscosity)
            ratio, reference = after / before / case["contact"]["restitution"], math.exp(-35.0 / stokes)
            if stokes < SLOWEST:
                break
            good = abs(ratio - reference) <= ACCEPTED
            print(f"{run.name}: impact {number + 1}, St {stokes:.1f}, {kind}: "
                  f"e/e_dry {ratio:.3f}, reference {reference:.3f}, difference {ratio - reference:+.3f}: "
                  f"{verdict(good)}")
            if not case["name"].startswith("Three"):
                left.semilogx(stokes, ratio, "o", color=colour, label=None if kind in shown else kind)
                shown.add(kind)
        if case["name"].startswith("Three"):
            right.plot(times, gaps, color=colour, label=kind)
    stokes = [8.0 * 1.1 ** k for k in range(50)]
    curve = [math.exp(-35.0 / s) for s in stokes]
    left.fill_between(stokes, [c - ACCEPTED for c in curve], [c + ACCEPTED for c in curve], color="0.9")
    left.plot(stokes, curve, "k-", linewidth=0.8, label="exp(-35/St), within 0.1")
    left.set_xlabel("Stokes number of the impact")
    left.set_ylabel("restitution / dry restitution")
    left.set_ylim(-0.1, 1.1)
    left.legend(loc="lower right", fontsize=8)
    right.set_xlabel("time [s]")
    right.set_ylabel("gap [diameters]")
    right.set_xlim(0.0, 0.3)
    if right.get_lines():
        right.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(figure_name, dpi=100)
    return verdict.exit_code


if __name__ == "__main__":
    sys.exit(main())
