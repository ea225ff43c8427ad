"""HDF5 files of a run: arrays with units and components."""
from contextlib import contextmanager

import h5py

from thalweg.columns import Columns
from thalweg.errors import RunFolderError


@contextmanager
def opened(path):
    """An HDF5 file for reading; RunFolderError where it cannot be read."""
    try:
        with h5py.File(path) as file:
            yield file
    except (OSError, RuntimeError, KeyError):   # h5py raises any of them
        raise RunFolderError(f"{path} cannot be read: a restart has replaced it at this moment, or it is damaged; try again, or "
                             "restart the run from an earlier checkpoint, which writes a new one.") from None


def columns_of(group, axes=()):
    """The arrays of an HDF5 group with their units and components."""
    return Columns({name: data[()] for name, data in group.items()}, {name: unit_of(data) for name, data in group.items()},
                   {name: components_of(data) for name, data in group.items() if "components" in data.attrs},
                   f"{group.file.filename}{group.name.rstrip('/')}", axes)


def unit_of(data):
    return text(data.attrs.get("unit", "1"))


def components_of(data):
    return text(data.attrs["components"]).split()


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)
