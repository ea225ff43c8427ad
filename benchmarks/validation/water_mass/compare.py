#!/usr/bin/env python3
"""Whether a flume conserves its water and its bed comes to rest: compare.py RUN_FOLDER [--before FILE] [--figure FILE]

From 2 s on, prints and judges
  the largest deviation of the mean density from its start, at all times (bound 1e-5),
  the fastest grain inside the bed (more than three diameters below its surface; bound 1 mm/s),
  the mean transport rate in each third of the rest (finite; shown).
--before: the columns time, mean density deviation, q* and moving grains of another run, drawn beside it.
Writes the same columns of this run to FILE with --table. Exit code 0 if all pass.
"""
import argparse
import csv
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

import thalweg
from thalweg.tables import read_series

COLUMNS = ("time", "mean_density_deviation", "q_star", "moving_grains")
SETTLED = 2.0  # s


def table(path):
    series = read_series(path)
    return np.array([series[column] for column in COLUMNS])


def speeds_inside(run, diameter):
    """Times (s) and median, 99 % quantile and largest of the speeds (m/s) of the grains more than three diameters below
    the surface of the bed, which is the height below which nine tenths of the grains are."""
    times, speeds = [], []
    for frame in run.grains:
        height, speed = frame.position[:, 2], np.linalg.norm(frame.velocity, axis=1)
        inside = height < np.quantile(height, 0.9) - 3.0 * diameter
        times.append(frame.time)
        speeds.append(np.quantile(speed[inside], (0.5, 0.99, 1.0)))
    return np.array(times), np.array(speeds).T


def draw(arguments, here, before, inside):
    figure, axes = plt.subplots(4, 1, figsize=(7, 8), sharex=True)
    for data, label, colour in ((before, "before", "tab:red"), (here, "now", "tab:blue")):
        if data is None:
            continue
        axes[0].semilogy(data[0], np.maximum(np.abs(data[1]), 1e-9), color=colour, label=label, lw=0.8)
        axes[1].plot(data[0], data[2], color=colour, lw=0.8)
        axes[2].plot(data[0], data[3], color=colour, lw=0.8)
    axes[0].axhline(1e-5, color="grey", lw=0.8, ls=":")
    for speed, label, style in zip(inside[1], ("median", "99 %", "fastest"), (":", "--", "-")):
        axes[3].semilogy(inside[0], np.maximum(speed, 1e-7), style, lw=0.8, color="tab:blue", label=label)
    axes[3].axhline(1e-3, color="grey", lw=0.8, ls=":")
    axes[3].legend(ncol=3)
    for axis, label in zip(axes, ("|mean density deviation|", "q*", "moving grains", "speed inside the bed, m/s")):
        axis.set_ylabel(label)
    axes[0].legend()
    axes[3].set_xlabel("time, s")
    figure.tight_layout()
    figure.savefig(arguments.figure, dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path, metavar="RUN_FOLDER")
    parser.add_argument("--before", type=Path)
    parser.add_argument("--table", type=Path)
    parser.add_argument("--figure", default="water_mass.png")
    arguments = parser.parse_args()

    here = table(arguments.run / "series.csv")
    before = table(arguments.before) if arguments.before else None
    run = thalweg.Run(arguments.run)
    inside = speeds_inside(run, run.diameter)
    density = np.abs(here[1]).max()
    settled = inside[0] >= SETTLED
    median, most, fastest = inside[1][:, settled].max(axis=1) if settled.any() else (np.inf,) * 3
    thirds = np.array_split(here[2][here[0] >= SETTLED], 3)
    passed = density < 1e-5 and fastest < 1e-3 and np.isfinite(here[2]).all()
    print(f"mean density deviation    at most {density:.2g} (bound 1e-5)")
    print(f"fastest inside the bed    {fastest:.2g} m/s from {SETTLED:g} s on (bound 1e-3)")
    print(f"  all but one in a hundred  {most:.2g} m/s;  median {median:.2g} m/s (the largest of all times)")
    print("q* in thirds of the rest  " + ", ".join(f"{third.mean():.4f}" for third in thirds if third.size))
    print("pass" if passed else "FAIL")
    draw(arguments, here, before, inside)
    if arguments.table:
        with open(arguments.table, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(["time [s]", *(f"{name} [1]" for name in COLUMNS[1:])])
            writer.writerows([f"{value:.6g}" for value in row] for row in here[:, ::5].T)
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
