#!/usr/bin/env python3
"""q* of the flume against the speed of its water: water_speed.py RUN_FOLDER... [--figure FILE] [--table FILE]

Each point is a mean over the time in which the fluid was averaged (analysis.fluid_statistics.from): q* with its
standard error, and the mean water speed over the width, from two widths above the bed upwards, divided by that of the
law of the wall at the side walls (thalweg.water). Open symbols: trt; squares: ten cells per diameter. The table of the
points is updated, and all its rows are drawn.
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt

import thalweg
from thalweg import bed, literature, water
from thalweg.drawing import colour_of
from thalweg.tables import merged_rows

HEADINGS = ["run", "collision", "cells per diameter [1]", "mean speed over law of the wall [1]",
            "middle speed over law of the wall [1]", "q_star [1]", "error [1]"]


def measure(run):
    """Mean of q*, and the speeds divided by those of the law of the wall."""
    start = run.averaged_from("fluid_statistics")
    _, rate = bed.transport_rate(run, start)
    above = bed.bed_height(run, start, run.series["time"][-1]) + water.FAR * run.size[1]
    speeds, expected = water.measured_speeds(run, above), water.expected_speeds(run)
    return thalweg.mean_with_error(rate), speeds.mean / expected.mean, speeds.middle / expected.middle


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="*", type=Path, metavar="RUN_FOLDER")
    parser.add_argument("--figure", default="water_speed.png")
    parser.add_argument("--table")
    arguments = parser.parse_args()
    rows = []
    _, axes = plt.subplots(figsize=(8.5, 4.2), layout="constrained")
    for folder in arguments.runs:
        run = thalweg.Run(folder)
        rate, mean, middle = measure(run)
        rows.append(
            dict(
                zip(
                    HEADINGS,
                    [
                        folder.name, run.case["fluid"]["collision"],
                        f"{run.diameter / run.case['domain']['spacing']:.1f}", f"{mean:.3f}", f"{middle:.3f}",
                        f"{rate.mean:.4f}", f"{rate.error:.4f}",
                    ],
                )
            )
        )
    rows = merged_rows(arguments.table, rows)
    for n, row in enumerate(rows):
        speed, rate, error = (float(row[HEADINGS[column]]) for column in (3, 5, 6))
        axes.errorbar(
            speed, rate, error, fmt="s" if float(row[HEADINGS[2]]) > 8.0 else "o", color=colour_of(n), capsize=3,
            mfc="none" if row["collision"] == "trt" else None, label=row["run"],
        )
    axes.axhspan(*literature.flume_band(), color="0.9",
                 label="Zhang et al. at 0.028, mean and deviation")
    axes.axvline(1.0, color="0.6", lw=1)
    axes.set(xlabel="mean speed of the water over that of the law of the wall", ylabel="q*", ylim=(0.0, None))
    axes.legend(fontsize=7, frameon=False, loc="center left", bbox_to_anchor=(1.01, 0.5))
    plt.savefig(arguments.figure, dpi=110)
    print("\n".join(", ".join(row) for row in [HEADINGS, *(list(row.values()) for row in rows)]))


if __name__ == "__main__":
    main()
