"""One run of a sweep: its folder, what is known of it, and its process.

runs/NAME        the run folder
runs/NAME.json   what the run sets, and why it failed
runs/NAME.txt    what the program said; locked while the run is going and until its sweep has seen how it ended
"""
import ctypes
import fcntl
import functools
import hashlib
import json
import os
import shlex
import signal
import subprocess
from pathlib import Path

from thalweg.case_file import setting_of
from thalweg.history import sessions_of, warnings_of
from thalweg.sweep.inputs import SweepError, inputs_of, state_of
from thalweg.tables import replace_text

LONGEST_NAME = (
    150  # bytes: of the 255 that file systems allow, the rest is for the endings of the files beside the run folder
)
WAITING, DONE, FAILED, BEGUN = "waiting", "done", "failed", "begun"
STOPPED = (3, 4)   # exit codes of thalweg run: by a signal or the wall time, and by thalweg stop


class SweepRun:
    """kept: names of the runs that the folder has, by their inputs (names_in); a run with the same goes by that
    name."""

    def __init__(self, folder, name, plan, settings, kept=None):
        self.settings, self.plan, self.case, self.ranks = settings, plan, plan.case, plan.ranks
        self.inputs = inputs_of(plan.case, settings)
        self.name = name = (kept or {}).get(text_of(self.inputs), name)
        self.folder, self.note, self.output = folder / name, folder / f"{name}.json", folder / f"{name}.txt"
        self.summary, self.failure, self.lock = None, None, None
        self.look()

    def look(self):
        """Reads what the folder knows; a run that began from something else is not taken for this one, and one that has
        ended without the figure of a bisection has failed."""
        known = self.read_note()
        self.failure = known.pop("failure", None)
        if known != self.inputs and not self.folder.exists():   # it was refused, or stopped before it began
            known, self.failure = {}, None
        if known and known != self.inputs:
            raise SweepError(
                f"{self.folder} was run with other settings, or the case has changed since, or a file that it names; "
                f"give another --out, or remove that folder and {self.note.name} beside it."
            )
        self.summary = self.read_summary()
        if self.finished and not self.failure:
            self.failure = self.plan.lacks(self.summary)

    def read_note(self):
        try:
            return json.loads(self.note.read_text(encoding="utf-8"))
        except FileNotFoundError:
            if self.folder.exists():
                raise SweepError(
                    f"{self.note}, which says what {self.folder} was run with, is missing; give another --out, or "
                    "remove that folder."
                ) from None
            return {}
        except ValueError:
            raise SweepError(
                f"{self.note}, which says what {self.folder} was run with, is damaged; give another --out, or remove "
                "both."
            ) from None

    def read_summary(self):
        """None also where a crash of the machine has left half of it: the run then goes on from its checkpoint."""
        try:
            return json.loads((self.folder / "summary.json").read_text(encoding="utf-8-sig"))
        except (FileNotFoundError, ValueError):
            return None

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
    def is_open(self):
        return not self.failure and not self.finished   # which asks no file system, as `state` does

    @property
    def wall_seconds(self):
        return float(self.summary["wall_seconds"]) if self.summary else None

    @property
    def version(self):
        """Of the program, as `thalweg --version` says."""
        return str(self.summary["version"]) if self.summary else ""

    @property
    def warnings(self):
        """What the run has warned of in all its sessions, each once."""
        log = self.folder / "run.log"
        return warnings_in(self.folder, state_of(log) if log.exists() else None)

    def command(self, program):
        arguments = ["run", str(self.case), f"--out={self.folder}", "--resume"] + set_options(self.settings)
        return (launcher() + ["-n", str(self.ranks)] if self.ranks > 1 else []) + [program] + arguments

    def start(self, program):
        """The process of the run, which saves its state and stops at SIGUSR1 and when the sweep is killed; None while
        another sweep has it, or if one has ended it. SweepError if the case, or a file it names, has been changed since
        the sweep began. Once the process has ended, to be followed by release()."""
        if inputs_of(self.case, self.settings) != self.inputs:
            raise SweepError(
                f"{self.case}, or a file that it names, has been changed since this sweep began, which has results of "
                "the old one. Change it back and repeat the command, or give another --out."
            )
        self.folder.parent.mkdir(parents=True, exist_ok=True)
        # Several runs beside each other must not all be bound to the first core.
        environment = os.environ | {
            "OMPI_MCA_hwloc_base_binding_policy": "none", "PRTE_MCA_hwloc_default_binding_policy": "none",
        }
        self.lock = open(self.output, "a", encoding="utf-8")   # kept by the process as well, which inherits the file
        free = locked(self.lock)
        self.look()   # another sweep may have finished it
        if not free or not self.is_open:
            self.release()
            return None
        self.lock.truncate(0)
        self.remember(None)
        return subprocess.Popen(self.command(program), stdout=self.lock, stderr=subprocess.STDOUT, env=environment,
                                stdin=subprocess.DEVNULL, start_new_session=True, preexec_fn=die_with_parent)

    def release(self):
        """Lets other sweeps have the run."""
        if self.lock:
            self.lock.close()
            self.lock = None

    def ended(self, exit_code):
        """To be called when the process has ended."""
        if exit_code not in (0, *STOPPED):
            how = f"ended with exit code {exit_code}" if exit_code > 0 else f"was ended by signal {-exit_code}"
            self.remember(complaint_in(self.output) or f"the program {how}; see {self.output}")
        self.look()

    def remember(self, failure):
        self.failure = failure
        replace_text(self.note, json.dumps(self.inputs | {"failure": failure}, indent=1) + "\n")


