#!/usr/bin/env python3
"""Writes pier.stl: an upright cylinder of 12.5 mm, 30 mm behind the upstream end of the box, in its middle. In
metres."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python
from thalweg.stl import write_stl

RADIUS, LOW, HIGH, X, Y, FACETS = 6.25e-3, -2e-3, 55e-3, 30e-3, 25e-3, 48


def main():
    rim = [
        (X + RADIUS * math.cos(2 * math.pi * k / FACETS), Y + RADIUS * math.sin(2 * math.pi * k / FACETS))
        for k in range(FACETS)
    ]
    triangles = []
    for k in range(FACETS):
        one, other = rim[k - 1], rim[k]
        triangles += [((*one, LOW), (*other, LOW), (*other, HIGH)), ((*one, LOW), (*other, HIGH), (*one, HIGH)),
                      ((X, Y, HIGH), (*one, HIGH), (*other, HIGH)), ((X, Y, LOW), (*other, LOW), (*one, LOW))]
    write_stl(HERE / "pier.stl", triangles)


if __name__ == "__main__":
    main()
