"""What a run begins from: its case, the values it sets, and the files that those refer to. Runs of a sweep that began
from different things do not belong in one table."""
import functools
import hashlib
import json
import re

import h5py
import yaml

from thalweg.case_file import read_case
from thalweg.errors import RunFolderError

# Of a case, the last word, or two, of a key that names a bed file, a surface, a run folder or a checkpoint.
FILE_KEYS = {"file", "stl", "from", "run", "from.grains", "from.fluid"}


class SweepError(RunFolderError):
    """One sentence about something in a sweep file that the user can put right."""


def inputs_of(case, settings):
    """case: path of the case file; settings: values by key. As JSON, equal if the runs begin from the same."""
    content = content_of(case, state_of(case))
    files = {name: digest_of_file(case.parent / name) for name in sorted(named_files([content, settings]))
             if (case.parent / name).exists()}
    return {"case": digest_of(content), "settings": settings} | ({"files": files} if files else {})


def named_files(content, key=""):
    """All texts that stand at a key for a file or folder, or in a list of them. key: with the keys around it, joined by
    dots, as those of settings are."""
    if isinstance(content, dict):
        return {name for inner, value in content.items() for name in named_files(value, f"{key}.{inner}")}
    if isinstance(content, list):
        return {name for value in content for name in named_files(value, key)}
    words = key.split(".")
    is_file = words[-1] in FILE_KEYS or ".".join(words[-2:]) in FILE_KEYS
    name = getattr(content, "word", content)
    return {name} if is_file and isinstance(name, str) and name else set()


def state_of(path):
    """What changes when a file does."""
    seen = path.stat()
    return seen.st_size, seen.st_mtime_ns


@functools.lru_cache(maxsize=None)
def content_of(case, _state):
    try:
        content = read_case(case)
    except UnicodeDecodeError:
        raise SweepError(f"{case} is not UTF-8; save it as UTF-8.") from None
    except yaml.YAMLError as error:
        raise SweepError(f"{case} is not YAML: {' '.join(str(error).split())}.") from None
    if not isinstance(content, dict):
        raise SweepError(f"{case} is not a case: it has no keys.")
    return content


def digest_of(content):
    return hashlib.sha256(json.dumps(content, sort_keys=True, default=str).encode()).hexdigest()


def digest_of_file(path):
    """Of the bytes of a file; of a run folder: of the checkpoint that a run would begin from."""
    if not path.is_dir():
        return digest_of_bytes(path, state_of(path))
    checkpoint = latest_checkpoint_in(path)
    return digest_of([checkpoint.name, digest_of_checkpoint(checkpoint, state_of(checkpoint))] if checkpoint else [])


def latest_checkpoint_in(run):
    """As the program chooses it (io/folder/run_folder.hpp): the one that `latest` names, else that of the last step;
    None: there is none."""
    steps = {
        int(match[1]): file
        for file in run.glob("checkpoints/step_*.h5")
        if (match := re.fullmatch(r"step_(\d+)\.h5", file.name))
    }
    try:
        named = run / "checkpoints" / (run / "checkpoints/latest").read_text(encoding="utf-8").strip()
    except OSError:
        named = None
    return named if named in steps.values() else steps.get(max(steps, default=None))


@functools.lru_cache(maxsize=None)
def digest_of_checkpoint(path, state):
    """By the checksums that it holds of its data, which need not be read: it may be as large as the memory of many
    nodes."""
    seen = []

    def look(name, item):
        if isinstance(item, h5py.Dataset):
            seen.append((name, item.shape, str(item.dtype), int(item.attrs["checksum"])))
        elif name == "run":
            seen.append((name, sorted((key, str(value)) for key, value in item.attrs.items())))

    try:
        with h5py.File(path) as file:
            file.visititems(look)
    except (OSError, KeyError):   # no HDF5 file, or without checksums
        return digest_of_bytes(path, state)
    return digest_of(seen)


@functools.lru_cache(maxsize=None)
def digest_of_bytes(path, _state):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while part := file.read(1 << 24):
            digest.update(part)
    return digest.hexdigest()
