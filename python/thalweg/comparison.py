"""Shared by scripts that compare runs with the literature: their table outlives the folders of the runs."""
import argparse
from pathlib import Path

from thalweg.tables import merged_rows, read_rows


def files_and_figure(description, files, figure):
    """Paths and the name of the figure, from the command line FILES... [--figure FILE]. files: what they are called;
    figure: the default."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("files", nargs="+", type=Path, metavar=files)
    parser.add_argument("--figure", default=figure)
    arguments = parser.parse_args()
    return arguments.files, arguments.figure


def compared_rows(description, table, figure, rows_of):
    """Rows of the table and the name of the figure of a comparison, from the command line [RUN...] [--table FILE]
    [--figure FILE].

    rows_of: from a run's folder to its list of rows (dictionaries by heading). Rows of the runs given replace their
    earlier ones in the table; without runs it is read as it is. table, figure: the defaults.
    """
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="*", metavar="RUN")
    parser.add_argument("--table", default=table)
    parser.add_argument("--figure", default=figure)
    arguments = parser.parse_args()
    rows = [row for folder in arguments.runs for row in rows_of(folder)]
    return merged_rows(arguments.table, rows) if rows else read_rows(arguments.table), arguments.figure
