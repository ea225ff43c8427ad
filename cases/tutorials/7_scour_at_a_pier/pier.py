#!/usr/bin/python3
"""Writes pier.stl: an upright cylinder of 12.5 mm, 30 mm behind the upstream end of the box, in its middle. In metres."""
import math
from pathlib import Path

RADIUS, LOW, HIGH, X, Y, FACETS = 6.25e-3, -2e-3, 55e-3, 30e-3, 25e-3, 48


def main():
    rim = [(X + RADIUS * math.cos(2 * math.pi * k / FACETS), Y + RADIUS * math.sin(2 * math.pi * k / FACETS)) for k in range(FACETS)]
    triangles = []
    for k in range(FACETS):
        one, other = rim[k - 1], rim[k]
        triangles += [((*one, LOW), (*other, LOW), (*other, HIGH)), ((*one, LOW), (*other, HIGH), (*one, HIGH)),
                      ((X, Y, HIGH), (*one, HIGH), (*other, HIGH)), ((X, Y, LOW), (*other, LOW), (*one, LOW))]
    with open(Path(__file__).with_name("pier.stl"), "w") as file:
        file.write("solid pier\n")
        for corners in triangles:
            file.write("facet normal 0 0 0\nouter loop\n")
            file.writelines("vertex {:.7g} {:.7g} {:.7g}\n".format(*corner) for corner in corners)
            file.write("endloop\nendfacet\n")
        file.write("endsolid pier\n")


if __name__ == "__main__":
    main()
