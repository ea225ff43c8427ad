"""Attempts at random cases: each in a folder of its own, and the first failures told with the case."""
import subprocess
import tempfile
from pathlib import Path

import yaml

SECONDS = 120   # that a run may take


def exit_code_of(attempt, count, what, seed, left_out=""):
    """Makes `count` attempts, prints the first ten failures, three of them with the case, and how many there were. The
    exit code is 1 where any failed or more than half were left out.

    attempt(number, folder): writes case.yaml and returns its name and what is wrong with it; empty if nothing is, None
    if it was left out. what: is attempted, as a word; left_out: why an attempt may be.
    """
    failures, left = [], 0
    for number in range(count):
        with tempfile.TemporaryDirectory() as folder:
            name, wrong = attempt(number, Path(folder))
            left += wrong is None
            if wrong:
                case = (Path(folder) / "case.yaml").read_text() if len(failures) < 3 else ""
                failures.append(f"{name}: {wrong}\n{case}")
    for failure in failures[:10]:
        print(failure)
    print(f"{count} {what}, seed {seed}: {len(failures)} failures{f', {left} {left_out}' if left_out else ''}")
    return 1 if failures or left > count // 2 else 0


def failure_of(program, folder, cases):
    """Why not all of these cases end well, each run into a folder of its name: empty if they do, None if the first is
    refused. cases: contents by name; the others are valid if the first is.
    """
    for name, content in cases.items():
        path = folder / f"{name}.yaml"
        path.write_text(yaml.safe_dump(content, sort_keys=False))
        done = run_case(program, path, folder / name)
        if done.returncode:
            refused = content is next(iter(cases.values())) and done.returncode == 2
            return None if refused else f"{name} ends with {done.returncode}: {done.stderr}"
    return ""


def run_case(program, case, folder):
    """The run of a case on one rank, into a folder."""
    return subprocess.run([program, "run", case, "--out", folder], capture_output=True, text=True, timeout=SECONDS)
