#!/usr/bin/env python3
"""Profiles of the side-wall channel against the law of the wall: compare.py [--figure FILE] PROFILE.csv ...

Prints for every profile (output of bin/turbulent_channel) the difference from u+ = ln(y+)/0.41 + 5 in the first cell
and the smallest and largest outside it, in per cent, and pass or fail (5 %).
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt

from thalweg.tables import read_rows
from thalweg.water import logarithmic_law as law

ACCEPTED = 5.0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("profiles", nargs="+", type=Path)
    parser.add_argument("--figure", type=Path)
    arguments = parser.parse_args()
    figure, axis = plt.subplots(figsize=(7, 4.5))
    print("| profile | first cell | outside it: from | to | |\n|---|---|---|---|---|")
    for file in arguments.profiles:
        profile = [(float(r["y_plus"]), float(r["U_plus"])) for r in read_rows(file)]
        error = [100 * (u / law(y) - 1) for y, u in profile]
        good = max(map(abs, error[1:])) <= ACCEPTED
        print(f"| {file.stem} | {error[0]:+.1f} % | {min(error[1:]):+.1f} % | {max(error[1:]):+.1f} % | "
              f"{'passed' if good else 'failed'} |")
        axis.semilogx(*zip(*profile), "o-", ms=3, lw=0.8, label=file.stem)
    y = [10 * 45 ** (k / 50) for k in range(51)]
    axis.fill_between(
        y, [0.95 * law(v) for v in y], [1.05 * law(v) for v in y], color="0.9", label="law of the wall ± 5 %"
    )
    axis.semilogx(y, [law(v) for v in y], "k-", lw=1)
    axis.set(xlabel="y+", ylabel="U+")
    axis.legend(fontsize=7, loc="lower right")
    figure.tight_layout()
    if arguments.figure:
        figure.savefig(arguments.figure, dpi=80)


if __name__ == "__main__":
    main()
