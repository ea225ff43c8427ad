#!/usr/bin/env python3
"""Cases as people mistype them: `thalweg check` of mutations of every shipped case either reports or refuses in one
sentence.

Called by ctest: check_fuzz_test.py THALWEG MPIEXEC NUMBER_OF_MUTATIONS [SEED]. A mutation changes one key (mutations.py). No
crash, no hang, and what is refused names the file; the first ten failures are printed with the case that shows them.
"""
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import yaml

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
    chance = random.Random(SEED)
    cases, failures = list(shipped_cases()), []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(NUMBER):
            original, content = cases[number % len(cases)]
            content, what = mutated(content, chance)
            path = Path(folder) / "case.yaml"
            path.write_text(text_of(content, chance))
            wrong = complaint(path)
            if wrong:
                failures.append(f"{original.relative_to(ROOT)}, {what}: {wrong}")
    for failure in failures[:10]:
        print(failure)
    print(f"{NUMBER} mutations, seed {SEED}: {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
