"""Named arrays with units."""
from thalweg.errors import MissingName
from thalweg.labelled import Labelled


class Columns(Labelled):
    """Arrays by name; `units` has the unit of each ("1": none), `components` the names along the last axis, if any.
    source: where they come from, for messages. axes: names of their leading axes; named: of the axes of each array
    (thalweg.labelled)."""

    def __init__(self, arrays, units, components=None, source="", axes=(), named=None):
        self._arrays, self.source, self.axes = dict(arrays), str(source), tuple(axes)
        self.units = {name: units.get(name, "1") for name in self._arrays}
        self.components, self.named = dict(components or {}), dict(named or {})

    def __getitem__(self, name):
        if name not in self._arrays:
            raise MissingName(name, self._arrays, self.source)
        return self._arrays[name]

    def __iter__(self):
        return iter(self._arrays)

    def __len__(self):
        return len(self._arrays)

    def __repr__(self):
        return "\n".join(f"{name} [{self.units[name]}] {array.shape}" for name, array in self.items())
