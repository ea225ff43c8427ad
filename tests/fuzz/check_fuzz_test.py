#!/usr/bin/env python3
"""Cases as people mistype them: `thalweg check` of mutations of every shipped case either reports or refuses in one
sentence.

Called by ctest: check_fuzz_test.py THALWEG MPIEXEC NUMBER_OF_MUTATIONS [SEED]. A mutation changes one key (mutations.py). No
crash, no hang, and what is refused names the file.
"""
import random
import subprocess
import sys

import yaml

from attempts import exit_code_of
from mutations import ROOT, CaseLoader, limit_memory, mutated, text_of

THALWEG, NUMBER = sys.argv[1], int(sys.argv[3])
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 1
SECONDS = 30   # a check takes a tenth of a second


def shipped_cases():
    for path in sorted((ROOT / "cases").glob("*/*.yaml")):
        content = yaml.load(path.read_text(), CaseLoader)
        if "case" not in content:   # else it is a sweep
            yield path, content


def complaint(path):
    """What is wrong with the answer to this case; empty if nothing is."""
    try:
        done = subprocess.run([THALWEG, "check", str(path)], capture_output=True, text=True, timeout=SECONDS,
                              preexec_fn=limit_memory)
    except subprocess.TimeoutExpired:
        return f"no answer within {SECONDS} s"
    if done.returncode == 0:
        wrong = [word for word in ("nan", "inf ", "-nan") if f" {word}" in done.stdout]
        return f"reports {', '.join(wrong)}:\n{done.stdout}" if wrong else ""
    lines = done.stderr.splitlines()
    if done.returncode != 2:
        return f"exit code {done.returncode}: {done.stderr}"
    if len(lines) != 1 or not lines[0].startswith("thalweg: ") or lines[0][-1] not in ".?":
        return f"not one sentence: {done.stderr}"
    return "" if str(path) in lines[0] else f"does not name the file: {lines[0]}"


def main():
    chance, cases = random.Random(SEED), list(shipped_cases())

    def attempt(number, folder):
        original, content = cases[number % len(cases)]
        content, what = mutated(content, chance)
        path = folder / "case.yaml"
        path.write_text(text_of(content, chance))
        return f"{original.relative_to(ROOT)}, {what}", complaint(path)

    return exit_code_of(attempt, NUMBER, "mutations", SEED)


if __name__ == "__main__":
    sys.exit(main())
