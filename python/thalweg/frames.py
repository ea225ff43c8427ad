"""Frames of grains and fluid, read when they are asked for."""
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from thalweg.columns import Columns
from thalweg.errors import MissingField
from thalweg.vtk_files import read_image, read_index, read_points, read_triangles

GRAIN_UNITS = {"id": "1", "clump": "1", "radius": "m", "speed": "m/s", "position": "m", "velocity": "m/s",
               "angular_velocity": "rad/s", "contact_force": "N", "fluid_force": "N", "contact_stress": "Pa",
               "fluid_stress": "Pa", "population": "1", "held": "1", "density": "kg/m^3", "orientation": "1"}
FLUID_UNITS = {"velocity": "m/s", "pressure": "Pa", "density": "kg/m^3", "grain_id": "1", "shear_rate": "1/s",
               "eddy_viscosity": "m^2/s", "vorticity": "1/s", "q_criterion": "1/s^2"}

AXES = {3: list("xyz"), 9: [row + column for row in "xyz" for column in "xyz"], 6: ["xx", "yy", "zz", "xy", "xz", "yz"],
        4: list("wxyz")}   # names of components by their number; of four: a quaternion


class GrainFrame:
    """The grains at one time: `frame.position` [grain, axis], `frame.velocity`, `frame.contact_stress` [grain, row,
    column] and so on; `arrays` has all of them with their units. thickness: of disks, m; None: they are spheres."""

    def __init__(self, time, path, thickness=None):
        self.time, self.path, self.thickness = time, path, thickness   # s

    @cached_property
    def arrays(self):
        position, arrays = read_points(self.path)
        arrays = {name: values.reshape(-1, 3, 3) if name.endswith("_stress") else values
                  for name, values in arrays.items()}
        return Columns({"position": position, **arrays}, GRAIN_UNITS, source=self.path, axes=("id",))

    def _tensors_flat(self):
        """The same with the nine components of a tensor along one axis, all with their names."""
        arrays = {
            name: values.reshape(len(values), -1) if values.ndim > 1 else values for name, values in self.arrays.items()
        }
        components = {
            name: AXES[values.shape[1]]
            for name, values in arrays.items()
            if values.ndim > 1 and values.shape[1] in AXES
        }
        return Columns(arrays, GRAIN_UNITS, components, self.path, ("id",))

    def to_pandas(self):
        """A pandas.DataFrame with a row for each grain, by its id."""
        return self._tensors_flat().to_pandas()

    def to_xarray(self):
        """An xarray.Dataset with the dimensions id, axis and tensor, and the attribute `time` (s)."""
        return self._tensors_flat().to_xarray().assign_attrs(time=self.time)

    def __getattr__(self, name):
        if name in GRAIN_UNITS:
            if name not in self.arrays:
                raise MissingField(
                    f"{self.path}: the frame has no {name}, which the fields of the output in the case leave out."
                )
            return self.arrays[name]
        raise AttributeError(name)

    def __len__(self):
        return len(self.position)

    @property
    def diameter(self):
        """m"""
        return 2.0 * self.radius

    @property
    def volume(self):
        """m^3: of each sphere or disk; members of a clump both have what they share."""
        return 4.0 / 3.0 * np.pi * self.radius**3 if self.thickness is None else np.pi * self.radius**2 * self.thickness


class FluidFrame:
    """The fluid at one time: `arrays` as [z, y, x] and a component, `corner` and `spacing` in m."""

    def __init__(self, time, path):
        self.time, self.path = time, path   # s

    @cached_property
    def _image(self):
        return read_image(self.path)

    @property
    def corner(self):
        return self._image[0]

    @property
    def spacing(self):
        return self._image[1]

    @property
    def arrays(self):
        return Columns(self._image[2], FLUID_UNITS, source=self.path)

    def _with_places(self):
        places = {axis: self.centres(axis) for axis in "zyx"}
        components = {name: AXES[values.shape[3]] for name, values in self._image[2].items() if values.ndim > 3}
        columns = Columns(
            {**self._image[2], **places}, {**FLUID_UNITS, **dict.fromkeys("xyz", "m")}, components, self.path, "zyx"
        )
        columns.row_axes = 3
        return columns

    def to_pandas(self):
        """A pandas.DataFrame with a row for each cell, by z, y and x (m)."""
        return self._with_places().to_pandas()

    def to_xarray(self):
        """An xarray.Dataset with the dimensions z, y, x (m, of the middles of the cells) and axis, and the attribute
        `time` (s)."""
        return self._with_places().to_xarray().assign_attrs(time=self.time)

    def centres(self, axis):
        """Middle of the cells along x, y or z, by letter or number ("x" or 0), in m."""
        axis = "xyz".index(axis) if isinstance(axis, str) else axis
        count = next(iter(self._image[2].values())).shape[2 - axis]
        return self.corner[axis] + (np.arange(count) + 0.5) * self.spacing[axis]


class SolidFrame:
    """The surfaces of the solids at one time: `points` [point, axis] in m, `triangles` [triangle, corner] as numbers of
    points, and `solid`, the number of the solid of each triangle."""

    def __init__(self, time, path):
        self.time, self.path = time, path   # s

    @cached_property
    def _surface(self):
        return read_triangles(self.path)

    @property
    def points(self):
        return self._surface[0]

    @property
    def triangles(self):
        return self._surface[1]

    @property
    def solid(self):
        return self._surface[2]["solid"]


class Frames(Sequence):
    """The frames of a .pvd index in their order; `times` in s. A slice is a series as well. Each frame is made, and
    reads its file, anew whenever it is asked for, so that a loop over many holds one."""

    def __init__(self, entries, kind):
        self._entries, self._kind = entries, kind
        self.times = np.array([time for time, _ in entries])

    @classmethod
    def of_index(cls, path, kind):
        return cls(read_index(path), kind)

    def __len__(self):
        return len(self._entries)

    def __getitem__(self, which):
        if isinstance(which, slice):
            return Frames(self._entries[which], self._kind)
        if not self._entries:
            raise IndexError("There are no frames: the case asks for none (output), or none has been written.")
        return self._kind(*self._entries[which])

    def nearest(self, time):
        """The frame nearest to a time in s; the last one if it is None; None if there is none."""
        if not self._entries:
            return None
        return self[-1 if time is None else int(np.argmin(np.abs(self.times - time)))]

    def chosen(self, places):
        """The frames at these places, as a series."""
        return Frames([self._entries[k] for k in places], self._kind)

    def between(self, start=-np.inf, stop=np.inf):
        """The frames of start <= time <= stop (s), to a billionth of a second."""
        return Frames([e for e in self._entries if start - 1e-9 <= e[0] <= stop + 1e-9], self._kind)


def trajectory(frames, grain=0):
    """Times (s), positions (m) and velocities (m/s) of one grain, by its place in the frames: that of its id, unless
    grains were lost."""
    states = [(frame.time, frame.position[grain], frame.velocity[grain]) for frame in frames]
    times, positions, velocities = (np.array(column) for column in zip(*states))
    return times, positions, velocities
