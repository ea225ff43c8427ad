#!/usr/bin/env python3
"""Checks the run of tutorial 2: Shields number, transport rate and the balance of momentum."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python
from thalweg import Run
from thalweg.checks import check_main

LONGER_FLUME = 0.187   # q* at a Shields number of 0.0476, benchmarks/validation/flume


def check(checks, folder):
    run = Run(folder)
    checks.finished(run)
    rate = run.result("transport_rate", "q_star_mean")
    checks.expect("Shields number", run.result("bed_surface", "shields_number_mean"), 0.044, 0.051)
    checks.expect("q*", rate, 0.08, 0.32)
    print(f"  its standard error: {run.result('transport_rate', 'q_star_error'):.2g}")
    checks.compare("q*", rate, LONGER_FLUME, "the same cells in a flume twice as long")
    checks.expect("largest difference of the total stress from the driving stress less the side walls'",
                  abs(run.result("stress_balance", "largest_difference")), 0.0, 0.15, "bed stresses")


if __name__ == "__main__":
    sys.exit(check_main(__doc__, check, ["run/water_over_bed"]))
