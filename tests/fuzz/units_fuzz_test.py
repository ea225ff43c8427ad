#!/usr/bin/env python3
"""Random valid cases mean the same in other units of length, time and mass.

Called by ctest: units_fuzz_test.py THALWEG MPIEXEC NUMBER_OF_CASES [SEED]. Each case (random_cases.py) runs twice, the second
time with every value multiplied by the factor of its unit. Whatever the two runs write must differ by the factors of its
units: the case with all defaults, tables, profiles and checkpoints. The factors are powers of 2^6, whose square and cube
roots are powers of two, so that the sums of the solver are the same to the last bit; logarithms and other powers, of
distributions for example, are not. The units are those in the comments of case.yaml, the heads of tables and the
attributes of HDF5 files.
"""
import csv
import random
import re
import sys
from pathlib import Path

import h5py
import numpy
import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
from attempts import exit_code_of, run_case
from random_cases import random_case
from stl_box import write_box
from thalweg.case_file import CaseLoader

THALWEG, NUMBER = sys.argv[1], int(sys.argv[3])
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 1
ROUNDING = 1e-12   # of the largest value of a column or field

# Powers of length, time and mass. Others are pure numbers: diameters, cells, rad, v_0.
DIMENSIONS = {
    "m": (1, 0, 0), "s": (0, 1, 0), "kg": (0, 0, 1), "N": (1, -2, 1), "Pa": (-1, -2, 1), "J": (2, -2, 1), "W": (2, -3, 1),
    "Hz": (0, -1, 0),
}
# Of checkpoints, which have no units in the file. Those of fields of the fluid are in lattice units.
SAVED = {
    "grains/position": "m", "grains/velocity": "m/s", "grains/angular_velocity": "rad/s", "grains/mass": "kg",
    "grains/radius": "m", "grains/contact_ids": "1", "grains/contact_spring": "m", "grains/contact_force": "N",
    "grains/contact_torque": "N m", "grains/load_force": "N", "grains/load_torque": "N m",
    **{f"fluid/populations_{i:02d}": "1" for i in range(19)},
}


class Units:
    """Other ones, by the powers of two by which numbers of metres, seconds and kilograms are multiplied."""

    def __init__(self, powers):
        self.powers = powers

    def factor(self, unit):
        power = 0
        for part, sign in zip(unit.split("/"), (1, -1), strict=False):
            for name, exponent in re.findall(r"([^\s^]+)(?:\^(\d+))?", part):
                of_each = DIMENSIONS.get(name, (0, 0, 0))
                power += sign * int(exponent or 1) * sum(a * b for a, b in zip(of_each, self.powers))
        return 2.0 ** power


def is_plain(value):
    """A number, or a list of them."""
    numbers = value if isinstance(value, list) else [value]
    return bool(numbers) and all(isinstance(x, (int, float)) and not isinstance(x, bool) for x in numbers)


def is_nested(value):
    return isinstance(value, list) and any(isinstance(x, (dict, list)) for x in value)


def values_of(content, path=()):
    """Paths and values of a case."""
    if isinstance(content, dict):
        for key, value in content.items():
            yield from values_of(value, (*path, key))
    elif is_nested(content):
        for number, value in enumerate(content):
            yield from values_of(value, (*path, number))
    else:
        yield path, content


def units_of(text):
    """By the path of each value of a written case the unit in the comment of its line."""
    lines, found = text.splitlines(), {}

    def look(node, path):
        if isinstance(node, yaml.MappingNode):
            for key, value in node.value:
                look(value, (*path, key.value))
        elif isinstance(node, yaml.SequenceNode) and any(not isinstance(item, yaml.ScalarNode) for item in node.value):
            for number, item in enumerate(node.value):
                look(item, (*path, number))
        else:
            unit = lines[node.start_mark.line].partition(" # ")[2].strip()
            found[path] = "" if "wall time" in unit else unit

    look(yaml.compose(text), ())
    return found


def unit_at(path, units):
    """Values whose kind depends on the case have none in its comments: sizes, and the lists that probes have."""
    if path[-1] == "scale":   # of a surface whose own numbers stay as they are; that of a sphere has none
        return "m"
    if "diameter" in path:
        return "1" if path[-1] in ("fractions", "geometric_deviation") else "m"
    if path[-2:-1] == ("points",):
        return "m"
    return units.get(path, "")


def in_other_units(content, change, units, path=()):
    if isinstance(content, dict):
        return {key: in_other_units(value, change, units, (*path, key)) for key, value in content.items()}
    if is_nested(content):
        return [in_other_units(value, change, units, (*path, number)) for number, value in enumerate(content)]
    unit = unit_at(path, units)
    if not unit or not is_plain(content):
        return content
    factor = change.factor(unit)
    return [value * factor for value in content] if isinstance(content, list) else content * factor


