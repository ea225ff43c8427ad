#!/usr/bin/env python3
"""Mean velocity of a plane channel against Moser, Kim and Mansour (1999): compare.py [--figure FILE] PROFILE.csv ...

Takes profiles written by bin/turbulent_channel, interpolates them (cubic, the wall at rest included) to the y+ of the
reference, and prints the largest difference in per cent and pass or fail (3 %). Exit code 0 if the last one passes.
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt

from thalweg.tables import read_rows

ACCEPTED = 3.0


def read(file):
    return [{k: float(v) for k, v in row.items()} for row in read_rows(file)]


def interpolate(points, x):
    above = next((k for k, p in enumerate(points) if p[0] > x), len(points))
    first = min(max(above - 2, 0), len(points) - 4)
    total = 0.0
    for i in range(first, first + 4):
        weight = 1.0
        for j in range(first, first + 4):
            if j != i:
                weight *= (x - points[j][0]) / (points[i][0] - points[j][0])
        total += weight * points[i][1]
    return total


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("profiles", nargs="+", type=Path)
    parser.add_argument("--figure", type=Path)
    arguments = parser.parse_args()
    reference = read(Path(__file__).with_name("reference.csv"))
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2))
    left.semilogx([r["y_plus"] for r in reference], [r["U_plus"] for r in reference], "ko", mfc="none", ms=5,
                  label="Moser, Kim and Mansour 1999")
    good = False
    for file in arguments.profiles:
        rows = read(file)
        points = [(0.0, 0.0)] + [(r["y_plus"], r["U_plus"]) for r in rows]
        errors = [100 * (interpolate(points, r["y_plus"]) / r["U_plus"] - 1) for r in reference]
        worst = max(errors, key=abs)
        good = abs(worst) <= ACCEPTED
        print(f"{file}: largest difference {worst:+.1f} % at y+ = {reference[errors.index(worst)]['y_plus']:g}, "
              f"{'passed' if good else 'FAILED'}; all: " + " ".join(f"{e:+.1f}" for e in errors))
        left.semilogx(*zip(*points[1:]), "-", label=file.stem)
        y = [r["y_plus"] for r in rows]
        for key, name in (("u_rms_plus", "u'"), ("v_rms_plus", "w' (across)"), ("w_rms_plus", "v' (normal)"),
                          ("minus_uw_plus", "-uv")):
            right.plot(y, [r[key] for r in rows], label=f"{file.stem}: {name}")
    left.set(xlabel="y+", ylabel="U+")
    left.legend(fontsize=8)
    right.set(xlabel="y+", ylabel="rms velocities and shear stress, wall units")
    right.legend(fontsize=7)
    figure.tight_layout()
    if arguments.figure:
        figure.savefig(arguments.figure, dpi=80)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
