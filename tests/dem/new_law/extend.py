"""Adds the contact law of tests/dem/laws/with_adhesion.hpp to a copy of dem/: extend.py REPOSITORY COPY.

The edits are those of somebody who adds one, in the files that CONTRIBUTING.md names. new_law_test.cpp compares the
motion of grains with theory.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import extended_copy

HEADER = "laws/with_adhesion.hpp"

# File of dem/, its text, the text in place of that.
CONTACT_LAW = [
    ("laws/contact_laws.hpp", '#include "dem/laws/surface_law.hpp"\n',
     f'#include "dem/laws/surface_law.hpp"\n#include "dem/{HEADER}"\n'),
    ("laws/contact_laws.hpp", "    return common.liquid_bridge ?",
     "    if (common.work_of_adhesion > 0.0) return visit(WithAdhesion(law, common.work_of_adhesion));\n"
     "    return common.liquid_bridge ?"),
    ("laws/contact_parameters.hpp", "  double film_viscosity = 0.0;",
     "  double work_of_adhesion = 0.0;  // J/m^2, >= 0, the same for all materials of a run\n"
     "  double film_viscosity = 0.0;"),
    ("laws/contact_parameters.cpp", '  visit.section("liquid_bridge",',
     '  visit.real("work_of_adhesion", contact.work_of_adhesion,\n'
     '             {.unit = "J/m^2", .meaning = "of surfaces that touch", .at_least = 0.0});\n'
     '  visit.section("liquid_bridge",'),
    ("laws/material.cpp", "  if (a.liquid_bridge != b.liquid_bridge)\n",
     "  if (a.work_of_adhesion != b.work_of_adhesion)\n"
     '    throw InputError("Two materials differ in their work of adhesion; give all the same.");\n'
     "  if (a.liquid_bridge != b.liquid_bridge)\n"),
]


if __name__ == "__main__":
    root = pathlib.Path(sys.argv[1])
    extended_copy.write(root, pathlib.Path(sys.argv[2]), "dem", CONTACT_LAW,
                        {HEADER: (root / "tests/dem" / HEADER).read_text()})
