#!/usr/bin/env python3
"""Drift of the grains and residual flow in a bed at rest: compare.py RUN [--from SECONDS] [--flowing]

With --flowing the bed is under flowing water: the speeds of its grains.
"""
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import numpy as np

import thalweg

DIAMETER, SETTLING_SPEED = 5.0e-3, 0.336  # m; m/s, Schiller and Naumann 1935
LARGEST_DRIFT, LARGEST_FLOW = 1e-6, 1e-4  # diameters; settling speeds
LARGEST_MEDIAN = 1e-4  # m/s, of grains under flowing water


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=pathlib.Path)
    parser.add_argument("--from", dest="start", type=float, default=0.0, help="time from which nothing may move (s)")
    parser.add_argument("--flowing", action="store_true")
    arguments = parser.parse_args()
    run = thalweg.Run(arguments.run)
    if arguments.flowing:
        speeds = np.array([np.linalg.norm(frame.velocity, axis=1) for frame in run.grains.between(arguments.start)])
        print(f"speeds of the grains from {arguments.start:g} s on: median {np.median(speeds):.2g} m/s (bound "
              f"{LARGEST_MEDIAN:g}), 99 % below {np.quantile(speeds, 0.99):.2g} m/s")
        return 0 if np.median(speeds) <= LARGEST_MEDIAN else 1
    places = [(frame.time, frame.position) for frame in run.grains.between(arguments.start)]
    drift = max(np.linalg.norm(p - places[0][1], axis=1).max() for _, p in places) / DIAMETER
    series = run.series
    flow = series["largest_fluid_speed"][series["time"] >= arguments.start].max() / SETTLING_SPEED
    print(f"from {places[0][0]:g} to {places[-1][0]:g} s: grains drift {drift:.2g} diameters "
          f"(bound {LARGEST_DRIFT:g}), water moves at {flow:.2g} settling speeds (bound {LARGEST_FLOW:g})")
    return 0 if drift <= LARGEST_DRIFT and flow <= LARGEST_FLOW else 1


if __name__ == "__main__":
    sys.exit(main())
