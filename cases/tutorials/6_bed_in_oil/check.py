#!/usr/bin/env python3
"""Finds the threshold of motion of tutorial 6 and compares it with experiments in viscous flow."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

from thalweg.checks import check_main
from thalweg.run import runs_of_sweep

THRESHOLD, BAND = 0.12, 0.03   # Charru et al. (2004) 0.12; Ouriemi et al. (2007) 0.12 +- 0.03
MOVING = 0.12                  # runs at higher Shields numbers enter the fit
SURFACE = 32                   # grains of a layer of the bed


def draw(shields, rate, error, threshold, slope, path):
    figure, axes = plt.subplots(figsize=(5.6, 3.8), layout="constrained")
    axes.axvspan(THRESHOLD - BAND, THRESHOLD + BAND, color="0.9", label="threshold of experiments")
    axes.errorbar(shields, 1e3 * rate, 1e3 * error, fmt="o", color="#14496e", capsize=3, label="runs")
    line = np.array([threshold, max(shields)])
    axes.plot(line, 1e3 * slope * (line - threshold), "--", color="#c0392b", label=f"line from {threshold:.3f}")
    axes.set(xlabel="Shields number [1]", ylabel="transport rate $10^3\\,q^*$ [1]", xlim=(0.05, None))
    axes.grid(color="#e5e8ea", linewidth=0.8)
    axes.legend(frameon=False, fontsize=9, loc="upper left")
    figure.savefig(path, dpi=110)


def check(checks, folder, figure):
    runs = sorted(runs_of_sweep(folder), key=lambda run: run.result("bed_surface", "shields_number_mean"))
    shields, rate, error, moving = (np.array([run.result(observer, name) for run in runs]) for observer, name in (
        ("bed_surface", "shields_number_mean"), ("transport_rate", "q_star_mean"), ("transport_rate", "q_star_error"),
        ("transport_rate", "moving_grains_mean")))
    for row in zip(shields, rate, error, moving):
        print("Shields number %.4f: q* = %.5f +- %.5f, %.1f grains move" % row)
    fitted = shields > MOVING
    checks.expect("runs", len(runs), 6, 6)
    checks.expect("largest number of moving grains below the fit", moving[~fitted].max(), 0.0, 0.2 * SURFACE)
    checks.expect("number at the largest Shields number", moving[-1], SURFACE, 150.0)
    slope, offset = np.polyfit(shields[fitted], rate[fitted], 1)
    checks.expect("threshold, where a line through the rates ends", -offset / slope, THRESHOLD - BAND, THRESHOLD + BAND)
    checks.compare("threshold", -offset / slope, THRESHOLD, "Charru et al., Ouriemi et al.")
    by_number = np.polyfit(shields[fitted], moving[fitted], 1)
    checks.compare("threshold by the number of moving grains", -by_number[1] / by_number[0], THRESHOLD, "the same")
    if figure:
        draw(shields, rate, error, -offset / slope, slope, figure)


if __name__ == "__main__":
    sys.exit(check_main(__doc__, check, ["run/bed_in_oil"], figure=True))
