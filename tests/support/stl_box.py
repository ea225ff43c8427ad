"""A box as an STL file."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
from thalweg.stl import write_stl

FACES = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]


def write_box(path, low, high, leave_out=0):
    """From corner to corner, less the first triangles."""
    corner = [[(low, high)[n >> a & 1][a] for a in range(3)] for n in range(8)]
    triangles = [[corner[n] for n in t] for a, b, c, d in FACES for t in ((a, b, c), (a, c, d))]
    write_stl(path, triangles[leave_out:])
