#!/usr/bin/env python3
"""Random valid cases, mirrored, turned and shifted, have the mirrored, turned and shifted flow and grains.

Called by ctest: symmetry_fuzz_test.py THALWEG MPIEXEC NUMBER_OF_CASES [SEED]. Each case (random_cases.py, without what
knows one axis from another) runs twice, the second time in another position: x and y laid on each other, or all axes of
dry grains, mirrored, and shifted by whole cells along periodic axes without bodies that have a place. The states at the
end must be each other's but for rounding: the fluid is computed in double precision, but where links are cut is kept in
single precision.
"""
import random
import sys
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from attempts import exit_code_of, failure_of
from placed_cases import place_grains
from random_cases import SIZE, is_periodic, random_case
from stl_box import write_box
from symmetry import Symmetry, case_in, signed_axes

THALWEG, NUMBER = sys.argv[1], int(sys.argv[3])
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 1
ROUNDING = 1e-6   # of the largest value; of positions, of the box
FARTHEST_SHIFT = 20   # cells


# ---- cases

def knows_an_axis(case):
    inlet = any(isinstance(face, dict) and face["type"] == "velocity_inlet" for face in case["domain"]["boundaries"].values())
    return inlet or "disks" in case or case["system"] == "model_fluid"


def symmetric_case(chance):
    case = random_case(chance)
    while knows_an_axis(case):
        case = random_case(chance)
    periodic = [is_periodic(case["domain"]["boundaries"], axis) for axis in range(3)]
    for key in ("supplies", "sinks", "analysis"):
        case.pop(key, None)
    mode = {key: value for key, value in case["gravity"].items() if key == "mode"}
    case["gravity"] = {"vector": [9.6 * case["gravity"]["slope"], chance.choice([0, 0.3]), -9.6], **mode}
    case["run"].pop("until_at_rest", None)
    case["output"] = {}
    if "fluid" in case:
        case["fluid"]["precision"] = "double"
        case["fluid"].pop("mean_velocity", None)
        case["initial"] = {"fluid": {"uniform": [0.15, chance.uniform(-0.1, 0.1), 0.05 if periodic[2] else 0]}}
    if "grains" in case:
        place_grains(chance, case, periodic)
    return case, periodic


def symmetry_of(chance, case, periodic):
    to, signs = chance.choice(signed_axes(with_z=case["system"] == "grains")[1:])
    stays = {"solids", "walls"} & set(case) or any("motion" in grains for grains in case.get("grains", []))
    shift = [chance.randint(0, FARTHEST_SHIFT) if periodic[to.index(axis)] and not stays else 0 for axis in range(3)]
    return Symmetry(to, signs, shift)


# ---- what the runs have come to

def end_of(folder):
    checkpoints = folder / "checkpoints"
    return h5py.File(checkpoints / (checkpoints / "latest").read_text().strip())


def differs(turned, other, scale):
    return turned.size > 0 and not (abs(turned - other) <= ROUNDING * scale).all()


def grains_that_differ(here, there, symmetry, periodic):
    places = numpy.reshape([symmetry.point(place, periodic) for place in here["position"][...]], (-1, 3))
    apart = there["position"][...] - places
    for axis, old in enumerate(symmetry.old):
        if periodic[old]:
            apart[:, axis] -= SIZE[old] * numpy.round(apart[:, axis] / SIZE[old])
    if differs(apart, 0, max(SIZE)):
        yield "positions"
    for name, turned in (("velocity", symmetry.vector), ("angular_velocity", symmetry.spin)):
        values = numpy.reshape([turned(value) for value in here[name][...]], (-1, 3))
        if differs(values, there[name][...], abs(values).max(initial=0)):
            yield name


def differences(here, there, symmetry, periodic):
    with end_of(here) as first, end_of(there) as second:
        if "position" in first.get("grains", ()):
            yield from grains_that_differ(first["grains"], second["grains"], symmetry, periodic)
        if "fluid" in first:
            one, other = (numpy.array([end[f"fluid/populations_{i:02d}"][...] for i in range(19)]) for end in (first, second))
            one = symmetry.populations(one)
            if differs(one, other, abs(one).max()):
                yield "populations"


def disagreement(chance, folder):
    """What differs in another position; empty if nothing does, None if the case is refused."""
    write_box(folder / "box.stl", (-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
    case, periodic = symmetric_case(chance)
    symmetry = symmetry_of(chance, case, periodic)
    failure = failure_of(THALWEG, folder, {"case": case, "other": case_in(case, symmetry, periodic)})
    if failure != "":
        return failure and f"{symmetry}: {failure}"
    found = list(differences(folder / "case", folder / "other", symmetry, periodic))
    return f"{symmetry}: {', '.join(found)}" if found else ""


def attempt(number, folder):
    return f"case {number}", disagreement(random.Random(f"{SEED} {number}"), folder)


if __name__ == "__main__":
    sys.exit(exit_code_of(attempt, NUMBER, "cases", SEED, "refused"))
