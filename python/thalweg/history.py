"""What run.log tells of a run: its sessions, from one start to the next, with their changes and warnings."""
import math
import re
import shlex
from dataclasses import dataclass, field

from thalweg.errors import RunFolderError

HEAD = re.compile(r"Thalweg (\S+ \(.*?\)|\S+): ")
AT = re.compile(r" at (\S+) \S+$")   # the time in Session.origin
AVERAGED = re.compile(r"^analysis\.(\S+): averaging starts at (\S+) \S+$")
IN_PASSING = re.compile(r"^t (\S+).*?  warning: (.*)$")   # of a progress line


@dataclass
class Session:
    """A run from a start, or a restart, to its end."""
    version: str
    shape: str = ""                 # system, ranks, grains, cells, steps
    origin: str = ""                # the checkpoint it went on from, and when
    changes: list = field(default_factory=list)    # of the case since the session before
    warnings: list = field(default_factory=list)
    remarks: list = field(default_factory=list)    # at its end
    averaged_from: dict = field(default_factory=dict)   # s, by observer: of means that a restart has begun anew
    outcome: str = ""               # empty: it was killed or has failed, or it is still going


def sessions_of(folder):
    """Of run.log, which keeps all sessions of a folder; empty where there is none."""
    path = folder / "run.log"
    if not path.exists():
        return []
    sessions, shape_is_next = [], False
    for line in path.read_text(encoding="utf-8-sig", errors="replace").splitlines():
        head = HEAD.match(line)
        if head:
            sessions.append(Session(head[1]))
        elif sessions:
            if shape_is_next:
                sessions[-1].shape = line
            else:
                take(line, sessions[-1])
        shape_is_next = bool(head)
    return sessions


def take(line, session):
    """A line of a session."""
    passing = IN_PASSING.match(line)
    for start, words in (("resuming from ", "origin"), ("finished", "outcome"), ("not finished", "outcome")):
        if line.startswith(start):
            setattr(session, words, line.removeprefix(start) if words == "origin" else line)
    anew = AVERAGED.match(line)
    if anew:
        session.averaged_from[anew[1]] = float(anew[2])
    elif line.startswith("changed since then: "):
        session.changes.append(line.removeprefix("changed since then: "))
    elif line.startswith("warning: "):
        session.warnings.append(line.removeprefix("warning: "))
    elif passing:
        session.warnings.append(f"{passing[2]} (at {passing[1]} s)")
    elif line.startswith(("no bed at the end", "not at rest")):
        session.remarks.append(line)


def last_change(sessions, keys):
    """Time (s) of the last restart that changed one of the keys, or a key that begins with it; -inf where none did.
    What a later restart has left behind does not count."""
    changed = []
    for session in sessions:
        begun = AT.search(session.origin)
        begun = float(begun[1]) if begun else -math.inf
        changed = [time for time in changed if time < begun]
        if any(change.startswith(tuple(keys)) for change in session.changes):
            changed.append(begun)
    return changed[-1] if changed else -math.inf


def other_case_before(sessions):
    """Whether a restart changed more of the case than what is written and how long the run goes on."""
    free = ("run.until", "output.", "name")
    return any(not change.startswith(free) for session in sessions for change in session.changes)


def warnings_of(sessions):
    """All warnings in their order, each once."""
    return list(dict.fromkeys(warning for session in sessions for warning in session.warnings))


def command_of(run):
    """The command line of the last session, from the head of case.yaml; empty where it is not there."""
    with open(run.folder / "case.yaml", encoding="utf-8-sig") as file:
        for line in file:
            if line.startswith("# command "):
                return line.removeprefix("# command ").rstrip()
            if not line.startswith("#"):
                break
    return ""


def settings_in(command):
    """What a command line sets in the case: KEY=VALUE of --set, and --until."""
    try:
        words = shlex.split(command)
    except ValueError:
        raise RunFolderError(f"the command of case.yaml is damaged: {command}") from None
    found = []
    for word, following in zip(words, [*words[1:], ""]):
        if word in ("--set", "--until"):
            found.append(following if word == "--set" else f"run.until={following}")
        elif word.startswith(("--set=", "--until=")):
            found.append(
                word.removeprefix("--set=")
                if word.startswith("--set=")
                else f"run.until={word.removeprefix('--until=')}"
            )
    return found
