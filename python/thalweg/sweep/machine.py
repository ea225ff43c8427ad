"""How many runs fit on this machine at a time. What there is comes from the program that has started this one, which
knows the scheduler's set of cores and the limits of container and job (driver/cli/python_command.cpp)."""
import json
import os

from thalweg.sweep.inputs import SweepError


def told(name):
    try:
        return float(os.environ[name])
    except (KeyError, ValueError):
        raise SweepError(
            f"{name} does not say what this machine has; start this as `thalweg sweep`, or give --jobs."
        ) from None


def cores():
    """That this process may use."""
    return len(os.sched_getaffinity(0))


def memory_needed(report):
    """By what `thalweg check --json` has printed, bytes; 0 if it does not say."""
    try:
        return float(json.loads(report)["figures"]["memory"])
    except (ValueError, KeyError, TypeError):
        return 0.0


def runs_at_a_time(ranks, needed):
    """ranks: of a run; needed: the memory of the largest, bytes. Says so where the memory is what allows fewer than the
    cores do."""
    by_cores = max(1, int(told("THALWEG_CORES")) // ranks)
    there = told("THALWEG_MEMORY")
    by_memory = max(1, int(there // needed)) if needed > 0.0 else by_cores
    if by_memory < by_cores:
        print(
            (
                f"{by_memory} run{'s' if by_memory > 1 else ''} at a time, though there are cores for {by_cores}: a run"
                f" takes up to {needed / 1e9:.3g} GB of memory, and {there / 1e9:.3g} GB are free (--jobs overrides"
                " this)"
            ), flush=True,
        )
    return min(by_cores, by_memory)
