#!/usr/bin/env python3
"""Cases as people mistype them: `thalweg check` and `thalweg run` are of one opinion about every mutation of small
cases.

Called by ctest: run_fuzz_test.py THALWEG MPIEXEC NUMBER_OF_MUTATIONS [SEED]. The mutations are those of check_fuzz_test.py. A
case that check refuses is refused by run in the same words, and nothing is written; a case that check reports on runs
for two steps, or breaks down in the run (exit code 1, one sentence and a summary), but is not refused. No crash, no
hang; mutations of sizes that would take more memory than a test has are not run, and those that would take more time
only begin (--walltime). No message begins with a name that is missing.
"""
import random
import re
import subprocess
import sys

import yaml

from attempts import exit_code_of
from mutations import CaseLoader, limit_memory, mutated, text_of

THALWEG, NUMBER = sys.argv[1], int(sys.argv[3])
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 1
SECONDS = 60
MOST_UPDATES = 3e7   # cell updates and grain-steps that a run may have; ten times as many as a step may
STOPPED = 3          # exit code of a run that ends before its time

FLUID = """
system: fluid
name: fluid
domain:
  size: [0.008, 0.004, 0.006]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: {type: moving, velocity: [0.05, 0, 0]}}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, smagorinsky_constant: 0.27, time_step: 1.0e-4, collision: trt}
gravity: {magnitude: 9.8, slope: 0.05}
initial: {fluid: {uniform: [0.01, 0, 0]}}
solids: [{sphere: {centre: [0.004, 0.002, 0.003], radius: 1.0e-3}}]
run: {until: 2.0e-4}
output: {series: {every: 1.0e-4}, fluid: {every: 2.0e-4, fields: [velocity, pressure]}}
analysis: {fluid_statistics: {every: 1.0e-4}, wall_forces: {}}
"""

RESOLVED = """
system: resolved
name: resolved
domain:
  size: [0.012, 0.012, 0.016]
  spacing: 0.8e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, smagorinsky_constant: 0.27, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.05}
grains:
  - {count: 2, diameter: 4.8e-3, density: 2550, placement: {pattern: random, seed: 1}}
  - {diameter: 4.0e-3, density: 2550, fixed: true, placement: {positions: [[0.006, 0.006, 0.0021]]}}
contact: {restitution: 0.9, friction: 0.3}
coupling: {grain_steps_per_fluid_step: 20, lubrication: {}, links: bouzidi}
run: {until: 2.0e-4, ramp: 1.0e-3}
output: {series: {every: 1.0e-4}, grains: {every: 2.0e-4}, checkpoint: {every: 1.0e-4, keep: 2}}
analysis: {transport_rate: {from: 0.0}, bed_surface: {}, grain_profiles: {every: 1.0e-4}}
"""

GRAINS = """
system: grains
name: grains
domain:
  size: [0.04, 0.03, 0.04]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: no_slip, bottom: no_slip, top: free_slip}
gravity: {magnitude: 9.8, slope: 0.3}
grains:
  - {count: 20, diameter: {sizes: [4.0e-3, 5.0e-3], fractions: [0.5, 0.5]}, density: 2550, velocity: [0.1, 0, 0],
     placement: {pattern: random, seed: 3}}
  - {count: 3, density: 2550, placement: {pattern: random, seed: 4},
     shape: {clump: [{position: [0, 0, 0], diameter: 4.0e-3}, {position: [2.0e-3, 0, 0], diameter: 3.0e-3}]}}
contact: {normal_stiffness: 2000, tangential_stiffness: 571, restitution: 0.7, friction: 0.3, wall_friction: 0.3}
run: {until: 2.0e-5, time_step: 1.0e-5}
output: {series: {every: 1.0e-5}}
analysis: {transport_rate: {}}
"""

MODEL_FLUID = """
system: model_fluid
name: model fluid
domain:
  size: [0.03, 0.03, 0.05]
  spacing: 2.5e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
gravity: {magnitude: 9.8}
grains: [{count: 20, diameter: 5.0e-3, density: 2550, placement: {pattern: random, seed: 3}}]
contact: {normal_stiffness: 2000, tangential_stiffness: 571, restitution: 0.7, friction: 0.3, wall_friction: 0.3}
model_fluid: {shields_number: 0.1, reynolds_number: 1.0, drag: quadratic}
run: {until: 2.0e-4, time_step: 2.0e-6}
output: {series: {every: 1.0e-4}}
analysis: {transport_rate: {}}
"""

CASES = [yaml.load(text, CaseLoader) for text in (FLUID, RESOLVED, GRAINS, MODEL_FLUID)]


def thalweg(*arguments):
    return subprocess.run(
        [THALWEG, *arguments], capture_output=True, text=True, timeout=SECONDS, preexec_fn=limit_memory
    )


def said(result):
    """The program's own words. (MPI has some too where memory is short.)"""
    return [line for line in result.stderr.splitlines() if line.startswith("thalweg: ")]


def work_of(report):
    """Cell updates and grain-steps that check announces, of the run and of a step of it; infinite if it does not."""
    line = next((line for line in report.splitlines() if line.startswith("work ")), "")
    steps = re.match(r"work +(\d+) steps", line)
    numbers = [float(number) for number in re.findall(r"([\d.]+(?:e[+-]?\d+)?) (?:cell updates|grain-steps)", line)]
    work = max(numbers, default=float("inf"))
    return work, work / float(steps.group(1)) if steps else float("inf")


def has_empty_name(result):
    """Whether something is said of a file or key whose name is missing."""
    return any(re.match(r"thalweg: ( |:|=|is )", line) for line in said(result))


def disagreement(path, folder):
    """What check and run make of a case that does not fit together; empty if nothing, None if it was not run."""
    briefly = []
    try:
        checked = thalweg("check", str(path))
        if checked.returncode == 0:
            work, work_of_step = work_of(checked.stdout)
            if work_of_step > MOST_UPDATES / 10:
                return None
            briefly = ["--walltime", "00:00:02"] if work > MOST_UPDATES else []
        ran = thalweg("run", str(path), "--out", str(folder), *briefly)
    except subprocess.TimeoutExpired as late:
        return f"no answer to {late.cmd[1]} within {SECONDS} s"
    if has_empty_name(checked) or has_empty_name(ran):
        return f"a name is missing: {checked.stderr}{ran.stderr}"
    if checked.returncode == 2:
        if ran.returncode != 2:
            return f"check refuses ({checked.stderr.strip()}), and run ends with {ran.returncode}: {ran.stderr}"
        if folder.exists():
            return "refused, but something was written"
        return "" if said(ran) == said(checked) else f"two reasons: {checked.stderr}{ran.stderr}"
    if checked.returncode != 0:
        return f"check ends with {checked.returncode}: {checked.stderr}"
    if ran.returncode not in (0, 1) and not (briefly and ran.returncode == STOPPED):
        return f"check reports, and run ends with {ran.returncode}: {ran.stderr}"
    if not (folder / "summary.json").exists():
        return f"no summary, exit code {ran.returncode}: {ran.stderr}"
    if ran.returncode == 1 and len(said(ran)) != 1:
        return f"not one sentence: {ran.stderr}"
    return ""


def main():
    chance = random.Random(SEED)

    def attempt(number, folder):
        content, what = mutated(CASES[number % len(CASES)], chance)
        path = folder / "case.yaml"
        path.write_text(text_of(content, chance))
        return what, disagreement(path, folder / "run")

    return exit_code_of(attempt, NUMBER, "mutations", SEED, "too large to run")


if __name__ == "__main__":
    sys.exit(main())
