#!/usr/bin/env python3
"""q* of the flume against time: compare.py RUN_FOLDER... [--figure FILE] [--table FILE]

Draws means over half a second, and the mean and the deviation that Zhang et al. (2022) print at the Shields number
0.028. The table of these means is updated, and all its rows are drawn. thalweg plot relation draws the runs against the
Shields number.
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

import thalweg
from thalweg import literature
from thalweg.drawing import colour_of
from thalweg.tables import merged_rows

WINDOW = 0.5                       # s


def window_means(series):
    """Ends of the windows (s) and the mean of q* in each; the settling in the first second is left out."""
    time, q_star = series["time"], series["q_star"]
    ends = np.arange(WINDOW, time[-1] + 1e-9, WINDOW)
    means = np.array([q_star[(time > end - WINDOW) & (time <= end)].mean() for end in ends])
    keep = (means < 0.5) | (ends > 1.0)
    return ends[keep], means[keep]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("runs", nargs="*", type=Path, metavar="RUN_FOLDER")
    parser.add_argument("--figure", default="flume.png")
    parser.add_argument("--table")
    arguments = parser.parse_args()

    plt.figure(figsize=(9, 4))
    rows = []
    for run in arguments.runs:
        folder = thalweg.Run(run)
        rows += [{"run": run.name, "until [s]": f"{end:.1f}", "q_star [1]": f"{mean:.4f}"}
                 for end, mean in zip(*window_means(folder.series))]
    rows = merged_rows(arguments.table, rows)
    for n, name in enumerate(dict.fromkeys(row["run"] for row in rows)):
        ends, means = np.array(
            [[float(row["until [s]"]), float(row["q_star [1]"])] for row in rows if row["run"] == name]
        ).T
        plt.plot(ends - 0.5 * WINDOW, means, "o-", markersize=3, color=colour_of(n), label=name)
    plt.axhspan(*literature.flume_band(), color="0.9",
                label="Zhang et al. at 0.028, mean and deviation")
    plt.xlabel("time [s]")
    plt.ylabel("q*")
    plt.ylim(0.0, None)
    plt.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.01, 1.0))
    plt.tight_layout()
    plt.savefig(arguments.figure, dpi=100)


if __name__ == "__main__":
    main()
