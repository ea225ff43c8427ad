#!/usr/bin/env python3
"""Compares the drag on simple cubic arrays with Zick and Homsy: compare.py DRAG_CSV... [--figure FILE]

Takes the tables that run.py writes, prints for every link rule, solid fraction and diameter the mean drag over the
positions relative to the cells, the reference, the difference, the spread over the positions, and pass or fail (5 % at
ten or more cells per diameter), and draws the convergence. Exit code 0 if all pass.
"""
import sys

from arrays import reference_drags

import matplotlib.pyplot as plt

from thalweg.checks import Verdict
from thalweg.comparison import files_and_figure
from thalweg.tables import read_rows

ACCEPTED, FROM_CELLS = 0.05, 10.0


def main():
    tables, figure_name = files_and_figure(__doc__, "DRAG_CSV", "simple_cubic_arrays.png")

    reference, drags = reference_drags(), {}
    for table in tables:
        for row in read_rows(table):
            group = drags.setdefault((row["links"], row["solid_fraction [1]"]), {})
            group.setdefault(float(row["diameter [cells]"]), []).append(float(row["drag [1]"]))

    plt.figure(figsize=(6, 4))
    verdict = Verdict()
    for (links, fraction), group in drags.items():
        exact, points = reference[fraction], []
        for diameter, values in sorted(group.items()):
            error = sum(values) / len(values) / exact - 1.0
            spread = (max(values) - min(values)) / exact
            good = diameter < FROM_CELLS or abs(error) <= ACCEPTED
            points.append((diameter, 100.0 * abs(error)))
            print(
                f"{links}, solid fraction {fraction}, {diameter:.1f} cells: drag {exact * (1 + error):.3f}, reference"
                f" {exact}, difference {100 * error:+.2f} %, {len(values)} places {100 * spread:.2f} % apart:"
                f" {verdict(good)}"
            )
        plt.loglog(*zip(*points), "o-", label=f"{links}, {fraction}")
    plt.loglog([6, 20], [6, 6 * 6 / 20], "k:", label="first order")
    plt.loglog([6, 20], [6, 6 * (6 / 20) ** 2], "k--", label="second order")
    plt.xticks([6, 8, 10, 12, 16, 20], ["6", "8", "10", "12", "16", "20"], minor=False)
    plt.minorticks_off()
    plt.xlabel("cells a diameter")
    plt.ylabel("drag: difference from Zick and Homsy [%]")
    plt.legend(fontsize=8)
    plt.tight_layout()
    plt.savefig(figure_name, dpi=110)
    return verdict.exit_code


if __name__ == "__main__":
    sys.exit(main())
