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
        raise RunFolderError(
            f"{path} cannot be read: a restart has replaced it at this moment, or it is damaged; try again, or "
            "restart the run from an earlier checkpoint, which writes a new one."
        ) from None


NO_VARIABLE = "This is a netCDF dimension but not a netCDF variable."   # NAME of a data set that only names a dimension


def arrays_in(group):
    """The arrays of an HDF5 group with their names."""
    return {name: data for name, data in group.items()
            if isinstance(data, h5py.Dataset) and not text(data.attrs.get("NAME", "")).startswith(NO_VARIABLE)}


def columns_of(group):
    """The arrays of an HDF5 group with their units, components and dimensions."""
    arrays = arrays_in(group)
    return Columns(
        {name: data[()] for name, data in arrays.items()}, {name: unit_of(data) for name, data in arrays.items()},
        {name: components_of(data) for name, data in arrays.items() if "components" in data.attrs},
        f"{group.file.filename}{group.name.rstrip('/')}", named=dimensions_in(arrays),
    )


def dimensions_in(arrays):
    """Names of the dimensions of arrays, by their dimension scales; older files have none."""
    named = {}
    for name, data in arrays.items():
        if text(data.attrs.get("CLASS", "")) == "DIMENSION_SCALE":
            named[name] = (name,)
        elif data.ndim and all(len(scales) for scales in data.dims):
            named[name] = tuple(scales[0].name.rpartition("/")[2] for scales in data.dims)
    return named


def unit_of(data):
    """`units`; in older files `unit`."""
    return text(data.attrs.get("units", data.attrs.get("unit", "1")))


def components_of(data):
    return text(data.attrs["components"]).split()


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)
