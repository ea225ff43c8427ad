#!/usr/bin/env python3
"""Compares the water over the rough bed of tutorial 5 with direct numerical simulations, and its stresses with its
weight."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

from thalweg import Run
from thalweg.checks import check_main
from thalweg.literature import SPHERE_CHANNEL_MEAN
from thalweg.rough_bed import VIRTUAL_WALL, plus_profile, rough_flow, roughness_of, von_karman_number
from thalweg.water import VON_KARMAN


def draw(run, flow, reference, path):
    height, plus = plus_profile(run)
    line = np.array([0.15, height[-1]])
    figure, axes = plt.subplots(figsize=(5.6, 3.8), layout="constrained")
    axes.semilogx(height[height > 0.1], plus[height > 0.1], "o", ms=4, color="#14496e", label="run")
    for size, style, label in ((flow.roughness, "-", f"$k_s = {flow.roughness:.2f}$ d"),
                               (reference, "--", f"$k_s = {reference:.2f}$ d, from the mean of the direct simulation")):
        axes.semilogx(line, np.log(30.0 * line / size) / VON_KARMAN, style, color="0.4", lw=1.2, label=label)
    axes.set(xlabel=f"height above z = {VIRTUAL_WALL} d [d]", ylabel="mean velocity [$u_*$]", ylim=(0, None))
    axes.grid(color="#e5e8ea", linewidth=0.8)
    axes.legend(frameon=False, fontsize=9, loc="lower right")
    figure.savefig(path, dpi=110)


def check(checks, folder, figure):
    run = Run(folder)
    checks.finished(run)
    flow = rough_flow(run, run.averaged_from("fluid_statistics"))
    karman = von_karman_number(run)
    reference = roughness_of(SPHERE_CHANNEL_MEAN, flow.depth)
    checks.expect("largest difference of the total stress from the driving stress",
                  abs(run.result("stress_balance", "largest_difference")), 0.0, 0.06, "bed stresses")
    checks.expect(
        "mean velocity of the water", flow.bulk_velocity, 0.92 * SPHERE_CHANNEL_MEAN, 1.08 * SPHERE_CHANNEL_MEAN, "u*"
    )
    checks.compare(
        "mean velocity of the water in u*", flow.bulk_velocity, SPHERE_CHANNEL_MEAN, "Mazzuoli and Uhlmann (2017)"
    )
    print(f"  its statistical error: {flow.bulk_error:.2f} u*")
    checks.expect("von Karman's number, fitted", karman, 0.30, 0.50)
    checks.compare("von Karman's number, fitted", karman, VON_KARMAN, "usual")
    checks.compare(
        "equivalent sand roughness in diameters", flow.roughness, reference, "of a logarithmic profile with that mean"
    )
    if figure:
        draw(run, flow, reference, figure)


if __name__ == "__main__":
    sys.exit(check_main(__doc__, check, ["run/rough_bed"], figure=True))
