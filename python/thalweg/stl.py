"""Surfaces of triangles as text STL files, as `solids` of a case read them."""
from pathlib import Path


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
