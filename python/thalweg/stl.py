"""Surfaces of triangles as STL files, as `solids` and shapes of a case read them."""
from pathlib import Path

import numpy as np


def write_stl(path, triangles):
    """triangles: three corners (x, y, z) each, anticlockwise seen from outside; in metres where the case gives no
    scale."""
    name = Path(path).stem
    lines = [f"solid {name}"]
    for corners in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex {:.7g} {:.7g} {:.7g}".format(*corner) for corner in corners]
        lines += ["endloop", "endfacet"]
    Path(path).write_text("\n".join(lines + [f"endsolid {name}", ""]), encoding="utf-8")


def read_stl(path):
    """Corners (triangle, corner, axis) of a file, text or binary, that the program has read before."""
    data = Path(path).read_bytes()
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    count = int.from_bytes(data[80:84], "little")
    if len(data) == 84 + facet.itemsize * count:
        return np.frombuffer(data, facet, count, 84)["corners"].astype(float)
    words = data.decode("utf-8", "replace").lower().replace("d-", "e-").replace("d+", "e+").split()
    at = np.flatnonzero(np.array(words) == "vertex")
    return np.array([[float(words[n + k]) for k in (1, 2, 3)] for n in at]).reshape(-1, 3, 3)
