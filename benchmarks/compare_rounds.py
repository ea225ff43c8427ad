#!/usr/bin/env python3
"""Table of the rounds of benchmarks/compare.sh: compare_rounds.py NAME COMMIT FIRST SECOND ROUNDS

FIRST and SECOND are run folders without the number of the round: FIRST.0, FIRST.1, ... The fastest round of each
counts.
"""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
import thalweg

COMPARE = ROOT / "scripts" / "compare_checkpoints.py"


def fastest(folder, rounds):
    summaries = [thalweg.Run(f"{folder}.{n}").summary for n in range(rounds)]
    return max(summaries, key=lambda s: s["steps_per_second"])


def milliseconds(summary):
    steps = summary["steps_in_this_session"]
    return {name: 1e3 * phase["mean_seconds"] / steps for name, phase in summary["phases"].items()}


def main():
    name, commit, first, second, rounds = *sys.argv[1:5], int(sys.argv[5])
    before, now = fastest(first, rounds), fastest(second, rounds)
    print(f"{name}: {before['cells']} cells, {before['grains']} grains, {before['ranks']} ranks")
    print(f"  {'':<16}{commit:>10}{'this tree':>12}{'ratio':>8}")
    speeds = before["steps_per_second"], now["steps_per_second"]
    print(f"  {'steps/s':<16}{speeds[0]:>10.1f}{speeds[1]:>12.1f}{speeds[1] / speeds[0]:>8.2f}")
    old, new = milliseconds(before), milliseconds(now)
    for phase in new:
        if max(new[phase], old.get(phase, 0.0)) < 0.005:
            continue
        ratio = f"{old[phase] / new[phase]:>8.2f}" if old.get(phase) and new[phase] else ""
        print(f"  {phase + ' ms':<16}{old.get(phase, 0.0):>10.3f}{new[phase]:>12.3f}{ratio}")
    bits = subprocess.run([sys.executable, COMPARE, f"{first}.0", f"{second}.0"], capture_output=True, text=True)
    print("  bits: " + (bits.stdout.strip().splitlines() or ["cannot be compared"])[-1])


if __name__ == "__main__":
    main()
