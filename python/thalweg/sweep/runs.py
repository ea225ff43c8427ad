"""One run of a sweep: its folder, what is known of it, and its process.

runs/NAME        the run folder
runs/NAME.json   what the run sets, and why it failed
runs/NAME.txt    what the program said; locked while the run is going
"""
import ctypes
import fcntl
import json
import os
import signal
import socket
import subprocess
from pathlib import Path

from thalweg.sweep.inputs import SweepError, inputs_of

WAITING, DONE, FAILED, BEGUN = "waiting", "done", "failed", "begun"
STOPPED = 3   # exit code of thalweg run


class SweepRun:
    def __init__(self, folder, name, plan, settings):
        self.folder, self.name, self.settings = folder / name, name, settings
        self.plan, self.case, self.ranks = plan, plan.case, plan.ranks
        self.inputs = inputs_of(plan.case, settings)
        self.note, self.output = folder / f"{name}.json", folder / f"{name}.txt"
        self.summary, self.failure = None, None
        self.look()

    def look(self):
        """Reads what the folder knows; a run that began from something else is not taken for this one, and one that has ended
        without the figure of a bisection has failed."""
        known = json.loads(self.note.read_text()) if self.note.exists() else {}
        self.failure = known.pop("failure", None)
        if known and known != self.inputs:
            raise SweepError(f"{self.folder} was run with other settings, or the case has changed since, or a file that it names; "
                             f"give another --out, or remove that folder and {self.note.name} beside it.")
        path = self.folder / "summary.json"
        self.summary = json.loads(path.read_text()) if path.exists() else None
        if self.finished and not self.failure:
            self.failure = self.plan.lacks(self.summary)

    @property
    def finished(self):
        return bool(self.summary and self.summary.get("finished"))

    @property
    def state(self):
        if self.failure:
            return FAILED
        if self.finished:
            return DONE
        return BEGUN if self.folder.exists() else WAITING

    @property
    def wall_seconds(self):
        return float(self.summary["wall_seconds"]) if self.summary else None

    @property
    def version(self):
        """Of the program, as `thalweg --version` says."""
        return str(self.summary["version"]) if self.summary else ""

    def command(self, program):
        arguments = ["run", str(self.case), "--out", str(self.folder)]
        arguments += ["--restart", str(self.folder)] if self.has_checkpoint() else ["--overwrite"]
        arguments += self.set_options()
        launcher = ["mpirun", "-n", str(self.ranks)] if self.ranks > 1 else []
        return launcher + [program] + arguments

    def check_command(self, program):
        return [program, "check", str(self.case)] + self.set_options()

    def set_options(self):
        return [word for key, value in self.settings.items() for word in ("--set", f"{key}={json.dumps(value)}")]

    def has_checkpoint(self):
        return (self.folder / "checkpoints" / "latest").exists()

    def start(self, program):
        """The process of the run, which saves its state and stops at SIGUSR1 and when the sweep is killed; None while
        another sweep has it. SweepError if the case, or a file it names, has been changed since the sweep began."""
        if inputs_of(self.case, self.settings) != self.inputs:
            raise SweepError(f"{self.case}, or a file that it names, has been changed since this sweep began, which has results of "
                             "the old one. Change it back and start the same command again, or give another --out.")
        self.folder.parent.mkdir(parents=True, exist_ok=True)
        # Several runs beside each other must not all be bound to the first core.
        environment = os.environ | {"OMPI_MCA_hwloc_base_binding_policy": "none"}
        with open(self.output, "a") as output:
            try:
                fcntl.flock(output, fcntl.LOCK_EX | fcntl.LOCK_NB)   # kept by the process, which inherits the file
            except BlockingIOError:
                return None
            output.truncate(0)
            self.remember(None)
            return subprocess.Popen(self.command(program), stdout=output, stderr=subprocess.STDOUT, env=environment,
                                    stdin=subprocess.DEVNULL, start_new_session=True, preexec_fn=die_with_parent)

    def ended(self, exit_code):
        """To be called when the process has ended."""
        if exit_code not in (0, STOPPED):
            self.remember(complaint_in(self.output) or f"the program ended with exit code {exit_code}; see {self.output}")
        self.look()

    def remember(self, failure):
        self.failure = failure
        replace_text(self.note, json.dumps(self.inputs | {"failure": failure}, indent=1) + "\n")


def replace_text(path, text):
    """Writes a file at once: whoever reads it meanwhile sees the old one or the new one."""
    temporary = path.with_name(f"{path.stem}.{socket.gethostname()}.{os.getpid()}.partial")
    temporary.write_text(text)
    temporary.replace(path)


def die_with_parent():
    """Linux only: the calling process gets SIGTERM when its parent ends, however that happens."""
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def complaint_in(path):
    """What the program complained of, one sentence; None if it did not."""
    lines = [line for line in Path(path).read_text(errors="replace").splitlines() if line.startswith("thalweg: ")]
    return lines[-1].removeprefix("thalweg: ") if lines else None


def short_keys(keys):
    """Each key by as many of its last words as tell it from the others."""
    short = {}
    for key in keys:
        words = key.split(".")
        for count in range(1, len(words) + 1):
            short[key] = ".".join(words[-count:])
            if sum(other == short[key] or other.endswith("." + short[key]) for other in keys) == 1:
                break
    return short


def name_of(settings, keys):
    """The name of the run that sets these keys, in their order: slope_0.05-seed_1."""
    short = short_keys(keys)
    parts = []
    for key in keys:
        value = settings.get(key)
        text = str(value) if isinstance(value, (int, float, str)) else json.dumps(value)
        parts.append(f"{short[key]}_{''.join(c if c.isalnum() or c in '.+-' else '_' for c in text)}")
    return "-".join(parts) or "run"
