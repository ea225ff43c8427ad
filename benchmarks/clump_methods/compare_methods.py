#!/usr/bin/env python3
"""Compares the spheres of `thalweg clump` with those of the Euclidean method of Angelidakis et al. (2021).

compare_methods.py THALWEG SURFACE.stl...    prints a row of the table of README.md for each surface, method and number
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
from thalweg.clump_picture import read_spheres
from thalweg.stl import read_stl

RESOLUTION = 40        # voxels along the longest extent
NUMBERS = (5, 10, 20)
OVERLAPS = (0.0, 0.3, 0.6)


def surface_points(triangles):
    """Centroids of the quarters of all triangles, their shares of the area, and outward normals."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    d, e, f = (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0
    corners = np.concatenate([np.stack(t, axis=1) for t in ((a, d, f), (d, b, e), (f, e, c), (d, e, f))])
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2.0
    return corners.mean(axis=1), np.linalg.norm(normals, axis=1), normals


def voxels_inside(triangles):
    """Centres of the voxels inside, their distances from the surface, and the length of a voxel."""
    lower, upper = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
    step = (upper - lower).max() / RESOLUTION
    axes = [np.arange(low + step / 2.0, high, step) for low, high in zip(lower, upper)]
    centres = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    points, _, normals = surface_points(triangles)
    inside, distances = [], []
    for part in np.array_split(centres, len(centres) // 4000 + 1):
        squared = (part**2).sum(axis=1)[:, None] - 2.0 * part @ points.T + (points**2).sum(axis=1)
        nearest = squared.argmin(axis=1)
        inside.append(np.einsum("ij,ij->i", part - points[nearest], normals[nearest]) < 0.0)
        distances.append(np.sqrt(np.maximum(squared.min(axis=1), 0.0)))
    inside = np.concatenate(inside)
    return centres[inside], np.concatenate(distances)[inside], step


def euclidean_spheres(centres, distances, number, overlap):
    """The largest sphere in what is left, again and again; (1 - overlap) of each radius is taken off."""
    left, spheres = distances.copy(), []
    for _ in range(number):
        best = left.argmax()
        spheres.append((*centres[best], left[best]))
        left = np.minimum(left, np.linalg.norm(centres - centres[best], axis=1) - (1.0 - overlap) * left[best])
    return np.array(spheres)


def gaps(points, spheres):
    return np.min([np.linalg.norm(points - s[:3], axis=1) - s[3] for s in spheres], axis=0)


def grown(spheres, volume, grid, cell):
    """Radii larger by one length, so that the union has the volume."""
    gap = np.sort(gaps(grid, spheres))
    return spheres + [0.0, 0.0, 0.0, gap[int(round(volume / cell))]]


def figures(spheres, triangles, volume, moments, grid, cell):
    """Mean distance and largest error of the moments of the grown spheres."""
    points, areas, _ = surface_points(triangles)
    larger = grown(spheres, volume, grid, cell)
    of_union = principal_moments(grid[gaps(grid, larger) < 0.0], cell)
    distance = np.average(np.abs(gaps(points, larger)), weights=areas) / (6.0 * volume / np.pi) ** (1.0 / 3.0)
    return distance, np.abs(of_union / moments - 1.0).max()


def principal_moments(points, cell):
    away = points - points.mean(axis=0)
    second = away.T @ away * cell
    return np.linalg.eigvalsh(np.trace(second) * np.eye(3) - second)


def greedy_spheres(program, surface, number):
    """The spheres of `thalweg clump`, which have grown already, and the share of the volume that they held before."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "clump"
        command = [program, "clump", surface, "--spheres", str(number), "--scale", "0.001", "--out", out]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        centres, radii = read_spheres(out.with_suffix(".yaml"))
    held = float(re.search(r"volume +([\d.]+) % in the inscribed", done.stdout)[1]) / 100.0
    return 1000.0 * np.column_stack([centres, radii]), held   # in the unit of the file


def compare(program, surface):
    triangles = read_stl(surface)
    centres, distances, step = voxels_inside(triangles)
    volume = len(centres) * step**3
    moments = principal_moments(centres, step**3)
    lower, upper = triangles.min(axis=(0, 1)) - 0.1, triangles.max(axis=(0, 1)) + 0.1
    axes = [np.arange(a, b, step) for a, b in zip(lower, upper)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    for number in NUMBERS:
        methods = {}
        for overlap in OVERLAPS:
            spheres = euclidean_spheres(centres, distances, number, overlap)
            methods[f"Euclidean, overlap {overlap:g}"] = spheres, np.mean(gaps(centres, spheres) < 0.0)
        methods["volume won"] = greedy_spheres(program, surface, number)
        for method, (spheres, held) in methods.items():
            distance, error = figures(spheres, triangles, volume, moments, grid, step**3)
            print(f"| {Path(surface).stem} | {number} | {method} | {100 * held:.1f} | {100 * distance:.2f} | "
                  f"{100 * error:.1f} |", flush=True)


if __name__ == "__main__":
    for name in sys.argv[2:]:
        compare(sys.argv[1], name)
