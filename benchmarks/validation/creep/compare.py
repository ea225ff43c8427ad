#!/usr/bin/env python3
"""Figure 11 of Zhang et al. (2022): the velocity of grains that creep below the surface of a bed.

    compare.py POINTS        folder of `thalweg sweep points.yaml`

Writes creep.csv and creep.png next to this script; ends with exit code 1 if a length is more than 2 % from the
reference.
"""
import csv
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python

import matplotlib.pyplot as plt

import thalweg

DIAMETER, BOUND = 5e-3, 0.02
# Shields number: e-fold and decade, diameters, of an independent solution by finite differences
REFERENCE = {0.0471: (0.98, 2.26), 0.085: (0.96, 2.22), 0.1408: (0.95, 2.19)}


def main(folder):
    figure, axes = plt.subplots(figsize=(5.2, 4.4))
    rows, worst = [], 0.0
    for shields, reference in REFERENCE.items():
        run = thalweg.Run(Path(folder) / "runs" / f"shields_number_{shields:g}")
        lengths = [run.summary["figures"][name] / DIAMETER for name in ("creep_decay_length", "creep_decade_length")]
        worst = max(worst, *(abs(found / known - 1.0) for found, known in zip(lengths, reference)))
        rows.append([shields, lengths[0], reference[0], lengths[1], reference[1]])
        column = run.profiles["continuum"]
        axes.semilogx(
            column["creep_velocity"][1:], -column["creep_depth"][1:] / DIAMETER, label=f"Shields number {shields:g}"
        )
    axes.set(xlabel="velocity of the grains, m/s (fluidity 0.01 1/s at -2 d)", ylabel="height over the surface, d")
    axes.legend()
    figure.tight_layout()
    figure.savefig(HERE / "creep.png", dpi=110)
    header = ("shields_number", "e_fold_d", "e_fold_reference_d", "decade_d", "decade_reference_d")
    with open(HERE / "creep.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([header, *([f"{value:.4g}" for value in row] for row in rows)])
    print(header)
    for row in rows:
        print([round(value, 4) for value in row])
    print(f"largest deviation {100.0 * worst:.2g} %")
    return 0 if worst <= BOUND else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
