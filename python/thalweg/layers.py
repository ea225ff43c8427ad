"""Layer means of grains, from frames, with the exact volume of every sphere in every layer.

The quantities are those of `analysis.grain_profiles`, which gathers them in the run and should be preferred for means
over time; this is for frames that are there already, and for heights measured from a surface that moves.
"""
import numpy as np

from thalweg.columns import Columns
from thalweg.errors import RunFolderError
from thalweg.obstacles import floating, has_members, obstacles, solids_in_layers, union_in_layers

UNITS = {"z": "m", "solid_fraction": "1", "velocity": "m/s", "flux": "m/s", "granular_temperature": "m^2/s^2",
         "contact_stress": "Pa", "fluid_stress": "Pa", "rotation_stress": "Pa"}


def volume_below(height, radius):
    """Volume (m^3) of spheres below a height (m) over their centres: pi (h + R)^2 (2 R - h)/3."""
    h = np.clip(height, -radius, radius)
    return np.pi / 3.0 * (h + radius)**2 * (2.0 * radius - h)


def disk_below(height, radius):
    """Area (m^2) of disks below a height (m) over their centres: R^2 (pi/2 + asin(h/R)) + h sqrt(R^2 - h^2)."""
    h = np.clip(height, -radius, radius)
    return radius**2 * (0.5 * np.pi + np.arcsin(h / radius)) + h * np.sqrt(radius**2 - h**2)


def parts_in_layers(edges, height, radius, below=volume_below):
    """What lies between one edge (m) and the next of every body, as [layer, body]. `below`: of volumes or of areas."""
    part = below(np.asarray(edges)[:, None] - np.asarray(height)[None, :], np.asarray(radius)[None, :])
    return np.diff(part, axis=0)


def layer_edges(bottom, top, thickness):
    """Edges of a whole number of layers between two heights (m), about as thick as wanted."""
    return np.linspace(bottom, top, max(1, round((top - bottom) / thickness)) + 1)


class LayerSums:
    """Sums over frames of what the grains contribute to layers; profiles() makes means of them. area: of a layer, m^2;
    lengths in m; height: of a period, where z is periodic; thickness: of disks. With a run, its obstacles are no
    grains, and a layer is the room that they leave; where there is nothing else, they are grains, and overlaps count
    once. bed_only: grains that float over the bed of a run do not count."""

    def __init__(self, edges, area, height=None, thickness=None, run=None, bed_only=False):
        self.bed_only = bed_only
        self.run, self.obstacle_ids, self.union, self.taken = run, None, None, 0.0
        self.solids = solids_in_layers(run, edges) if run else 0.0
        self.edges, self.layer_volumes = np.asarray(edges, float), area * np.diff(edges)
        self.height, self.thickness = height, thickness
        layers = len(edges) - 1
        self.frames, self.volume, self.flux = 0, np.zeros(layers), np.zeros((layers, 3))
        self.mass, self.momentum, self.square = np.zeros(layers), np.zeros((layers, 3)), np.zeros(layers)
        self.stresses, self.with_stress = {}, {}   # sums, and frames that have them

    def parts(self, z, radius):
        """Volumes [layer, grain], with those of images beyond a periodic face."""
        images = (0.0,) if self.height is None else (-self.height, 0.0, self.height)
        below, width = (volume_below, 1.0) if self.thickness is None else (disk_below, self.thickness)
        return width * sum(parts_in_layers(self.edges, z + shift, radius, below) for shift in images)

    def add(self, frame):
        if has_members(self.run, frame):
            raise RunFolderError(
                "frames have the members of clumps, whose volumes overlap; analysis.grain_profiles in the case counts "
                "clumps, in profiles.h5."
            )
        part = self.parts(frame.position[:, 2], frame.radius)
        self.frames += 1
        self.taken = self.taken + self.solids
        stands = self.obstacles_in(frame)
        if len(stands) and stands.all():
            part *= (self.union / np.maximum(part.sum(axis=1), 1e-300))[:, None]
        elif stands.any():
            self.taken = self.taken + self.union
            part[:, stands] = 0.0
        if self.bed_only:
            part[:, floating(self.run, frame)] = 0.0
        self.volume += part.sum(axis=1)
        self.flux += part @ frame.velocity
        mass = part * frame.arrays.get("density", 1.0)   # frames whose fields leave it out weigh by volume
        self.mass += mass.sum(axis=1)
        self.momentum += mass @ frame.velocity
        self.square += mass @ np.sum(frame.velocity**2, axis=1)
        for name in ("contact_stress", "fluid_stress"):
            if name in frame.arrays and (name == "contact_stress" or frame.time > 0.0):   # the fluid's at 0: not yet known
                sums = self.stresses.setdefault(name, np.zeros((len(part), 9)))
                sums += part @ frame.arrays[name].reshape(-1, 9)
                self.with_stress[name] = self.with_stress.get(name, 0) + 1

    def obstacles_in(self, frame):
        """Which grains of a frame are obstacles; they stand still, so that the first frame tells."""
        if self.obstacle_ids is None:
            stands = obstacles(self.run, frame) if self.run else np.zeros(len(frame), bool)
            self.obstacle_ids = frame.id[stands]
            self.union = union_in_layers(self.run, self.edges, frame.position[stands], frame.radius[stands])
        return np.isin(frame.id, self.obstacle_ids)

    def profiles(self):
        """Columns over z, the middle of the layers: solid fraction, velocity by mass (NaN where no grain was), flux by
        volume, granular temperature (sum m |v|^2/sum m - |U|^2)/3 over grains and frames, stresses weighted with the
        solid fraction, and of the fluid's on grains the rotation stress sigma_xz - sigma_zx (Zhang et al. 2022, sec.
        2.4)."""
        if self.frames == 0:
            raise RunFolderError("there is no frame of the grains in this time.")
        whole = np.maximum(self.frames * self.layer_volumes - self.taken, 1e-9 * self.frames * self.layer_volumes)
        mass = np.where(self.volume > 1e-9 * whole, self.mass, np.nan)
        velocity = self.momentum / mass[:, None]
        found = {"z": 0.5 * (self.edges[1:] + self.edges[:-1]), "solid_fraction": self.volume / whole,
                 "velocity": velocity, "flux": self.flux / whole[:, None],
                 "granular_temperature": (self.square / mass - np.sum(velocity**2, axis=1)) / 3.0}
        for name, sums in self.stresses.items():
            found[name] = (sums / whole[:, None]).reshape(-1, 3, 3) * (self.frames / self.with_stress[name])
        if "fluid_stress" in found:
            found["rotation_stress"] = found["fluid_stress"][:, 0, 2] - found["fluid_stress"][:, 2, 0]
        return Columns(found, UNITS, {"velocity": list("xyz"), "flux": list("xyz")}, axes=("z",))


def layer_profiles(run, start=-np.inf, stop=np.inf, thickness=None, bed_only=False):
    """Profiles over the height of the box from the frames between two times (s); layers of half a diameter if no
    thickness (m) is given. bed_only: without grains that float over the bed."""
    edges = layer_edges(0.0, run.size[2], thickness or 0.5 * run.diameter)
    width = run.disk_thickness
    sums = LayerSums(edges, run.size[0] * (width or run.size[1]), run.size[2] if run.periodic[2] else None, width, run,
                     bed_only)
    for frame in run.grains.between(start, stop):
        sums.add(frame)
    return sums.profiles()
