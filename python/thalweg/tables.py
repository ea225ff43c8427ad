"""Tables of comma-separated values whose headings carry units: `q_s [m^2/s]`."""
import csv
import io
import os
import re
import socket
from pathlib import Path

import numpy as np

from thalweg.columns import Columns
from thalweg.errors import RunFolderError

HEADING = re.compile(r"\s*(.*?)\s*(?:\[(.*)\])?\s*$")


def read_rows(path):
    """Rows of a table as dictionaries of text by heading; lines that begin with # are comments."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def merged_rows(path, rows, needed=("run",)):
    """Rows (dictionaries by heading) of a table of runs, with `rows` in place of those of the same runs; written back.
    None: there is no table, and rows are all there is. What is in it outlives the folders of the runs. needed: headings
    without which it is another table."""
    if path is None:
        return rows
    path = Path(path)
    kept = read_rows(path) if path.exists() else []
    missing = [heading for heading in needed if kept and heading not in kept[0]]
    if missing:
        raise RunFolderError(f"{path}: it has no column {missing[0]}, so that it is another table; give a new name.")
    merged = []
    for name in dict.fromkeys(row["run"] for row in kept + rows):
        of_this = [row for row in rows if row["run"] == name]
        merged += of_this or [row for row in kept if row["run"] == name]
    if not merged:
        raise RunFolderError(f"{path}: there is no run in this table and none to put into it; give run folders.")
    stream = io.StringIO()
    headings = dict.fromkeys(heading for row in rows + merged for heading in row)
    writer = csv.DictWriter(stream, headings, lineterminator="\n")
    writer.writeheader()
    writer.writerows(merged)
    replace_text(path, stream.getvalue())
    return merged


def replace_text(path, text):
    """Writes a file at once: whoever reads it meanwhile, or after a crash, sees the old one or the new one."""
    temporary = path.with_name(f"{path.stem}.{socket.gethostname()}.{os.getpid()}.partial")
    with open(temporary, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    temporary.replace(path)


def read_series(path):
    """Columns of series.csv by name without the unit. The last row may still be being written: it counts once its end
    of line is there."""
    if not path.exists():
        raise RunFolderError(f"{path}: there is no such file; is this the folder of a run?")
    text = path.read_text(encoding="utf-8", errors="replace")
    lines = [line for line in text[:text.rfind("\n") + 1].splitlines() if not line.startswith("#")]
    rows = list(csv.reader(lines))
    complete = [row for row in rows[1:] if len(row) == len(rows[0])]
    if not complete:
        raise RunFolderError(f"{path}: there is no measurement in it yet.")
    headings = [HEADING.match(heading).groups() for heading in rows[0]]
    try:
        values = np.array([[float(v) for v in row] for row in complete])
    except ValueError as error:
        raise RunFolderError(
            f"{path} is damaged: {error}; a restart of the run from before this row writes it again."
        ) from None
    names = [name for name, _ in headings]
    return Columns(zip(names, values.T), {name: unit or "1" for name, unit in headings}, source=path, axes=("time",))
