#!/usr/bin/python3
"""Compares the water over the rough bed of tutorial 5 with the logarithmic law, and its stresses with its weight."""
import sys
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
from thalweg import Run
from thalweg.checks import check_main
from thalweg.water import VON_KARMAN

ZERO_PLANE = 0.8              # diameters: of the logarithmic law above the floor, a fifth of a diameter below the crests
FITTED = 2.5, 4.6             # diameters above the floor
DENSELY_PACKED = 0.63         # equivalent sand roughness over the diameter of densely packed spheres, after Schlichting (1936)


def friction_velocity(run):
    """m/s: of the water above the crests, sqrt(g sin(alpha) H)."""
    return float(np.sqrt(run.gravity[0] * (run.size[2] - run.diameter)))


def logarithmic_fit(run):
    """von Karman's number and equivalent sand roughness (diameters), u/u* = ln(30 z/k_s)/kappa, above the near-wall layer."""
    means = run.profiles["fluid_statistics"]
    z = means["z"] / run.diameter
    fitted = (z > FITTED[0]) & (z < FITTED[1])
    logarithm, plus = np.log(z[fitted] - ZERO_PLANE), means["velocity"][fitted, 0] / friction_velocity(run)
    slope = np.polyfit(logarithm, plus, 1)[0]
    return 1.0 / slope, 30.0 * float(np.exp(np.mean(logarithm - VON_KARMAN * plus)))


def draw(run, roughness, path):
    means = run.profiles["fluid_statistics"]
    height = means["z"] / run.diameter - ZERO_PLANE
    plus = means["velocity"][:, 0] / friction_velocity(run)
    line = np.array([0.15, height[-1]])
    figure, axes = plt.subplots(figsize=(5.6, 3.8), layout="constrained")
    axes.semilogx(height[height > 0.1], plus[height > 0.1], "o", ms=4, color="#14496e", label="run")
    for size, style, label in ((roughness, "-", f"$k_s = {roughness:.2f}$ d"),
                               (DENSELY_PACKED, "--", f"$k_s = {DENSELY_PACKED}$ d, densely packed spheres")):
        axes.semilogx(line, np.log(30.0 * line / size) / VON_KARMAN, style, color="0.4", lw=1.2, label=label)
    axes.set(xlabel=f"height above z = {ZERO_PLANE} d [d]", ylabel="mean velocity [$u_*$]", ylim=(0, None))
    axes.grid(color="#e5e8ea", linewidth=0.8)
    axes.legend(frameon=False, fontsize=9, loc="lower right")
    figure.savefig(path, dpi=110)


def check(checks, folder, figure):
    run = Run(folder)
    checks.finished(run)
    kappa, roughness = logarithmic_fit(run)
    checks.expect("largest difference of the total stress from the driving stress",
                  abs(run.summary["stress_balance"]["largest_difference"]), 0.0, 0.06, "bed stresses")
    checks.expect("von Karman's number, fitted", kappa, 0.33, 0.49)
    checks.compare("von Karman's number, fitted", kappa, VON_KARMAN, "usual")
    checks.expect("equivalent sand roughness", roughness, 0.05, 0.2, "diameters")
    checks.compare("equivalent sand roughness in diameters", roughness, DENSELY_PACKED, "densely packed spheres")
    viscous_length = run.case["fluid"]["kinematic_viscosity"] / friction_velocity(run)
    print(f"  in wall units: {roughness * run.diameter / viscous_length:.0f}")
    if figure:
        draw(run, roughness, figure)


if __name__ == "__main__":
    sys.exit(check_main(__doc__, check, ["run/rough_bed"], figure=True))
