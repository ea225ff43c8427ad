#!/usr/bin/env python3
"""Random valid cases give the same bits on any ranks and in parts.

Called by ctest: ranks_fuzz_test.py THALWEG MPIEXEC NUMBER_OF_CASES [SEED]. Each case (random_cases.py) runs on one rank,
on several in a random layout, and in two parts on two other numbers of ranks. Every file that the run on one rank has
written must have the same bytes in the others: checkpoints, tables, records, frames. A case that check refuses is not
run.
"""
import random
import subprocess
import sys
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from attempts import SECONDS, exit_code_of
from random_cases import SIZE, SPACING, random_case
from stl_box import write_box

THALWEG, MPIEXEC, NUMBER = sys.argv[1], sys.argv[2], int(sys.argv[3])
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 1
RANKS = [2, 3, 4, 6, 8]
ABOUT_THE_RUN = ("run.log", "summary.json", "case", ".lock")   # how it went, on what and in how many parts


def thalweg(*arguments, ranks=1):
    parallel = [MPIEXEC, "-n", str(ranks)] if ranks > 1 else []
    return subprocess.run([*parallel, THALWEG, *map(str, arguments)], capture_output=True, text=True, timeout=SECONDS)


def contents(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*")) if path.is_file() and not path.name.startswith(ABOUT_THE_RUN)
    }


def layout_of(ranks, chance):
    """Ranks along each axis, with blocks of a few cells at least."""
    cells = [round(length / SPACING) for length in SIZE]
    return chance.choice([
        f"{x},{y},{z}" for x in range(1, ranks + 1) for y in range(1, ranks + 1) for z in range(1, ranks + 1)
        if x * y * z == ranks and all(n // p >= 5 for n, p in zip(cells, (x, y, z)))
    ])


def disagreement(case, folder, chance):
    """Which runs of a case differ and where; empty if none do, None if the case is refused."""
    path = folder / "case.yaml"
    path.write_text(yaml.safe_dump(case, sort_keys=False))
    write_box(folder / "box.stl", (-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
    checked = thalweg("check", path)
    if checked.returncode:
        return None if checked.returncode == 2 else f"check ends with {checked.returncode}: {checked.stderr}"
    whole, several, parts = (folder / name for name in ("whole", "several", "parts"))
    n, first, second = (chance.choice(RANKS) for _ in range(3))
    layout = layout_of(n, chance)
    runs = [
        (["run", path, "--out", whole], 1), (["run", path, "--out", several, "--layout", layout], n),
        (["run", path, "--out", parts, "--until", case["run"]["until"] / 2], first), (["run", path, "--restart", parts], second),
    ]
    for arguments, ranks in runs:
        done = thalweg(*arguments, ranks=ranks)
        if done.returncode:
            return f"{arguments[0]} on {ranks} ends with {done.returncode}: {done.stderr}"
    expected = contents(whole)
    for other, how in ((several, f"on {n} ranks ({layout})"), (parts, f"in parts on {first} and {second} ranks")):
        found = contents(other)
        differ = sorted(name for name in {*expected, *found} if expected.get(name) != found.get(name))
        if differ:
            return f"{how}: {', '.join(differ)}"
    return ""


def attempt(number, folder):
    chance = random.Random(f"{SEED} {number}")
    case = random_case(chance)
    return f"case {number}", disagreement(case, folder, chance)


if __name__ == "__main__":
    sys.exit(exit_code_of(attempt, NUMBER, "cases", SEED, "refused"))
