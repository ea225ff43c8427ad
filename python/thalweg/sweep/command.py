"""The command `thalweg sweep`."""
import functools
import json
import os
import shlex
import shutil
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from thalweg.case_file import read_case
from thalweg.sweep.machine import cores, memory_needed, runs_at_a_time
from thalweg.sweep.plan import SweepError, figure_of, meant_by, read_plan
from thalweg.sweep.runner import Runner
from thalweg.sweep.runs import DONE, FAILED, check_command, name_of
from thalweg.sweep.tables import as_in_case, those_without_dimension, units_of_keys, write_tables
from thalweg.sweep.tasks import known_runs, tasks_of
from thalweg.sweep.warnings import lines_of, said_by_checks

STOPPED = 3   # exit code of thalweg run


def add_to(commands):
    sweep = commands.add_parser(
        "sweep",
        description=(
            "Run a case with many values of its keys, as many runs at a time as there are cores and memory for. The"
            " same command resumes a sweep that was stopped or killed; finished runs are not repeated."
        ),
    )
    sweep.add_argument("sweep", type=Path, metavar="SWEEP.yaml", help="Sweep file (docs/sweep.md)")
    sweep.add_argument("--out", type=Path, metavar="FOLDER",
                       help="Folder for runs and tables (default: named after the file, beside it)")
    sweep.add_argument(
        "--jobs", type=int, metavar="N", help="Runs at a time (default: one core per rank, as memory allows)"
    )
    sweep.add_argument("--retry", action="store_true", help="Run failed runs again")
    sweep.add_argument(
        "--dry-run", action="store_true",
        help="Print the runs, or the bisections, with the warnings of thalweg check, and stop",
    )
    sweep.add_argument("--task", type=int, metavar="N", help="Only run (or bisection) N of the dry run, counted from 0")
    sweep.add_argument("--tables", action="store_true", help="Only write the tables of the existing runs")
    sweep.add_argument(
        "--slurm", action="store_true", help="Print a Slurm array job with a task for each run or bisection"
    )


def program():
    found = os.environ.get("THALWEG_PROGRAM") or shutil.which("thalweg")
    if not found:
        raise SweepError("the program thalweg is not on the path; start this as `thalweg sweep`.")
    return found


def units_of(plan):
    """Of the keys of the case."""
    system = str(read_case(plan.case).get("system", "resolved"))
    said = asked([program(), "defaults", "--schema"])
    units = units_of_keys(json.loads(said.stdout), system) if said.returncode == 0 else {}
    return those_without_dimension(units) if plan.in_grain_units else units


def asked(command):
    return subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace")


class Checks:
    """What `thalweg check` says of a case with some settings, asked for once."""

    def __init__(self, case):
        self.case, self.said = case, {}

    def command(self, settings):
        return tuple(check_command(program(), self.case, settings))

    def __call__(self, settings):
        command = self.command(settings)
        if command not in self.said:
            self.said[command] = asked(command)
        return self.said[command]

    def know(self, settings):
        return self.command(settings) in self.said


def refuse_impossible(plan, tasks, checks):
    """Before anything is run: a misspelt key would only make every run fail. A value that a run cannot have is that
    run's."""
    if plan.bisections:   # which choose their runs as they go on
        return
    said = [checks(task.settings) for task in tasks[:1] + tasks[1:][-1:]]
    if said and all(check.returncode == 2 for check in said):
        raise SweepError(
            f"neither the first nor the last run can be set up: {said[0].stderr.strip().removeprefix('thalweg: ')}"
        )


def takes_memory(key):
    """Whether a key of the case may change the memory of a run: contacts and seeds do not, and need no check for
    each of a thousand runs."""
    return not (key.startswith("contact.") or key.endswith((".seed", ".friction")) or key == "name")


def most_memory(tasks, checks):
    """That a run takes of those that are left, in bytes."""
    alike = {}   # settings, by what takes memory
    for settings in (settings for task in tasks if task.wanted() for settings in task.ends()):
        key = json.dumps([(key, value) for key, value in settings.items() if takes_memory(key)])
        alike.setdefault(key, []).append(settings)

    def memory_of(runs):
        """Of one of them that can be run, in bytes."""
        runs = sorted(runs, key=lambda settings: not checks.know(settings))
        return memory_needed(checks(runs[0]).stdout) or memory_needed(checks(runs[-1]).stdout)

    with ThreadPoolExecutor(max_workers=cores()) as pool:
        return max(pool.map(memory_of, alike.values()), default=0.0)


def refuse_same_names(plan, file):
    """Of runs: they would share a folder, and a repetition would count twice."""
    repetitions = plan.bisections[0].repetitions if plan.bisections else ({},)
    keys = plan.naming_keys + list(repetitions[0])
    names = Counter(name_of(point | repetition, keys) for point in plan.points for repetition in repetitions)
    name, count = names.most_common(1)[0]
    if count > 1:
        raise SweepError(f"{file}: two runs would be called {name}; give them values that differ.")


def describe(task, keys):
    given = (f"{key} = {as_in_case(task.settings, key)}" for key in keys if key in task.settings)
    return ", ".join(given) or "the case as it is"