def differs(here, there, factor):
    """Whether values are not each other's, but for rounding."""
    here, there = numpy.asarray(here, float) * factor, numpy.asarray(there, float)
    if here.shape != there.shape or (numpy.isnan(here) != numpy.isnan(there)).any():
        return True
    here, there = here[~numpy.isnan(here)], there[~numpy.isnan(there)]
    return here.size > 0 and (abs(here - there) > ROUNDING * abs(here).max()).any()


# ---- what the runs have written: generators of what differs

def in_cases(here, there, change):
    units = units_of(here.read_text())
    first, second = (dict(values_of(yaml.load(path.read_text(), CaseLoader))) for path in (here, there))
    for path in sorted({*first, *second}, key=str):
        one, other = first.get(path), second.get(path)
        if path[-1] == "scale" and one == other == 1:
            continue
        if is_plain(one) and is_plain(other):
            different = differs(one, other, change.factor(unit_at(path, units)))
        else:
            different = one != other
        if different:
            yield f"{'.'.join(map(str, path))}: {one}, {other}"


def in_tables(here, there, change):
    first, second = (list(csv.reader(path.read_text().splitlines())) for path in (here, there))
    if len(first) != len(second) or first[0] != second[0]:
        yield "rows or columns"
        return
    for column, head in enumerate(first[0]):
        one, other = ([row[column] for row in rows[1:]] for rows in (first, second))
        unit = re.search(r"\[(.*)\]", head)
        if unit and differs(*([float(word or "nan") for word in words] for words in (one, other)), change.factor(unit[1])):
            yield head
        if not unit and one != other:
            yield head


def in_archives(here, there, change):
    with h5py.File(here) as first, h5py.File(there) as second:
        names = []
        first.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        for name in names:
            unit = first[name].attrs.get("units", SAVED.get(name))
            if unit is None:
                continue
            unit = unit.decode() if isinstance(unit, bytes) else unit
            if name not in second or differs(first[name][...], second[name][...], change.factor(unit)):
                yield f"{name} [{unit}]"


def differences(here, there, change):
    yield from in_cases(here / "case.yaml", there / "case.yaml", change)
    for pattern, compare in (("*.csv", in_tables), ("*.h5", in_archives)):
        first, second = ({path.relative_to(folder) for path in folder.rglob(pattern)} for folder in (here, there))
        for name in sorted(first ^ second):
            yield f"{name}: not in both"
        for name in sorted(first & second):
            for what in compare(here / name, there / name, change):
                yield f"{name}: {what}"


# ---- cases

def with_scales(case):
    """Gives what has a default in SI units, and names faces as the written case does."""
    if "bed_surface" in case["analysis"]:
        case["analysis"]["bed_surface"]["static_time"] = 0.5
    faces = case["domain"]["boundaries"]
    for axis in "xy":
        both = faces.get(f"{axis}_low"), faces.get(f"{axis}_high")
        if both[0] is not None and both[0] == both[1]:
            faces[axis] = faces.pop(f"{axis}_low")
            del faces[f"{axis}_high"]
    return case


def disagreement(case, folder, chance):
    """What differs in other units; empty if nothing does, None if the case is refused."""
    write_box(folder / "box.stl", (-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
    powers = [chance.choice((-12, -6, 6, 12)) for _ in range(3)]
    if "law" in case.get("contact", {}):   # of Hertz: its shortest contact is that at 1 m/s
        powers[0] = powers[1]
    change = Units(powers)
    path, other = folder / "case.yaml", folder / "other.yaml"
    path.write_text(yaml.safe_dump(with_scales(case), sort_keys=False))
    done = run_case(THALWEG, path, folder / "here")
    if done.returncode:
        return None if done.returncode == 2 else f"ends with {done.returncode}: {done.stderr}"
    units = units_of((folder / "here" / "case.yaml").read_text())
    other.write_text(yaml.safe_dump(in_other_units(case, change, units), sort_keys=False))
    done = run_case(THALWEG, other, folder / "there")
    if done.returncode:
        return f"powers of two {powers}: ends with {done.returncode}: {done.stderr}"
    found = list(differences(folder / "here", folder / "there", change))
    return f"powers of two {powers}: {'; '.join(found[:10])}" if found else ""


def attempt(number, folder):
    chance = random.Random(f"{SEED} {number}")
    return f"case {number}", disagreement(random_case(chance), folder, chance)


if __name__ == "__main__":
    sys.exit(exit_code_of(attempt, NUMBER, "cases", SEED, "refused"))
