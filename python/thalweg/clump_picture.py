"""Picture of a surface of triangles and of the spheres that stand for it, side by side."""
from pathlib import Path

import numpy as np

from thalweg.case_file import read_case
from thalweg.errors import RunFolderError
from thalweg.stl import read_stl

PIXELS = 420  # along each side of a view
# Directions from which the views are taken, in the frame of the surface.
VIEWS = ((0.0, -1.0, 0.0), (1.0, -1.0, 0.9))
LIGHT = np.array([-0.4, 0.6, 0.8])  # along right, up and towards the viewer


def add_to(commands):
    parser = commands.add_parser("clump-picture", description="Part of `thalweg clump`, which draws with it.")
    parser.add_argument("surface", type=Path, metavar="MESH.stl")
    parser.add_argument("spheres", type=Path, metavar="SPHERES.yaml")
    parser.add_argument("picture", type=Path, metavar="PICTURE.png")
    parser.add_argument("--scale", type=float, default=1.0, help="Metres per unit of the STL file")


def frame_of(direction):
    """Rows: the directions right, up and towards the viewer."""
    towards = np.asarray(direction) / np.linalg.norm(direction)
    right = np.cross((0.0, 0.0, 1.0), towards)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(towards, right), towards])


def shaded(normals):
    """Brightness of surfaces with these normals, which need not be unit vectors."""
    lengths = np.linalg.norm(normals, axis=-1)
    cosine = normals @ (LIGHT / np.linalg.norm(LIGHT)) / np.where(lengths > 0.0, lengths, 1.0)
    return 0.35 + 0.6 * np.clip(cosine, 0.0, 1.0)


class View:
    """Brightness of what is nearest to the viewer at each pixel of a square; not a number where there is nothing."""

    def __init__(self, half):
        self.centres = (np.arange(PIXELS) + 0.5) / PIXELS * 2.0 * half - half
        self.depth = np.full((PIXELS, PIXELS), -np.inf)
        self.brightness = np.full((PIXELS, PIXELS), np.nan)

    def window(self, lower, upper):
        first = np.searchsorted(self.centres, lower)
        last = np.searchsorted(self.centres, upper, side="right")
        return slice(first[1], last[1]), slice(first[0], last[0])

    def put(self, window, depth, brightness):
        nearer = depth > self.depth[window]
        self.depth[window] = np.where(nearer, depth, self.depth[window])
        self.brightness[window] = np.where(nearer, brightness, self.brightness[window])

    def add_sphere(self, centre, radius):
        window = self.window(centre[:2] - radius, centre[:2] + radius)
        x, y = self.centres[window[1]] - centre[0], self.centres[window[0]][:, None] - centre[1]
        squared = radius**2 - x**2 - y**2
        height = np.sqrt(np.maximum(squared, 0.0))
        normals = np.stack(np.broadcast_arrays(x, y, height), axis=-1)
        self.put(window, np.where(squared > 0.0, centre[2] + height, -np.inf), shaded(normals))

    def add_triangle(self, corners):
        a, u, v = corners[0], corners[1] - corners[0], corners[2] - corners[0]
        normal = np.cross(u, v)
        if normal[2] <= 0.0:  # seen from behind
            return
        window = self.window(corners[:, :2].min(axis=0), corners[:, :2].max(axis=0))
        x, y = self.centres[window[1]] - a[0], self.centres[window[0]][:, None] - a[1]
        s, t = (x * v[1] - y * v[0]) / normal[2], (y * u[0] - x * u[1]) / normal[2]
        inside = (s >= -1e-9) & (t >= -1e-9) & (s + t <= 1.0 + 1e-9)
        self.put(window, np.where(inside, a[2] + s * u[2] + t * v[2], -np.inf), float(shaded(normal)))


def read_spheres(path):
    """Centres and radii, m, of the shape that `thalweg clump` has written."""
    spheres = read_case(path)["shape"]["clump"]
    return np.array([s["position"] for s in spheres], float), np.array([s["diameter"] for s in spheres]) / 2.0


def views_of(triangles, centres, radii):
    """For each direction the brightness of the surface and of the spheres, and half the width of both, m."""
    middle = (triangles.min(axis=(0, 1)) + triangles.max(axis=(0, 1))) / 2.0
    half = 1.08 * max(np.linalg.norm(triangles - middle, axis=-1).max(),
                      (np.linalg.norm(centres - middle, axis=-1) + radii).max())
    for direction in VIEWS:
        frame = frame_of(direction)
        surface, spheres = View(half), View(half)
        for corners in (triangles - middle) @ frame.T:
            surface.add_triangle(corners)
        for centre, radius in zip((centres - middle) @ frame.T, radii):
            spheres.add_sphere(centre, radius)
        yield surface.brightness, spheres.brightness, half


def clump_picture(wanted):
    try:
        import matplotlib
    except ModuleNotFoundError as missing:
        raise RunFolderError(f"a picture needs the module {missing.name}; install python3-matplotlib.") from missing
    matplotlib.use("Agg")
    from matplotlib import pyplot

    triangles = wanted.scale * read_stl(wanted.surface)
    centres, radii = read_spheres(wanted.spheres)
    figure, axes = pyplot.subplots(len(VIEWS), 2, figsize=(7.0, 3.5 * len(VIEWS)), layout="constrained")
    titles = (f"{wanted.surface.name}: {len(triangles)} triangles", f"{len(radii)} spheres")
    for row, (surface, spheres, half) in zip(axes, views_of(triangles, centres, radii)):
        for place, brightness in zip(row, (surface, spheres)):
            extent = [1e3 * x for x in (-half, half, -half, half)]
            place.imshow(brightness, origin="lower", cmap="gray", vmin=0.0, vmax=1.0, extent=extent)
            place.set_xlabel("mm")
            place.spines[["top", "right"]].set_visible(False)
    for place, title in zip(axes[0], titles):
        place.set_title(title, fontsize="medium")
    figure.savefig(wanted.picture, dpi=150)
    print(f"picture {wanted.picture}")
    return 0
