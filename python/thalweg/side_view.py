"""A bed as a camera beside the flume sees it: along +y, so that a small y is in front.

What is visible and what is at rest follows Zhang et al. (2022), sec. 2.2, who mimic the images of their experiment.
"""
from typing import NamedTuple

import numpy as np

from thalweg.errors import RunFolderError
from thalweg.obstacles import floating, obstacles
from thalweg.units import units_of

COVERED = 0.6         # share of its perimeter behind others from which a grain is invisible
NEAREST = 1.0 / 6.0   # diameters: of two projections closer than this only the front one is visible
PIXEL = 1.0 / 25.0    # diameters
AT_REST = 0.5         # s: a pixel that shows the same grain for so long is static


def with_images_along_x(position, radius, length):
    """Positions and radii with copies of the grains that stick out of a box that is periodic along x, and whose they
    are."""
    x, owner = position[:, 0], np.arange(len(position))
    low, high = x < radius, x > length - radius
    shift = np.array([length, 0.0, 0.0])
    place = np.vstack([position, position[low] + shift, position[high] - shift])
    owner = np.concatenate([owner, owner[low], owner[high]])
    return place, radius[owner], owner


def front_grains(position, radius, size, pixel, periodic_x=True):
    """Which grain each pixel shows, as [z, x] from the lower left; -1: none. `size`: of the box, `pixel` in m."""
    owner = np.arange(len(position))
    if periodic_x:
        position, radius, owner = with_images_along_x(position, radius, size[0])
    width, height = round(size[0] / pixel), round(size[2] / pixel)
    shown, depth = np.full((height, width), -1), np.full((height, width), np.inf)
    for (x, y, z), r, grain in zip(position, radius, owner):
        i = np.arange(max(int((x - r) / pixel), 0), min(int((x + r) / pixel) + 1, width))
        k = np.arange(max(int((z - r) / pixel), 0), min(int((z + r) / pixel) + 1, height))
        if not len(i) or not len(k):
            continue
        reach = r * r - ((i + 0.5) * pixel - x)**2 - ((k + 0.5) * pixel - z)[:, None]**2
        near = y - np.sqrt(np.maximum(reach, 0.0))
        place = np.ix_(k, i)
        front = (reach > 0.0) & (near < depth[place])
        shown[place] = np.where(front, grain, shown[place])
        depth[place] = np.where(front, near, depth[place])
    return shown


class Surface(NamedTuple):
    """Outline of the static pixels: height (m) over x (m) of columns one pixel wide; zero where nothing is static."""
    x: np.ndarray
    height: np.ndarray

    @property
    def mean(self):
        """m, of the columns where something is static; NaN where nothing is."""
        static = self.height[self.height > 0.0]
        return float(static.mean()) if len(static) else float("nan")

    def at(self, x, length=None):
        """Height (m) at places along the box, which is periodic with that length (m) if one is given."""
        return np.interp(x, self.x, self.height, period=length)


def static_surface(run, time=None, duration=AT_REST):
    """Surface of the bed at a time in s (the last frame if None): the outline, from above, of the pixels that showed
    the same grain in all frames of the `duration` (s) around it, or at the ends of a run before or after it. Grains that
    float over the bed and obstacles in it are left out."""
    times, second = run.grains.times, units_of(run).named("s")
    if len(times) < 2 or times[-1] - times[0] < duration:
        raise RunFolderError(f"{run.folder}: static pixels need frames of the grains over {duration:g} {second}.")
    middle = times[-1] if time is None else time
    start = min(max(middle - duration / 2, times[0]), times[-1] - duration)
    window = run.grains.between(start, start + duration)
    if len(window) < 3:
        raise RunFolderError(f"{run.folder}: static pixels need three frames of the grains in {duration:g} {second}; "
                             f"set output.grains.every to {duration / 5:g} {second} or less.")
    return surface_of(window, run.size, PIXEL * run.diameter, run.periodic[0], lambda frame: not_of_the_bed(run, frame))


def not_of_the_bed(run, frame):
    """Which grains of a frame float over the bed or are obstacles in it; obstacles that are all the grains are the
    bed."""
    stands = obstacles(run, frame)
    return floating(run, frame) | (stands & ~stands.all())


def surface_of(frames, size, pixel, periodic_x=True, left_out=None):
    """Outline of the pixels that show the same grain in all frames; see static_surface(). left_out: which grains of a
    frame are not looked at."""
    first, static = None, None
    for frame in frames:
        kept = np.ones(len(frame), bool) if left_out is None else ~left_out(frame)
        shown = front_grains(frame.position[kept], frame.radius[kept], size, pixel, periodic_x)
        identity = np.where(shown >= 0, frame.id[kept][shown], -1)
        first = identity if first is None else first
        static = (identity == first if static is None else static & (identity == first))
    static &= first >= 0
    count = static.shape[0]
    top = np.where(static.any(axis=0), count - np.argmax(static[::-1], axis=0), 0)
    return Surface((np.arange(static.shape[1]) + 0.5) * size[0] / static.shape[1], top * size[2] / count)


def visible_grains(position, radius, length=None, directions=120):
    """Whether the camera's evaluation sees each grain: no more than 60 % of its perimeter is behind others, and no
    visible grain in front of it is closer in projection than a sixth of a diameter. `length`: of a periodic box along x
    (m)."""
    place, size, owner = (position, radius, np.arange(len(radius))) if length is None else with_images_along_x(
        position, radius, length)
    angle = 2.0 * np.pi * (np.arange(directions) + 0.5) / directions
    around = np.column_stack([np.cos(angle), np.sin(angle)])
    seen = np.zeros(len(radius), bool)
    for grain in np.argsort(position[:, 1], kind="stable"):
        in_front = (place[:, 1] < position[grain, 1]) & (owner != grain)
        offset = place[:, [0, 2]] - position[grain, [0, 2]]
        apart = np.hypot(*offset.T)
        near = np.flatnonzero(in_front & (apart < size + radius[grain]))
        rim = radius[grain] * around
        covered = (np.hypot(rim[:, None, 0] - offset[near, 0], rim[:, None, 1] - offset[near, 1]) < size[near]).any(
            axis=1
        )
        too_near = (apart[near] < 2.0 * NEAREST * radius[grain]) & seen[owner[near]]
        seen[grain] = covered.mean() <= COVERED and not too_near.any()
    return seen
