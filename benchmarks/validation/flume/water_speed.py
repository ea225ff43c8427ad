#!/usr/bin/python3
"""q* of the flume against the speed of its water: water_speed.py RUN_FOLDER... [--from SECONDS] [--figure FILE] [--table FILE]

A point is the mean over one second of a run, from --from on, that has pictures of the fluid: q*, and the speed half-way between the side walls from two
widths above the bed, over that of the law of the wall (thalweg.water). Open symbols: trt.
"""
import argparse
import csv
import sys
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg
from thalweg import bed, water

WINDOW = 1.0   # s
PAPER_MEAN, PAPER_DEVIATION = 0.089, 0.019


def points_of(run, begin):
    """Rows: begin of the window (s), speed over the law of the wall's, q*."""
    time, rate = bed.transport_rate(run, begin)
    above = bed.bed_height(run, begin, time[-1]) + water.FAR * run.size[1]
    rows = []
    for start in np.arange(begin, time[-1] - 0.9 * WINDOW, WINDOW):
        if not len(run.fluid.between(start, start + WINDOW)):
            continue
        inside = (time >= start) & (time < start + WINDOW)
        speed = water.middle_speed(run, start, start + WINDOW, above).mean()
        rows.append((start, speed / water.expected_middle_speed(run), rate[inside].mean()))
    return np.array(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN_FOLDER")
    parser.add_argument("--from", dest="begin", type=float, default=0.0, help="s")
    parser.add_argument("--figure", default="water_speed.png")
    parser.add_argument("--table")
    arguments = parser.parse_args()
    table = []
    _, axes = plt.subplots(figsize=(6.5, 4.2), layout="constrained")
    for n, folder in enumerate(arguments.runs):
        run = thalweg.Run(folder)
        rows = points_of(run, arguments.begin)
        open_symbol = run.case["fluid"]["collision"] == "trt"
        fine = run.diameter / run.case["domain"]["spacing"] > 8.0
        axes.plot(rows[:, 1], rows[:, 2], "s" if fine else "o", color=f"C{n % 10}", mfc="none" if open_symbol else None,
                  label=folder.name)
        table += [[folder.name, f"{start:.1f}", f"{speed:.3f}", f"{rate:.4f}"] for start, speed, rate in rows]
    axes.axhspan(PAPER_MEAN - PAPER_DEVIATION, PAPER_MEAN + PAPER_DEVIATION, color="0.9",
                 label="Zhang et al. at 0.028, mean and deviation")
    axes.axvline(1.0, color="0.6", lw=1)
    axes.set(xlabel="speed of the water over that of the law of the wall", ylabel="q*", ylim=(0.0, None))
    axes.legend(fontsize=7, loc="upper left")
    plt.savefig(arguments.figure, dpi=110)
    if arguments.table:
        with open(arguments.table, "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([["run", "from [s]", "speed over law of the wall [1]", "q_star [1]"], *table])


if __name__ == "__main__":
    main()
