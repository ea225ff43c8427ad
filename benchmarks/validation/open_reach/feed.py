#!/usr/bin/env python3
"""The flume of tutorial 9 from two beds: grains in it and grains that leave. feed.py RUN RUN [--figure FILE]"""
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import numpy as np

from thalweg import Run

INTERVAL = 1.0             # s, over which grains that leave are counted
BETWEEN = (0.030, 0.170)   # m: from the supply to the sill


def leaving(series):
    """Middles of the intervals (s), and grains that leave in each for one that comes."""
    edges = np.arange(0.0, series["time"][-1] + 1e-6, INTERVAL)
    left, fed = (np.diff(np.interp(edges, series["time"], series[name])) for name in ("left_grains", "supplied_grains"))
    return 0.5 * (edges[1:] + edges[:-1]), left / fed


def report(run):
    series, means = run.series, run.profiles["reach"]
    lost = series["grains"][0] + series["supplied_grains"][-1] - series["left_grains"][-1] - series["grains"][-1]
    between = (means["section"] > BETWEEN[0]) & (means["section"] < BETWEEN[1])
    counted = series["time"] >= run.averaged_from("reach")
    left, fed = (series[name][counted][-1] - series[name][counted][0] for name in ("left_grains", "supplied_grains"))
    print(f"{run.folder}: {series['grains'][0]:.0f} to {series['grains'][-1]:.0f} grains, {lost:.0f} lost; from "
          f"{series['time'][counted][0]:.2f} to {series['time'][-1]:.2f} s: q* {means['q_star'][between].mean():.3f}, "
          f"{left:.0f} left and {fed:.0f} fed ({left / fed:.2f})")
    for time, share in zip(*leaving(series)):
        print(f"  {time:.1f} s: {share:.2f} leave for one that comes")


def draw(file, runs):
    from matplotlib import pyplot
    figure, (inside, rate) = pyplot.subplots(1, 2, figsize=(9, 3.2), layout="constrained")
    for run, colour, name in zip(runs, ("#14496e", "#c0392b"), ("from too little", "from too much")):
        inside.plot(run.series["time"], run.series["grains"], color=colour, label=name)
        rate.plot(*leaving(run.series), "o-", ms=4, color=colour)
    rate.axhline(1.0, color="0.5", lw=0.8)
    inside.set(xlabel="time [s]", ylabel="grains in the flume", ylim=(0, None))
    rate.set(xlabel="time [s]", ylabel="grains that leave for one that comes", ylim=(0, None))
    inside.legend(frameon=False)
    figure.savefig(file, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=pathlib.Path, nargs=2)
    parser.add_argument("--figure", type=pathlib.Path, help="draw both")
    arguments = parser.parse_args()
    runs = [Run(folder) for folder in arguments.run]
    for run in runs:
        report(run)
    if arguments.figure:
        draw(arguments.figure, runs)


if __name__ == "__main__":
    main()
