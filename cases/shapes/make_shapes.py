#!/usr/bin/env python3
"""Writes the surfaces of this folder, each of the volume of a sphere of diameter 1."""
import argparse
from pathlib import Path

import numpy as np


def icosphere(level):
    """Directions (unit vectors) and triangles of an icosahedron whose triangles are divided in four `level` times."""
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    points = [(a * s, b * golden, 0.0) for b in (1, -1) for a, s in ((-1, 1.0), (1, 1.0))]
    points = [np.roll(p, turn) for turn in (0, 1, 2) for p in points]
    triangles = []
    for a in range(12):
        for b in range(12):
            for c in range(12):
                p, q, r = points[a], points[b], points[c]
                near = all(np.isclose(np.linalg.norm(u - v), 2.0) for u, v in ((p, q), (q, r), (r, p)))
                if near and a == min(a, b, c) and np.dot(p, np.cross(q, r)) > 0.0:
                    triangles.append((a, b, c))
    points = [p / np.linalg.norm(p) for p in points]
    for _ in range(level):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append((points[a] + points[b]) / np.linalg.norm(points[a] + points[b]))
            return middles[key]

        for a, b, c in triangles:
            d, e, f = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, d, f), (d, b, e), (f, e, c), (d, e, f)]
        triangles = finer
    return np.array(points), np.array(triangles)


def ellipsoid(directions, axes):
    return directions * np.array(axes)


def rounded_cube(directions):
    """|x|^6 + |y|^6 + |z|^6 = 1."""
    return directions / np.sum(directions**6, axis=1, keepdims=True) ** (1.0 / 6.0)


def pebble(directions):
    """An ellipsoid with bumps of low order, of which five facets are ground off."""
    axes = np.array([1.3, 1.0, 0.78])
    radius = 1.0 / np.linalg.norm(directions / axes, axis=1)
    random = np.random.Generator(np.random.PCG64(7))
    for order, height in ((2, 0.05), (3, 0.04), (4, 0.025), (6, 0.012)):
        for _ in range(4):  # powers of cosines are sums of spherical harmonics up to this order
            pole = random.normal(size=3)
            radius *= 1.0 + height * (directions @ (pole / np.linalg.norm(pole))) ** order * random.choice((-1.0, 1.0))
    for _ in range(5):
        normal = random.normal(size=3)
        cosine = directions @ (normal / np.linalg.norm(normal))
        support = np.max(radius * cosine)
        plane = (0.86 + 0.07 * random.random()) * support / np.maximum(cosine, 1e-9)
        radius = (radius**-12.0 + np.where(cosine > 0.0, plane, np.inf) ** -12.0) ** (-1.0 / 12.0)  # rounds the edge
    return directions * radius[:, None]


def centred_with_volume_of_unit_sphere(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    centre = (volumes[:, None] * (a + b + c) / 4.0).sum(axis=0) / volumes.sum()
    return (points - centre) * (np.pi / 6.0 / volumes.sum()) ** (1.0 / 3.0)


def write_binary_stl(path, points, triangles):
    facets = np.zeros(len(triangles), np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")]))
    facets["corners"] = points[triangles]
    path.write_bytes(path.stem.ljust(80).encode() + len(triangles).to_bytes(4, "little") + facets.tobytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?", default=Path(__file__).parent, help="default: that of the script")
    folder = parser.parse_args().folder
    directions, triangles = icosphere(3)
    shapes = {
        "prolate": ellipsoid(directions, (2.0, 1.0, 1.0)),
        "oblate": ellipsoid(directions, (2.0, 2.0, 1.0)),
        "triaxial": ellipsoid(directions, (1.5, 1.0, 0.65)),
        "rounded_cube": rounded_cube(directions),
        "pebble": pebble(directions),
    }
    for name, points in shapes.items():
        write_binary_stl(folder / f"{name}.stl", centred_with_volume_of_unit_sphere(points, triangles), triangles)


if __name__ == "__main__":
    main()
