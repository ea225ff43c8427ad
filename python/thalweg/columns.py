"""Named arrays with units."""
from collections.abc import Mapping


class Columns(Mapping):
    """Arrays by name; `units` has the unit of each ("1": none), `components` the names along the last axis, if any."""

    def __init__(self, arrays, units, components=None):
        self._arrays = dict(arrays)
        self.units = {name: units.get(name, "1") for name in self._arrays}
        self.components = dict(components or {})

    def __getitem__(self, name):
        return self._arrays[name]

    def __iter__(self):
        return iter(self._arrays)

    def __len__(self):
        return len(self._arrays)

    def __repr__(self):
        return "\n".join(f"{name} [{self.units[name]}] {array.shape}" for name, array in self.items())
