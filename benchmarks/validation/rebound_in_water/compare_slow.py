#!/usr/bin/env python3
"""Slow rebounds of glass spheres in water, without gravity: compare_slow.py RUN_FOLDER...

Prints for every run the speed at a gap of a tenth of a diameter, the Stokes number of the two bodies there, St = m*
v/(6 pi eta R*^2), the largest speed after the end of the contact over the speed before and the dry restitution,
exp(-35/St), and pass or fail (0.1). Exit code 0 if all pass.
"""
import argparse
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python
import thalweg
from thalweg.checks import Verdict
from thalweg.frames import trajectory

ACCEPTED, MEASURED_AT = 0.1, 0.1  # difference; diameters


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN_FOLDER")
    verdict = Verdict()
    for name in parser.parse_args().runs:
        run = thalweg.Run(name)
        grain, on_grain = run.case["grains"][0], len(run.case["grains"]) > 1
        diameter = grain["diameter"]
        mass = grain["density"] * math.pi / 6.0 * diameter ** 3
        reduced = 0.25 * diameter if on_grain else 0.5 * diameter  # R*; the other body is held: m* is the mass
        viscosity = run.case["fluid"]["density"] * run.case["fluid"]["kinematic_viscosity"]
        _, positions, velocities = trajectory(run.grains)
        surface = run.case["grains"][1]["placement"]["positions"][0][2] + 0.5 * diameter if on_grain else 0.0
        gaps, speeds = (positions[:, 2] - 0.5 * diameter - surface) / diameter, velocities[:, 2]
        near = next(k for k, gap in enumerate(gaps) if gap < MEASURED_AT)
        touch = next(k for k, gap in enumerate(gaps) if gap < 0.0)
        apart = gaps[touch:] > 0.0
        before, after = -speeds[near], max(0.0, speeds[touch:][apart].max(initial=0.0))
        stokes = mass * before / (6.0 * math.pi * viscosity * reduced ** 2)
        ratio, reference = after / before / run.case["contact"]["restitution"], math.exp(-35.0 / stokes)
        good = abs(ratio - reference) <= ACCEPTED
        print(f"{name.name}: {before:.4f} m/s, St {stokes:.0f}: e/e_dry {ratio:.3f}, reference {reference:.3f}, "
              f"difference {ratio - reference:+.3f}: {verdict(good)}")
    return verdict.exit_code


if __name__ == "__main__":
    sys.exit(main())
