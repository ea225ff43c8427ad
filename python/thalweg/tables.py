"""Tables of comma-separated values whose headings carry units: `q_s [m^2/s]`. Other programs may have saved them, with
lines that end as on Windows and a byte-order mark."""
import csv
import io
import itertools
import os
import re
import shutil
import socket
from pathlib import Path
from typing import NamedTuple

import numpy as np

from thalweg.columns import Columns
from thalweg.errors import RunFolderError

ENCODING = "utf-8-sig"   # of what is read: UTF-8, with a byte-order mark or without
HEADING = re.compile(r"\s*(.*?)\s*(?:\[(.*)\])?\s*$")


class Table(NamedTuple):
    """Headings, rows as dictionaries of text by heading, and comments, which are lines that begin with #: lists of
    those above the headings, above each row, and below the last."""
    headings: list
    rows: list
    comments: list


def records_of(lines):
    """Comments, as text, and headings and rows, as lists of text, of a table."""
    for line in lines:
        if line.startswith("#"):
            yield line.rstrip("\r\n")
        elif line.strip():
            yield next(csv.reader(itertools.chain([line], lines)))   # more lines where a value has them


def read_table(path):
    """The table in a file; RunFolderError where it cannot be read."""
    headings, rows, comments = [], [], [[]]
    try:
        with open(path, newline="", encoding=ENCODING) as lines:
            records = list(records_of(lines))
    except UnicodeDecodeError:
        raise RunFolderError(f"{path} is not UTF-8; save it as UTF-8.") from None
    for record in records:
        if isinstance(record, str):
            comments[-1].append(record)
            continue
        comments.append([])
        if headings and len(record) > len(headings):
            raise RunFolderError(f"{path}: the row {','.join(record)} has more values than there are headings.")
        if headings:
            rows.append(dict(itertools.zip_longest(headings, record)))
        headings = headings or record
    return Table(headings, rows, comments if headings else comments + [[]])


def read_rows(path):
    """Rows of a table as dictionaries of text by heading; lines that begin with # are comments."""
    return read_table(path).rows


def merged_lines(table, rows):
    """Rows of a table and the comments between them, with `rows` in place of those of the same runs: a comment stays
    above the row that it stood above, or the one in its place, and one below all rows stays above those that are
    new."""
    _, *above, below = table.comments
    known = list(dict.fromkeys(row["run"] for row in table.rows))
    lines = [] if known else list(below)
    for name in dict.fromkeys(known + [row["run"] for row in rows]):
        old = [(comments, row) for comments, row in zip(above, table.rows) if row["run"] == name]
        new = [row for row in rows if row["run"] == name] or [row for _, row in old]
        for comments, row in itertools.zip_longest((comments for comments, _ in old), new):
            lines += [*(comments or ()), *([row] if row else [])]
        lines += below if known and name == known[-1] else []
    return lines


def merged_rows(path, rows, needed=("run",)):
    """Rows (dictionaries by heading) of a table of runs, with `rows` in place of those of the same runs; written back,
    with the comments that are in the file. None: there is no table, and rows are all there is. What is in it outlives
    the folders of the runs. needed: headings without which it is another table."""
    if path is None:
        return rows
    path = Path(path)
    table = read_table(path) if path.exists() else Table([], [], [[], []])
    missing = [heading for heading in needed if table.headings and heading not in table.headings]
    if missing:
        raise RunFolderError(f"{path}: it has no column {missing[0]}, so that it is another table; give a new name.")
    lines = merged_lines(table, rows)
    merged = [line for line in lines if isinstance(line, dict)]
    if not merged:
        raise RunFolderError(f"{path}: there is no run in this table and none to put into it; give run folders.")
    headings = list(dict.fromkeys(heading for row in rows + merged for heading in row))
    records = [[line.get(heading) for heading in headings] if isinstance(line, dict) else line for line in lines]
    replace_text(path, "".join(line_of(record) for record in [*table.comments[0], headings, *records]))
    return merged


def line_of(record):
    """A comment, or values, as a line of a table."""
    if isinstance(record, str):
        return f"{record}\n"
    stream, like_comment = io.StringIO(), str(record[0]).startswith("#")
    quoting = csv.QUOTE_ALL if like_comment else csv.QUOTE_MINIMAL
    csv.writer(stream, quoting=quoting, lineterminator="\n").writerow(record)
    return stream.getvalue()


def replace_text(path, text):
    """Writes a file at once: whoever reads it meanwhile, or after a crash, sees the old one or the new one. A link
    stays one, and the file that it leads to keeps its permissions."""
    path = path.resolve()
    temporary = path.with_name(f"{path.stem}.{socket.gethostname()}.{os.getpid()}.partial")
    try:
        with open(temporary, "w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        if path.exists():
            shutil.copymode(path, temporary)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)   # on a full disk


def read_series(path):
    """Columns of series.csv by name without the unit. The last row may still be being written: it counts once its end
    of line is there."""
    if not path.exists():
        raise RunFolderError(f"{path}: there is no such file; is this the folder of a run?")
    text = path.read_text(encoding=ENCODING, errors="replace")   # with any end of line as \n
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
