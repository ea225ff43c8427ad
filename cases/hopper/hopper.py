#!/usr/bin/env python3
"""Writes the surfaces of the hopper: hopper.py [--orifice DIAMETER] [--facets N]

hopper.stl is a cylindrical bin with a flat bottom and a round orifice in its middle, plug.stl a disk that closes it. In
metres.
"""
import argparse
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))
import thalweg_python
from thalweg.stl import write_stl

BIN, WALL, BOTTOM, TOP = (
    0.050, 0.003, 0.060, 0.295,
)  # m: inner diameter, thickness, heights of the bottom's upper side and the rim


def ring(radius, height, facets):
    return [
        (radius * math.cos(2 * math.pi * k / facets), radius * math.sin(2 * math.pi * k / facets), height)
        for k in range(facets)
    ]


def turned(rings):
    """Triangles of a body of revolution between rings that follow each other round its section, seen from outside."""
    triangles = []
    for one, next_one in zip(rings, rings[1:] + rings[:1]):
        for k in range(len(one)):
            a, b, c, d = one[k], one[k - 1], next_one[k - 1], next_one[k]
            triangles += [(a, b, c), (a, c, d)]
    return triangles


def disk(radius, low, high, facets):
    lower, upper = ring(radius, low, facets), ring(radius, high, facets)
    triangles = []
    for k in range(facets):
        triangles += [((0, 0, low), lower[k], lower[k - 1]), ((0, 0, high), upper[k - 1], upper[k]),
                      (lower[k - 1], lower[k], upper[k]), (lower[k - 1], upper[k], upper[k - 1])]
    return triangles


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--orifice", type=float, default=0.020, help="its diameter, m (default: 0.020)")
    parser.add_argument("--facets", type=int, default=36, help="to the turn (default: 36)")
    arguments = parser.parse_args()
    n, hole, inner, outer = arguments.facets, 0.5 * arguments.orifice, 0.5 * BIN, 0.5 * BIN + WALL
    write_stl(
        HERE / "hopper.stl",
        turned(
            [
                ring(hole + WALL, BOTTOM - WALL, n), ring(hole, BOTTOM, n), ring(inner, BOTTOM, n), ring(inner, TOP, n),
                ring(outer, TOP, n), ring(outer, BOTTOM - WALL, n),
            ]
        ),
    )
    write_stl(HERE / "plug.stl", disk(hole + 0.5 * WALL, BOTTOM - 2 * WALL, BOTTOM - WALL, n))


if __name__ == "__main__":
    main()
