#!/usr/bin/env python3
"""Drift of the grains and flow left in a bed at rest: compare.py RUN [--from SECONDS]"""
import argparse
import csv
import pathlib
import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from grain_pictures import pictures

DIAMETER, SETTLING_SPEED = 5.0e-3, 0.336  # m; m/s, Schiller and Naumann 1935
LARGEST_DRIFT, LARGEST_FLOW = 1e-6, 1e-4  # diameters; settling speeds


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=pathlib.Path)
    parser.add_argument("--from", dest="start", type=float, default=0.0, help="time from which nothing may move (s)")
    arguments = parser.parse_args()
    places = [(t, vtk_to_numpy(grains.GetPoints().GetData()).copy()) for t, grains in pictures(arguments.run)
              if t >= arguments.start - 1e-9]
    drift = max(np.linalg.norm(p - places[0][1], axis=1).max() for _, p in places) / DIAMETER
    with open(arguments.run / "series.csv", newline="") as file:
        rows = list(csv.reader(file))
    time = next(n for n, name in enumerate(rows[0]) if name.startswith("time"))
    speed = next(n for n, name in enumerate(rows[0]) if name.startswith("largest_fluid_speed"))
    flow = max(float(row[speed]) for row in rows[1:] if float(row[time]) >= arguments.start) / SETTLING_SPEED
    print(f"from {places[0][0]:g} to {places[-1][0]:g} s: grains drift {drift:.2g} diameters "
          f"(bound {LARGEST_DRIFT:g}), water moves at {flow:.2g} settling speeds (bound {LARGEST_FLOW:g})")
    return 0 if drift <= LARGEST_DRIFT and flow <= LARGEST_FLOW else 1


if __name__ == "__main__":
    sys.exit(main())