@functools.lru_cache(maxsize=None)
def warnings_in(folder, _state):
    """Of a run, read again where its log has changed."""
    return warnings_of(sessions_of(folder))


def launcher():
    given = os.environ.get("THALWEG_LAUNCH") or "mpirun"
    try:
        return shlex.split(given)
    except ValueError:
        raise SweepError(f"THALWEG_LAUNCH={given}: there is a quote without its other one.") from None


def check_command(program, case, settings):
    return [program, "check", "--json", str(case)] + set_options(settings)


def set_options(settings):
    return [word for key, value in settings.items() for word in ("--set", f"{key}={setting_of(value)}")]


def names_in(folder):
    """The names of the runs that a folder has, by their inputs as text."""
    names = {}
    for note in sorted(folder.glob("*.json")):
        try:
            inputs = json.loads(note.read_text(encoding="utf-8"))
            inputs.pop("failure", None)
        except (OSError, ValueError, AttributeError):
            continue   # its own run says what is wrong with it
        names[text_of(inputs)] = note.stem
    return names


def text_of(inputs):
    return json.dumps(inputs, sort_keys=True)


def locked(file):
    """False if another process has the lock; True also on file systems that know none, where the run folder has its
    own."""
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        pass
    return True


def die_with_parent():
    """Linux only: the calling process gets SIGTERM when its parent ends, however that happens."""
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def complaint_in(path):
    """What the program complained of, one sentence; None if it did not."""
    lines = [line for line in Path(path).read_text(encoding="utf-8", errors="replace").splitlines()
             if line.startswith("thalweg: ")]
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
    """The name of the run that sets these keys, in their order: slope_0.05-seed_1. A long one is cut off, and a digest
    tells it from others that begin alike."""
    short = short_keys(keys)
    parts = []
    for key in keys:
        value = settings.get(key)
        text = str(value) if isinstance(value, (int, float, str)) else json.dumps(value)
        parts.append(f"{short[key]}_{''.join(c if c.isalnum() or c in '.+-' else '_' for c in text)}")
    name = "-".join(parts) or "run"
    encoded = name.encode()
    if len(encoded) <= LONGEST_NAME:
        return name
    digest = hashlib.sha256(encoded).hexdigest()[:12]
    return f"{encoded[:LONGEST_NAME - len(digest) - 1].decode(errors='ignore')}-{digest}"
