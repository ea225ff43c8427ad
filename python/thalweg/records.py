"""What observers have recorded (`tracks/`, `probes/`, `reach/`, `entrainment/`): parts of a run as HDF5 files, joined along
time."""
import re
from collections.abc import Mapping

import h5py
import numpy as np

from thalweg.columns import Columns
from thalweg.errors import MissingName
from thalweg.hdf5 import arrays_in, columns_of, components_of, dimensions_in, opened, unit_of
from thalweg.labelled import Labelled, package


def parts_of(folder, name):
    """Paths of the parts in their order; before them the single file that older versions wrote. None where nothing is
    recorded."""
    paths = sorted((folder / name).glob("part_*.h5"), key=lambda path: int(re.search(r"\d+", path.name)[0]))
    single = folder / f"{name}.h5"
    return [single] * single.exists() + paths or None


class Records(Labelled):
    """Arrays by name as Columns has them, those that grow joined along time. An array is read when it is asked for, and
    no other with it."""

    row_axes = 2

    def __init__(self, paths):
        self._paths, self._read = paths, {}
        self.units, self.components, self._shapes, self._rows = {}, {}, {}, set()
        with opened(paths[-1]) as file:   # as in every part
            arrays = arrays_in(file)
            self.named = dimensions_in(arrays)
            for name, data in arrays.items():
                self.units[name], self._shapes[name] = unit_of(data), data.shape
                # What is the same throughout are whole numbers, and coordinates other than time.
                if data.dtype.kind == "f" and self.named.get(name, ("time",))[0] == "time":
                    self._rows.add(name)
                if "components" in data.attrs:
                    self.components[name] = components_of(data)
        times = [self._array(path, "time") for path in paths]
        # A part begins where the run has gone on, and outdates what an earlier one has from there on.
        self._kept, begin = [], np.inf
        for time in reversed(times):
            self._kept.insert(0, int(np.searchsorted(time, begin)))
            begin = min(begin, time[0]) if len(time) else begin
        self._read["time"] = np.concatenate([time[:kept] for time, kept in zip(times, self._kept)])

    def __getitem__(self, name):
        if name not in self._read:
            if name not in self.units:
                raise MissingName(name, self.units, str(self._paths[-1].parent))
            self._read[name] = self._joined(name) if name in self._rows else self._array(self._paths[-1], name)
        return self._read[name]

    @staticmethod
    def _array(path, name, rows=()):
        with opened(path) as file:
            return file[name][rows]

    def _joined(self, name):
        joined = np.empty((sum(self._kept), *self._shapes[name][1:]))
        start = 0
        for path, kept in zip(self._paths, self._kept):
            if kept:
                joined[start:start + kept] = self._array(path, name, slice(kept))
            start += kept
        return joined

    def __iter__(self):
        return iter(self.units)

    def __len__(self):
        return len(self.units)

    def __repr__(self):
        shapes = {
            name: (sum(self._kept), *shape[1:]) if name in self._rows else shape for name, shape in self._shapes.items()
        }
        return "\n".join(f"{name} [{self.units[name]}] {shapes[name]}" for name in self)


class Probes(Records):
    """With `position` (m) [point, axis], the centres of the cells; spacing: of the cells, m."""

    def __init__(self, paths, spacing):
        super().__init__(paths)
        cells = np.column_stack([self[f"cell_{axis}"] for axis in "xyz"])
        self._read["position"] = (cells + 0.5) * spacing
        self.units["position"], self._shapes["position"] = "m", cells.shape
        self.components["position"] = list("xyz")
        if "cell_x" in self.named:
            self.named["position"] = (*self.named["cell_x"], "axis")


class Event(Columns):
    """An event: its arrays as Columns, and `attributes`, its single numbers (`time` in s)."""

    def __init__(self, group):
        columns = columns_of(group)
        super().__init__(columns, columns.units, columns.components, columns.source, named=columns.named)
        self.attributes = {
            name: float(value) for name, value in group.attrs.items() if not name.endswith(("_units", "_unit"))
        }


def next_name(name):
    """The name with the next number at its end: event_000009, event_000010."""
    digits = re.search(r"\d*$", name)[0]
    return f"{name[:len(name) - len(digits)]}{int(digits or 0) + 1:0{len(digits)}d}"


class Events(Mapping):
    """Events by name, in order of time; each is read when it is asked for. One of a name that an earlier one has, from
    a part of the run that was watched otherwise, gets the next that is free."""

    def __init__(self, paths):
        self._folder, found = paths[-1].parent, []
        for path in paths:
            with opened(path) as file:
                part = [
                    (float(group.attrs["time"]), path, name)
                    for name, group in file.items()
                    if isinstance(group, h5py.Group)
                ]
            begin = min((event[0] for event in part), default=np.inf)
            found = [event for event in found if event[0] < begin] + part
        self._places = {}
        for _, path, own in sorted(found, key=lambda event: event[0]):
            name = own
            while name in self._places:
                name = next_name(name)
            self._places[name] = path, own

    def __getitem__(self, name):
        if name not in self._places:
            raise MissingName(name, self._places, str(self._folder))
        path, own = self._places[name]
        with opened(path) as file:
            return Event(file[own])

    def __iter__(self):
        return iter(self._places)

    def __len__(self):
        return len(self._places)

    def to_pandas(self):
        """A pandas.DataFrame with a row for each event, by name, and its single numbers as columns; those of the arrays
        of one event come from its own to_pandas()."""
        return package("pandas").DataFrame({name: event.attributes for name, event in self.items()}).T
