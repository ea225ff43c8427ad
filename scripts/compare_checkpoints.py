#!/usr/bin/env python3
"""Compares two checkpoints bit by bit: every dataset and every attribute.

    compare_checkpoints.py FIRST SECOND [--ignore PATH]...

FIRST and SECOND are checkpoint files (.h5) or run folders, of which the latest checkpoint is taken. Prints a line for
every dataset or attribute that differs and one at the end.
Exit code 0: the same bits; 1: different; 2: cannot be compared (a file is missing or broken).
"""
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import thalweg_python

import h5py
import numpy as np

VALUES_AT_A_TIME = 1 << 22


OF_HDF5 = (OSError, RuntimeError, KeyError, ValueError)   # what h5py raises of a damaged file


class Unreadable(Exception):
    """A file that cannot be compared, in a sentence."""


def checkpoint_at(path):
    """The checkpoint file a path stands for."""
    if path.is_dir():
        latest = path / "checkpoints" / "latest"
        if not latest.exists():
            raise Unreadable(f"{path}: the folder has no checkpoint ({latest} is missing)")
        return latest.parent / latest.read_text(encoding="utf-8", errors="replace").strip()
    return path


def opened(path):
    try:
        path.open("rb").close()   # whose errors say more
        return h5py.File(path, "r")
    except OF_HDF5 as error:
        raise Unreadable(f"{path}: {getattr(error, 'strerror', None) or 'it is no HDF5 file, or damaged'}") from None


def contents(file):
    """Everything in a file by path: datasets "group/name", attributes "group@name"."""
    found = {}

    def add(name, item):
        if isinstance(item, h5py.Dataset):
            found[name] = item
        for key in item.attrs:
            found[f"{name}@{key}"] = np.asarray(item.attrs[key])

    try:
        file.visititems(add)
        for key in file.attrs:
            found[f"@{key}"] = np.asarray(file.attrs[key])
    except OF_HDF5 as error:
        raise Unreadable(f"{file.filename}: it is damaged: {error}") from None
    return found


def parts(shape):
    """Selections that cover an array of that shape, each of few enough values to hold in memory."""
    if len(shape) == 0 or 0 in shape:
        return [()]
    rows = max(1, VALUES_AT_A_TIME // max(1, int(np.prod(shape[1:]))))
    return [slice(start, start + rows) for start in range(0, shape[0], rows)]


def bytes_of(values):
    """The values' bytes, one row of uint8 a value, so that -0 differs from 0 and a NaN equals itself."""
    values = np.ascontiguousarray(values).reshape(-1)
    return values.view(np.uint8).reshape(values.size, values.dtype.itemsize)


def difference(first, second):
    """What distinguishes two arrays, as a phrase; None if nothing does."""
    if first.shape != second.shape:
        return f"shape {first.shape} against {second.shape}"
    if first.dtype != second.dtype:
        return f"type {first.dtype} against {second.dtype}"
    if first.dtype.hasobject:   # texts of any length
        same = np.array_equal(first[()], second[()])
        return None if same else f"{first[()]!r} against {second[()]!r}"
    differing, example, largest = 0, None, 0.0
    for part in parts(first.shape):
        a, b = np.asarray(first[part]), np.asarray(second[part])
        unequal = np.flatnonzero((bytes_of(a) != bytes_of(b)).any(axis=1))
        differing += len(unequal)
        if len(unequal) == 0:
            continue
        a, b = a.reshape(-1)[unequal], b.reshape(-1)[unequal]
        if example is None:
            offset = (part.start if isinstance(part, slice) else 0) * int(np.prod(first.shape[1:]))
            where = np.unravel_index(offset + unequal[0], first.shape) if first.shape else ()
            example = f"first at {list(map(int, where))}: {a[0]!r} against {b[0]!r}"
        if np.issubdtype(first.dtype, np.number):
            with np.errstate(invalid="ignore", over="ignore"):
                gap = np.abs(a.astype(np.longdouble) - b.astype(np.longdouble))
            largest = max(largest, float(np.nanmax(gap, initial=0.0)))
    if differing == 0:
        return None
    return f"{differing} of {first.size} values differ, by at most {largest:.3g}; {example}"


def compare(first_path, second_path, ignored):
    """Prints every difference; returns how many datasets and attributes differ, and how many there are."""
    with opened(first_path) as first_file, opened(second_path) as second_file:
        first, second = contents(first_file), contents(second_file)
        names = sorted(name for name in first.keys() | second.keys() if name not in ignored)
        count = 0
        for name in names:
            if name not in first or name not in second:
                what = f"only in {first_path if name in first else second_path}"
            else:
                try:
                    what = difference(first[name], second[name])
                except OF_HDF5 as error:
                    raise Unreadable(f"{name}: {first_path} or {second_path} is damaged: {error}") from None
            if what is not None:
                count += 1
                print(f"{name}: {what}")
        return count, len(names)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("first", type=pathlib.Path)
    parser.add_argument("second", type=pathlib.Path)
    parser.add_argument("--ignore", action="append", default=[], metavar="PATH",
                        help="a dataset (group/name) or attribute (group@name) to leave out; repeatable")
    arguments = parser.parse_args()
    try:
        first, second = checkpoint_at(arguments.first), checkpoint_at(arguments.second)
        count, total = compare(first, second, set(arguments.ignore))
    except Unreadable as error:
        print(f"compare_checkpoints: {error}", file=sys.stderr)
        return 2
    if total == 0:
        print(f"compare_checkpoints: {first} and {second} are empty.", file=sys.stderr)
        return 2
    if count:
        print(f"different: {count} of {total} datasets and attributes of {first} and {second}")
        return 1
    print(f"the same bits: {total} datasets and attributes of {first} and {second}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
