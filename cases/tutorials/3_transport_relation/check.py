#!/usr/bin/env python3
"""Checks the transport rates of tutorial 3 and compares them with those of the whole flume."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import numpy as np

from thalweg.checks import check_main
from thalweg.literature import FLUME_POINTS
from thalweg.run import runs_of_sweep

# Shields numbers and q* of the same cells in the whole flume, benchmarks/validation/flume
WHOLE_FLUME = (0.023, 0.028, 0.047, 0.063, 0.068), (0.0110, 0.038, 0.180, 0.418, 0.524)


def between(shields, points):
    """q* of other runs at a Shields number, on straight lines between the logarithms."""
    return float(np.exp(np.interp(np.log(shields), *np.log(points))))


def check(checks, folder):
    runs = sorted(runs_of_sweep(folder), key=lambda run: run.slope)
    checks.expect("runs", len(runs), 4, 4)
    shields = [run.result("bed_surface", "shields_number_mean") for run in runs]
    rates = [run.result("transport_rate", "q_star_mean") for run in runs]
    for run, tau, rate in zip(runs, shields, rates):
        error = run.result("transport_rate", "q_star_error")
        print(f"slope {run.slope:g}, Shields number {tau:.4f}: q* = {rate:.4f} +- {error:.4f}")
        checks.compare("  q*", rate, between(tau, WHOLE_FLUME), "the whole flume on such cells")
        checks.expect("  over that", rate / between(tau, WHOLE_FLUME), 0.5, 2.0)
    tau, rate = FLUME_POINTS[0][:2]
    power = np.log(rates[1] / rates[0]) / np.log(shields[1] / shields[0])
    checks.compare(
        f"q* at {tau}, by the power {power:.1f} of the lowest two", rates[0] * (tau / shields[0]) ** power, rate,
        "Zhang et al.",
    )
    checks.expect("growth of q* from the lowest to the highest slope", rates[-1] / rates[0], 2.0, 12.0)


if __name__ == "__main__":
    sys.exit(check_main(__doc__, check, ["run/transport_relation"]))
