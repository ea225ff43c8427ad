"""Arrays with names, units and axes as pandas tables and xarray data sets; both packages are needed only for that."""
import importlib
from collections import Counter
from collections.abc import Mapping

import numpy as np

from thalweg.errors import RunFolderError

COMPONENTS = {
    2: "pair", 3: "axis", 4: "quaternion", 6: "symmetric", 9: "tensor",
}  # names of axes by the number of components


def package(name):
    """pandas or xarray."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError:
        raise RunFolderError(
            f"this needs the Python package {name}; install it (pip install {name}, or python3-{name} on Debian)."
        ) from None


class Labelled(Mapping):
    """Arrays by name with `units` and `components`. What their dimensions are is in `named`, from the file; where a
    file does not say, the first are `axes`, the others are named after the array. An array that has the name of an axis
    holds the places along it (`z`, `time`, `id`)."""

    axes, named, units, components = (), {}, {}, {}
    row_axes = 1   # how many axes are rows of a table

    def coordinate(self, axis):
        """Name of the array with the places along an axis; None where there is none."""
        return axis if axis in self and self.dimensions(axis) == (axis,) else None

    def dimensions(self, name):
        """Names of the axes of an array."""
        if name in self.named:
            return self.named[name]
        ends = self[name].ndim - (name in self.components)
        if name in self.axes and ends == 1:
            return (name,)
        found = (*self.axes, *(f"{name}_{place}" for place in range(len(self.axes), ends)))[:ends]
        if name in self.components:
            found += (COMPONENTS.get(len(self.components[name]), f"{name}_component"),)
        return found

    def rows(self):
        """The axes whose places are the rows of a table: those of most arrays."""
        if self.axes:
            return tuple(self.axes[:self.row_axes])
        found = Counter()
        for name in self:
            dimensions = self.dimensions(name)
            places = dimensions[:len(dimensions) - (name in self.components)]
            if len(places) >= self.row_axes and name not in places:
                found[places[:self.row_axes]] += 1
        return found.most_common(1)[0][0] if found else ()

    def to_xarray(self):
        """An xarray.Dataset with named dimensions, coordinates where there are any, and the attribute `units` of each
        variable."""
        xarray = package("xarray")
        variables, coordinates = {}, {}
        for name in self:
            dimensions = self.dimensions(name)
            held = (dimensions, self[name], {"units": self.units.get(name, "1")})
            own = len(dimensions) == 1 and name == self.coordinate(dimensions[0])
            (coordinates if own else variables)[dimensions[0] if own else name] = held
            if name in self.components and dimensions[-1] not in coordinates:
                coordinates[dimensions[-1]] = list(self.components[name])
        return xarray.Dataset(variables, coordinates)

    def to_pandas(self):
        """A pandas.DataFrame with a row for each place along the axis of most arrays (of tracks and probes for each
        time and grain or point) and a column for each component; arrays with other axes are left to to_xarray().
        `attrs["units"]` has the units of the columns."""
        pandas = package("pandas")
        rows = self.rows()
        columns, units, shape = {}, {}, None
        for name in self:
            dimensions = self.dimensions(name)
            extra = len(dimensions) - len(rows) - (name in self.components)
            if dimensions[:len(rows)] != rows or extra or (len(rows) == 1 and name == self.coordinate(rows[0])):
                continue
            shape = self[name].shape[:len(rows)]
            for column, values in self.flat(name):
                columns[column], units[column] = np.reshape(values, -1), self.units.get(name, "1")
        frame = pandas.DataFrame(columns, self.index(rows, shape))
        frame.attrs["units"] = units
        return frame

    def index(self, rows, shape):
        """Of a table: the places along its axes."""
        pandas = package("pandas")
        names = [self.coordinate(axis) for axis in rows]
        places = [self[name] if name else np.arange(length) for name, length in zip(names, shape or [0] * len(rows))]
        labels = [name or axis for name, axis in zip(names, rows)]
        return (
            pandas.Index(places[0], name=labels[0])
            if len(rows) == 1
            else pandas.MultiIndex.from_product(places, names=labels)
        )

    def flat(self, name):
        """Names and values of the columns that an array makes: velocity_x and so on."""
        if name not in self.components:
            return [(name, self[name])]
        return [(f"{name}_{part}", self[name][..., n]) for n, part in enumerate(self.components[name])]
