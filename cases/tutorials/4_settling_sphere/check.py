#!/usr/bin/env python3
"""Compares the settling speeds of tutorial 4 with Schiller and Naumann."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import numpy as np

from thalweg.checks import check_main
from thalweg.frames import trajectory
from thalweg.literature import settling_speed
from thalweg.run import runs_of_sweep

COUNTED = 3.0     # diameters: the last of the fall, over which the speed is taken
CLEAR = 4.0       # diameters from the floor that it keeps


def check(checks, folder):
    for run in runs_of_sweep(folder):
        times, positions, _ = trajectory(run.grains)
        height, viscosity = positions[:, 2], run.case["fluid"]["kinematic_viscosity"]
        first = int(np.searchsorted(-height, -(height[-1] + COUNTED * run.diameter)))
        speed = (height[first] - height[-1]) / (times[-1] - times[first])
        reference = settling_speed(run.diameter, run.density_ratio, -run.gravity[2], viscosity)
        print(f"Reynolds number {speed * run.diameter / viscosity:.3g}")
        checks.expect("  height above the floor at the end", height[-1] / run.diameter, CLEAR, 1e3, "diameters")
        checks.compare("  settling speed in m/s", speed, reference, "Schiller and Naumann")
        checks.expect("  over that", speed / reference, 0.93, 1.0)


if __name__ == "__main__":
    sys.exit(check_main(__doc__, check, ["run/sphere"]))
