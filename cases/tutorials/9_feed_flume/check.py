#!/usr/bin/env python3
"""Checks the run of tutorial 9: grains that came and went, the rate along the flume, and the level of the bed."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python
from thalweg import Run
from thalweg.checks import check_main

FED = 0.2                     # q*, supplies.0.transport_rate
FROM = 1.5                    # s, as in the case
BETWEEN = (0.030, 0.170)      # m: from the supply to the sill
BEHIND_THE_SILL = (0.150, 0.180)


def grains_a_second(run, name):
    """Mean rate at which a number of the series grows, 1/s."""
    counted = run.series["time"] >= FROM
    time, number = run.series["time"][counted], run.series[name][counted]
    return (number[-1] - number[0]) / (time[-1] - time[0])


def check(checks, folder):
    run = Run(folder)
    checks.finished(run)
    series, means = run.series, run.profiles["reach"]
    start = series["grains"][0]
    lost = start + series["supplied_grains"][-1] - series["left_grains"][-1] - series["grains"][-1]
    checks.expect("grains that are lost", lost, 0, 0)
    leaving = grains_a_second(run, "left_grains") / grains_a_second(run, "supplied_grains")
    checks.expect("grains that leave, for one that comes", leaving, 0.8, 1.2)
    rates = means["q_star"][(means["section"] > BETWEEN[0]) & (means["section"] < BETWEEN[1])]
    checks.expect("q* from supply to sill", rates.mean(), 0.16, 0.22)
    checks.compare("the same", rates.mean(), FED, "what is fed")
    behind = (means["x"] > BEHIND_THE_SILL[0]) & (means["x"] < BEHIND_THE_SILL[1])
    checks.expect("level of the bed behind the sill", 1e3 * means["bed_level"][behind].mean(), 8.0, 11.0, "mm")


if __name__ == "__main__":
    sys.exit(check_main(__doc__, check, ["run/feed_flume"]))
