"""Adds the observer of centre_of_mass.hpp to a copy of analysis/: extend.py REPOSITORY COPY.

The edits are those of somebody who adds one, in the files that CONTRIBUTING.md names. new_observer_test.cpp compares
its numbers with those known beforehand.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import extended_copy

HEADER = "observers/centre_of_mass.hpp"

# File of analysis/, its text, the text in place of that.
MEASUREMENT = [
    ("observers/observer_list.hpp", '#include "analysis/observers/bed_surface.hpp"\n',
     f'#include "analysis/observers/bed_surface.hpp"\n#include "analysis/{HEADER}"\n'),
    ("observers/observer_list.hpp", "  OptionalKeys<", "  OptionalKeys<CentreOfMassKeys, "),
]


if __name__ == "__main__":
    root = pathlib.Path(sys.argv[1])
    extended_copy.write(root, pathlib.Path(sys.argv[2]), "analysis", MEASUREMENT,
                        {HEADER: (root / "tests/analysis/new_observer/centre_of_mass.hpp").read_text()})
