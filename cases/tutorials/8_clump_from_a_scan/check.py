#!/usr/bin/env python3
"""Checks the run of tutorial 8: the mass of the pebble, its first acceleration, and its settling speed."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import numpy as np

from thalweg import Run
from thalweg.checks import check_main

FIRST = 0.01            # s, over which it speeds up evenly
ADDED_MASS = 0.5, 1.1   # of the displaced water: of a sphere, and of a disk-like grain that falls flat


def ferguson_and_church(diameter, submerged, gravity, viscosity):
    """Settling speed (m/s) of natural grains, doi:10.1306/051204740933; submerged: density ratio less 1."""
    weight = submerged * gravity * diameter**2
    return weight / (18.0 * viscosity + np.sqrt(0.75 * 1.0 * weight * diameter))


def check(checks, folder):
    run = Run(folder)
    checks.finished(run)
    gravity, ratio = -run.gravity[2], run.density_ratio
    mass = run.case["grains"][0]["density"] * np.pi / 6.0 * run.diameter**3
    times, momentum, energy = (run.series[name] for name in ("time", "grain_momentum_z", "grain_kinetic_energy"))
    checks.expect("equivalent diameter", 1e3 * run.diameter, 1.999, 2.001, "mm")
    speed = -momentum / mass
    # Energy of translation is at most all of it: a wrong mass shows here.
    checks.expect("energy of the fall over all", 0.5 * mass * speed[-1] ** 2 / energy[-1], 0.8, 1.0)
    first = np.searchsorted(times, FIRST)
    low, high = (gravity * (ratio - 1.0) / (ratio + added) for added in reversed(ADDED_MASS))
    checks.expect("first acceleration", speed[first] / times[first], 0.95 * low, high, "m/s^2")
    checks.expect("speed at the end", speed[-1], 0.17, 0.25, "m/s")
    viscosity = run.case["fluid"]["kinematic_viscosity"]
    checks.compare("speed at the end", speed[-1], ferguson_and_church(run.diameter, ratio - 1.0, gravity, viscosity),
                   "Ferguson and Church (2004), natural grains")


if __name__ == "__main__":
    sys.exit(check_main(__doc__, check, ["run/pebble"]))