def list_tasks(plan, tasks):
    """What there is to run, and what `thalweg check` warns of: of a bisection at the ends of its range."""
    for number, task in enumerate(tasks):
        print(f"{number:<5}{describe(task, plan.keys)}{'' if plan.bisections else f': {task.run.state}'}", flush=True)
    ends = [settings for task in tasks for settings in task.ends()]
    checks = [functools.partial(asked, check_command(program(), plan.case, settings)) for settings in ends]
    keys = list(dict.fromkeys(key for settings in ends for key in settings))
    names = [name_of(settings, plan.naming_keys if not plan.bisections else keys) for settings in ends]
    for line in lines_of(said_by_checks(names, checks)):
        print(line)


def slurm_job(wanted, count, ranks, folder):
    """An array of `count` tasks, each with as many runs at a time as --jobs says, of `ranks` ranks. A task whose time
    is nearly up stops its runs and puts itself back into the queue; one that is cancelled does not."""
    jobs = wanted.jobs or 1
    file, out, command = (shlex.quote(str(path)) for path in (wanted.sweep.resolve(), folder.resolve(), program()))
    return f"""#!/usr/bin/env bash
#SBATCH --job-name={shlex.quote(wanted.sweep.stem)}
#SBATCH --array=0-{count - 1}
#SBATCH --ntasks={jobs * ranks}
#SBATCH --cpus-per-task=1
#SBATCH --nodes=1
#SBATCH --time=24:00:00
#SBATCH --signal=B:USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append
# Made by thalweg sweep --slurm. Afterwards, for the tables: thalweg sweep {file} --out {out} --tables
{command} sweep {file} --out {out} --task "$SLURM_ARRAY_TASK_ID" --jobs {jobs}{" --retry" if wanted.retry else ""} &
sweep=$! status=0 ending=
trap 'ending=1; kill -TERM $sweep' USR1   # the time is nearly up
wait $sweep || status=$?
if [[ -n $ending ]]; then
  status=0
  wait $sweep || status=$?
  ((status != {STOPPED})) || exec scontrol requeue "$SLURM_JOB_ID"
fi
exit $status
"""


def sweep(wanted):
    """Exit code 0: all done; 1: some runs have failed; 3: stopped in good order, as thalweg run says; 2 comes with a
    SweepError."""
    plan = read_plan(wanted.sweep)
    folder = wanted.out or wanted.sweep.with_suffix("")
    if folder.exists() and not folder.is_dir():
        raise SweepError(f"{folder}, for runs and tables, is not a folder; give another one as --out.")
    if wanted.jobs is not None and wanted.jobs < 1:
        raise SweepError(f"--jobs {wanted.jobs}: give at least one run at a time.")
    refuse_same_names(plan, wanted.sweep)
    tasks = tasks_of(plan, folder)
    if wanted.slurm:
        print(slurm_job(wanted, len(tasks), plan.ranks, folder), end="")
        return 0
    if wanted.dry_run:
        list_tasks(plan, tasks)
        return 0
    if wanted.tables:
        return written(plan, tasks, units_of(plan), folder)
    if wanted.task is not None:
        if not 0 <= wanted.task < len(tasks):
            raise SweepError(f"--task {wanted.task}: the sweep has tasks 0 to {len(tasks) - 1}.")
        tasks = [tasks[wanted.task]]
    units, checks = units_of(plan), Checks(plan.case)
    refuse_impossible(plan, tasks, checks)
    jobs = wanted.jobs or runs_at_a_time(plan.ranks, most_memory(tasks, checks))
    runner = Runner(plan, tasks, units, program(), folder, jobs, wanted.retry, wanted.task is None)
    finished = runner.work()
    code = written(plan, tasks, units, folder) if wanted.task is None else 0
    if not finished:
        print("stopped; the same command resumes the sweep")
        return STOPPED
    return code or int(any(run.state == FAILED for task in tasks for run in task.runs))


def written(plan, tasks, units, folder):
    runs = known_runs(tasks)
    files = write_tables(plan, tasks, units, folder)
    for line in lines_of((run.name, run.warnings) for run in runs):
        print(line)
    print(f"written {', '.join(str(file) for file in files)}")
    versions = sorted({run.version for run in runs if run.state == DONE})
    if len(versions) > 1:
        print(
            (
                "thalweg: the runs were made by several versions of the program (column version of runs.csv):"
                f" {', '.join(versions)}."
            ), file=sys.stderr,
        )
    done = [run.summary for run in runs if run.state == DONE]
    for column in plan.columns:
        if done and all(figure_of(summary, column) is None for summary in done):
            there = meant_by(done[0], column)
            print(f"thalweg: columns: no run has the number {column} in its summary.json{there and f', {there}'}.",
                  file=sys.stderr)
    failed = [run for run in runs if run.state == FAILED]
    if failed:
        print(
            (
                f"thalweg: {len(failed)} of the runs have failed (column failure of runs.csv; --retry runs those again"
                " that have not ended)."
            ), file=sys.stderr,
        )
    return 1 if failed else 0
