"""What a run begins from: its case, the values it sets, and the files that those refer to. Runs of a sweep that began from
different things do not belong in one table."""
import functools
import hashlib
import json

import yaml

from thalweg.errors import RunFolderError
from thalweg.run import CaseLoader

FILE_KEYS = {"file", "stl", "from", "run"}   # of a case: bed files, surfaces, run folders and checkpoints


class SweepError(RunFolderError):
    """One sentence about something in a sweep file that the user can put right."""


def inputs_of(case, settings):
    """case: path of the case file; settings: values by key. As JSON, equal if the runs begin from the same."""
    content = content_of(case, state_of(case))
    files = {name: digest_of_file(case.parent / name) for name in sorted(named_files([content, settings]))
             if (case.parent / name).exists()}
    return {"case": digest_of(content), "settings": settings} | ({"files": files} if files else {})


def named_files(content, key=None):
    """All texts that stand at a key for a file or folder, or in a list of them. Keys of settings are paths."""
    if isinstance(content, dict):
        return {name for key, value in content.items() for name in named_files(value, str(key).rpartition(".")[2])}
    if isinstance(content, list):
        return {name for value in content for name in named_files(value, key)}
    return {content} if key in FILE_KEYS and isinstance(content, str) and content else set()


def state_of(path):
    """What changes when a file does."""
    seen = path.stat()
    return seen.st_size, seen.st_mtime_ns


@functools.lru_cache(maxsize=None)
def content_of(case, _state):
    return yaml.load(case.read_text(), CaseLoader)


def digest_of(content):
    return hashlib.sha256(json.dumps(content, sort_keys=True, default=str).encode()).hexdigest()


def digest_of_file(path):
    """Of the bytes of a file; of a run folder: of the names and sizes of its checkpoints."""
    if path.is_dir():
        return digest_of(sorted((file.name, file.stat().st_size) for file in path.glob("checkpoints/*")))
    return digest_of_bytes(path, state_of(path))


@functools.lru_cache(maxsize=None)
def digest_of_bytes(path, _state):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while part := file.read(1 << 24):
            digest.update(part)
    return digest.hexdigest()
