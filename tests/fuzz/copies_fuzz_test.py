#!/usr/bin/env python3
"""Random valid cases beside their copies have twice the sums, and the same fluxes, stresses, means and extremes.

Called by ctest: copies_fuzz_test.py THALWEG MPIEXEC NUMBER_OF_CASES [SEED]. Each case (random_cases.py) runs twice, the
second time in a box twice as long along a periodic axis, with everything in it twice. Which columns are sums over the
box follows from units and names. The fluid is computed in double precision, but where links are cut is kept in single
precision.
"""
import copy
import csv
import random
import re
import sys
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from attempts import exit_code_of, failure_of
from placed_cases import place_grains
from random_cases import SIZE, is_periodic, random_case
from stl_box import write_box

THALWEG, NUMBER = sys.argv[1], int(sys.argv[3])
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 1
ROUNDING = 1e-5    # of the largest value of a column or field
NOTHING = {"kg": 1e-14, "N": 1e-15, "N m": 1e-18}   # sums that balance, of 0.013 kg of water and grains of 1e-3 N
SUMS = ("kg", "kg m/s", "J", "N", "N m")
COUNTS = ("moving_grains", "moving_grains_error", "upstream_grains", "downstream_grains", "contacts", "fluid_cells")
# Analyses of single grains, of given places, and of the height of a bed, which a dozen grains have by the chance of
# rounding; of a copy along x also that of the reach, whose sections have another length there.
LEFT_OUT = ("tracks", "entrainment", "probes", "bed_surface")
# What is seen from above is counted in pixels, of which two boxes may have one more than twice those of one.
OF_PIXELS = ("surface", "armouring_ratio")


def case_to_copy(chance):
    """A case and the periodic axis along which it is copied."""
    axes = []
    while not axes or "disks" in case or case["system"] == "model_fluid":
        case = random_case(chance)
        periodic = [is_periodic(case["domain"]["boundaries"], axis) for axis in range(3)]
        axes = [axis for axis in (0, 1) if periodic[axis]]
    axis = chance.choice(axes)
    for key in ("supplies", "sinks"):
        case.pop(key, None)
    for name in (*LEFT_OUT, *(["reach"] if axis == 0 else [])):
        case["analysis"].pop(name, None)
    case["run"].pop("until_at_rest", None)
    case["output"] = {"series": case["output"]["series"]}
    if "fluid" in case:
        case["fluid"]["precision"] = "double"
        case["initial"] = {"fluid": {"uniform": [0.15, chance.uniform(-0.1, 0.1), 0.05 if periodic[2] else 0]}}
    if "grains" in case:
        place_grains(chance, case, periodic)
        for grains in case["grains"]:   # two of a population do not turn about one point as two do about their own
            grains.get("motion", {}).pop("rotation", None)
            if "motion" in grains and not grains["motion"]:
                grains["motion"] = {"velocity": [0.02, 0, 0]}
    return case, axis


def copied(old, axis):
    """The case beside its copy."""
    def moved(point):
        return [x + SIZE[axis] * (a == axis) for a, x in enumerate(point)]

    def moved_body(old):
        new = copy.deepcopy(old)
        for part in (new, new.get("sphere", {}), new.get("motion", {}).get("rotation", {})):
            for key in {"centre", "translate", "point"} & set(part):
                part[key] = moved(part[key])
        return new

    new = copy.deepcopy(old)
    new["domain"]["size"][axis] *= 2
    for grains in new.get("grains", []):
        grains["placement"]["positions"] += [moved(place) for place in grains["placement"]["positions"]]
    for key in {"solids", "walls"} & set(old):
        new[key] += [moved_body(body) for body in old[key]]
    return new


def is_of_one_body(name):
    return re.match(r"solid_\d|wall_force_wall_\d", name) is not None


def differs(name, unit, one, both):
    """Whether values of both are not twice or the same as those of one, as they should be."""
    if any(word in name for word in OF_PIXELS):
        return False
    one, both = numpy.asarray(one, float), numpy.asarray(both, float)
    twice = (unit in SUMS and not is_of_one_body(name)) or re.sub(r"^class_\d+_", "", name) in COUNTS
    if one.shape != both.shape or (numpy.isnan(one) != numpy.isnan(both)).any():
        return True
    apart = numpy.nan_to_num(abs(both - (2 if twice else 1) * one))
    return (apart > max(ROUNDING * numpy.nanmax(abs(one), initial=0), NOTHING.get(unit, 0))).any()


def in_series(one, both):
    one, both = (list(csv.reader((folder / "series.csv").read_text().splitlines())) for folder in (one, both))
    if len(one) != len(both):
        yield "rows"
        return
    for head in one[0]:
        name, _, unit = head.rstrip("]").partition(" [")
        if head not in both[0]:
            yield f"{head}: not in both"
            continue
        values = ([float(row[rows[0].index(head)] or "nan") for row in rows[1:]] for rows in (one, both))
        if differs(name, unit, *values):
            yield head


def in_profiles(one, both):
    if not (one / "profiles.h5").exists():
        return
    with h5py.File(one / "profiles.h5") as first, h5py.File(both / "profiles.h5") as second:
        names = []
        first.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        for name in names:
            if name not in second:
                yield f"{name}: not in both"
                continue
            unit = str(first[name].attrs.get("units", ""))
            values = first[name][...], second[name][...]
            if first[name].dtype.kind in "fiu" and differs(name.split("/")[-1], unit, *values):
                yield name


def disagreement(chance, folder):
    """What is wrong with the copy; empty if nothing is, None if the case is refused."""
    write_box(folder / "box.stl", (-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
    case, axis = case_to_copy(chance)
    failure = failure_of(THALWEG, folder, {"case": case, "both": copied(case, axis)})
    if failure != "":
        return failure and f"along {'xy'[axis]}: {failure}"
    found = [*in_series(folder / "case", folder / "both"), *in_profiles(folder / "case", folder / "both")]
    return f"along {'xy'[axis]}: {', '.join(found)}" if found else ""


def attempt(number, folder):
    return f"case {number}", disagreement(random.Random(f"{SEED} {number}"), folder)


if __name__ == "__main__":
    sys.exit(exit_code_of(attempt, NUMBER, "cases", SEED, "refused"))
