"""Profiles of the grains that a camera beside the flume sees, over the height from the bed's surface."""
import numpy as np

from thalweg.columns import Columns
from thalweg.errors import RunFolderError
from thalweg.layers import disk_below, parts_in_layers
from thalweg.side_view import static_surface, visible_grains

UNITS = {"z": "m", "areal_fraction": "1", "velocity": "m/s", "temperature": "m^2/s^2"}
ROUND_OFF = 1e-12   # of a velocity, by which that of a grain alone in a layer may differ from their mean


class VisibleSums:
    """Sums over frames of the visible grains in layers; edges in m from the surface, length of the box in m.

    Zhang et al. (2022), sec. 2.2: the height of a grain is that of its centre over the surface below it; the areal
    fraction is that of the visible disks, the velocity that of a layer's momentum. The temperature is half the variance
    of the two velocities in the frame's plane about the mean of the layer in the same frame.
    """

    def __init__(self, edges, length, periodic=True):
        self.edges, self.length, self.period = np.asarray(edges, float), length, length if periodic else None
        layers = len(edges) - 1
        self.frames, self.area = 0, np.zeros(layers)
        self.momentum, self.deviation = np.zeros((layers, 2)), np.zeros(layers)

    def add(self, frame, surface):
        seen = visible_grains(frame.position, frame.radius, self.period)
        position, radius, velocity = frame.position[seen], frame.radius[seen], frame.velocity[seen][:, [0, 2]]
        height = position[:, 2] - surface.at(position[:, 0], self.period)
        part = parts_in_layers(self.edges, height, radius, disk_below)
        area, momentum = part.sum(axis=1), part @ velocity
        self.frames += 1
        self.area += area
        self.momentum += momentum
        mean = momentum / np.where(area > 0.0, area, 1.0)[:, None]
        apart = velocity[None] - mean[:, None]
        apart[np.abs(apart) < ROUND_OFF * np.abs(velocity)] = 0.0
        self.deviation += np.sum(part * np.sum(apart**2, axis=2), axis=1)

    def profiles(self):
        """Columns over z: areal fraction, velocity (x, z) and temperature, NaN where no grain was seen."""
        if self.frames == 0:
            raise RunFolderError("there is no frame of the grains in this time.")
        area = np.where(self.area > 0.0, self.area, np.nan)
        whole = self.frames * self.length * np.diff(self.edges)
        return Columns({"z": 0.5 * (self.edges[1:] + self.edges[:-1]), "areal_fraction": self.area / whole,
                        "velocity": self.momentum / area[:, None], "temperature": 0.5 * self.deviation / area}, UNITS,
                       {"velocity": list("xz")}, axes=("z",))


def visible_profiles(run, start=-np.inf, stop=np.inf, thickness=None, most_frames=None):
    """Profiles from the frames between two times (s), or from so many of them; layers of half a diameter from twelve
    diameters below the surface to six above if no thickness (m) is given."""
    frames = run.grains.between(start, stop)
    chosen = range(len(frames)) if most_frames is None or len(frames) <= most_frames else np.unique(
        np.linspace(0, len(frames) - 1, most_frames).astype(int))
    step = thickness or 0.5 * run.diameter
    below, above = (round(n * run.diameter / step) for n in (12.0, 6.0))
    sums = VisibleSums(step * np.arange(-below, above + 1), run.size[0], run.periodic[0])
    for k in chosen:
        sums.add(frames[int(k)], static_surface(run, frames.times[k]))
    return sums.profiles()
