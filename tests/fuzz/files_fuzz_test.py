#!/usr/bin/env python3
"""Damaged files: cases, surfaces, beds, checkpoints, records and what else a restart reads.

Called by ctest: files_fuzz_test.py THALWEG MPIEXEC NUMBER [SEED]. Each of NUMBER damaged files (damage.py) is given to the
program, which must end within ten seconds of a core and a gigabyte: it refuses the file in one sentence with its name
(exit code 2), or ends well (0) with the results of the whole file. So nothing that a damaged file means is taken in
silence. The exceptions: a case in which a digit or a line is another is another case; a restart reads only what it goes
on with of the parts of a record; a bed without checksums may have grains so fast that the run breaks down (1).
"""
import random
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import damage
from damage import contents_of_hdf5

THALWEG, NUMBER = sys.argv[1], int(sys.argv[3])
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 1
SECONDS, LATE, BYTES = 10, 100, 1 << 30
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from stl_box import write_box

SMALL = """
system: resolved
name: damaged
domain:
  size: [0.012, 0.012, 0.016]
  spacing: 0.8e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.05}
GRAINS
contact: {restitution: 0.9, friction: 0.3}
run: {until: UNTIL}
output: {series: {every: 1.0e-4}, grains: {every: 2.0e-4}, checkpoint: {every: 2.0e-4, keep: 2}}
analysis: {tracks: {grains: [0, 1]}, probes: {points: [[0.006, 0.006, 0.012]]}, transport_rate: {from: 0.0}, bed_surface: {}}
MORE
"""
PLACED = "grains: [{count: 3, diameter: 4.0e-3, density: 2550, placement: {pattern: random, seed: 1}}]"
FROM_BED = "grains: [{placement: {file: bed.h5}}]"
SURFACE = """
system: fluid
domain: {size: [0.01, 0.01, 0.01], spacing: 1.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.05}
solids: [{stl: part.stl}]
run: {until: 1.0e-3}
"""


def small(grains=PLACED, until="4.0e-4", more=""):
    return SMALL.replace("GRAINS", grains).replace("UNTIL", until).replace("MORE", more)


class Answer:
    """Of the program, and what is wrong with it whatever it was given."""

    def __init__(self, *arguments):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.late = False
        try:
            done = subprocess.run(
                [THALWEG, *map(str, arguments)], capture_output=True, timeout=LATE, preexec_fn=limit_memory
            )
            self.code, self.out, self.err = (
                done.returncode, done.stdout.decode("utf-8", "replace"), done.stderr.decode("utf-8", "replace"),
            )
        except subprocess.TimeoutExpired:
            self.code, self.out, self.err, self.late = None, "", "", True
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.seconds = (
            after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        )  # of a core: others work here, too
        self.memory = after.ru_maxrss * 1024 if after.ru_maxrss > before.ru_maxrss else 0    # of the largest so far

    def complaint(self, name):
        if self.late or self.seconds > SECONDS:
            return f"took {self.seconds:.0f} s"
        if self.memory > BYTES:
            return f"took {self.memory / 1e9:.2f} GB"
        if self.code not in (0, 2):
            return f"exit code {self.code}: {self.err}"
        said = [line for line in self.err.splitlines() if line.startswith("thalweg: ")]
        if self.code == 2 and (len(said) != 1 or said[0][-1] not in ".?"):
            return f"not one sentence: {self.err}"
        if self.code == 2 and name not in said[0]:
            return f"does not name the file: {self.err}"
        return ""


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))


class Kind:
    """A kind of file: name, bytes and how they are damaged. try_with() gives the complaint about the program's
    answer."""

    def __init__(self, folder):
        self.folder = folder / type(self).__name__.lower()
        self.folder.mkdir()
        self.prepare()

    def write(self, name, data):
        path = self.folder / name
        path.write_bytes(data) if isinstance(data, bytes) else path.write_text(data, encoding="utf-8")
        return path


class CaseFile(Kind):
    name, ways = "case.yaml", damage.ANY + damage.YAML * 2
    INVISIBLE = (damage.byte_order_mark, damage.carriage_return, damage.odd_byte, damage.tab, damage.utf_16)

    def prepare(self):
        self.whole = small().encode()
        self.report = self.check(self.whole).out

    def check(self, data):
        return Answer("check", self.write(self.name, data))

    def try_with(self, data, way):
        answer = self.check(data)
        wrong = answer.complaint(self.name)
        if not wrong and answer.code == 0 and way in self.INVISIBLE and lasting(answer.out) != lasting(self.report):
            wrong = "another report"
        return wrong


def lasting(report):
    """Of a report: what is the same from time to time, without the title."""
    return [line for line in report.splitlines()[1:] if not line.startswith(("time ", "disk "))]


class Surface(Kind):
    name = "part.stl"

    def prepare(self):
        write_box(self.folder / self.name, (0.002, 0.003, 0.001), (0.008, 0.007, 0.006))
        self.whole = self.bytes_of((self.folder / self.name).read_text())
        self.write("case.yaml", SURFACE)

    def try_with(self, data, way):
        self.write(self.name, data)
        answer = Answer("check", self.folder / "case.yaml")
        if wrong := answer.complaint(self.name):
            return wrong
        return "another surface" if answer.code == 0 and self.corners(data) != self.corners(self.whole) else ""


class TextSurface(Surface):
    ways = damage.ANY + damage.TEXT

    def bytes_of(self, text):
        return text.encode()

    def corners(self, data):
        words = re.findall(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", data)
        return sorted(tuple(map(float, corner)) for corner in words)


class BinarySurface(Surface):
    ways = damage.ANY

    def bytes_of(self, text):
        corners = [
            float(word) for word in re.findall(r"(?<=\s)[-\d.e]+(?=\s)", " ".join(re.findall("vertex.*\n", text)))
        ]
        facets = [corners[n:n + 9] for n in range(0, len(corners), 9)]
        return (
            bytes(80)
            + struct.pack("<I", len(facets))
            + b"".join(struct.pack("<12fH", 0, 0, 0, *facet, 0) for facet in facets)
        )

    def corners(self, data):
        return sorted(data[84 + 50 * n + 12:84 + 50 * n + 48] for n in range((len(data) - 84) // 50))


class State(Kind):
    """A file from which a run begins. Its results are those of the last checkpoint."""
    ways = damage.ANY + damage.HDF5

    def run(self, *arguments):
        out = self.folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        answer = Answer("run", self.folder / "case.yaml", "--out", out, *arguments)
        states = sorted((out / "checkpoints").glob("step_*.h5"), key=lambda path: int(path.stem[5:]))
        return answer, contents_of_hdf5(states[-1].read_bytes()) if states else None

    def try_with(self, data, way):
        self.write(self.name, data)
        answer, results = self.run(*self.arguments())
        if way in (damage.odd_value, damage.odd_value_anew) and answer.code == 1 and "broke down" in answer.err:
            return ""   # a speed of 1e30 m/s is a number
        if wrong := answer.complaint(self.name):
            return wrong
        if answer.code == 2 or results == self.results:
            return ""
        state = {
            name: value for name, value in (results or {}).items() if name.startswith(("grains", "fluid", "system"))
        }
        said = "averaging starts at" in answer.out   # observers whose sums are lost
        if said and state and all(self.results[name] == value for name, value in state.items()):
            return ""
        return "other results: " + ", ".join(
            name for name in self.results if (results or {}).get(name) != self.results[name]
        )

    def arguments(self):
        return []

    def first_run(self):
        """The whole files of a run of four steps."""
        self.write("case.yaml", small())
        answer = Answer("run", self.folder / "case.yaml", "--out", self.folder / "first")
        assert answer.code == 0, answer.err
        return self.folder / "first"


class Bed(State):
    name = "bed.h5"

    def prepare(self):
        self.whole = (self.first_run() / "bed.h5").read_bytes()
        self.write("case.yaml", small(FROM_BED))
        self.write(self.name, self.whole)
        answer, self.results = self.run()
        assert self.results, answer.err


class Checkpoint(State):
    name = "state.h5"

    def prepare(self):
        self.whole = (self.first_run() / "checkpoints" / "step_2.h5").read_bytes()
        self.write(self.name, self.whole)
        answer, self.results = self.run("--restart", self.folder / self.name)
        assert self.results, answer.err

    def arguments(self):
        return ["--restart", self.folder / self.name]


class InitialState(State):
    name = "state.h5"

    def prepare(self):
        self.whole = (self.first_run() / "checkpoints" / "step_4.h5").read_bytes()
        self.write("case.yaml", small(more="initial: {from: state.h5}"))
        self.write(self.name, self.whole)
        answer, self.results = self.run()
        assert self.results, answer.err


class RunFile(Kind):
    """A file of a run folder that a restart goes on with."""
    ways = damage.ANY

    def prepare(self):
        self.case = self.write("case.yaml", small())
        answer = Answer("run", self.case, "--out", self.folder / "first")
        assert answer.code == 0, answer.err
        self.files = [
            path.relative_to(self.folder / "first")
            for path in (self.folder / "first").rglob("*")
            if path.is_file()
            and path.suffix in (".csv", ".pvd", ".json", ".yaml")
            or path.name in ("latest", "run.log")
            or path.suffix == ".h5"
            and path.name != "bed.h5"
            and path.parent.name != "checkpoints"
        ]
        self.chance = random.Random(SEED)

    @property
    def whole(self):
        self.file = self.chance.choice(sorted(self.files))
        self.name = self.file.name
        return (self.folder / "first" / self.file).read_bytes()

    def try_with(self, data, way):
        out = self.folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(self.folder / "first", out)
        (out / self.file).write_bytes(data)
        answer = Answer("run", self.case, "--out", out, "--restart", out, "--until", "6.0e-4")
        # Another case beside the state is named by its keys; without case.yaml it is no run folder.
        wrong = answer.complaint("" if self.name == "case.yaml" else self.name)
        if not wrong and self.name in ("summary.json", "case.yaml", "run.log"):
            info = Answer("info", out)
            wrong = info.complaint("") and f"info: {info.complaint('')}"
        return wrong


def main():
    chance, failures = random.Random(SEED), []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        kinds = [
            kind(folder) for kind in (CaseFile, TextSurface, BinarySurface, Bed, Checkpoint, InitialState, RunFile)
        ]
        answers = 0
        for number in range(NUMBER):
            kind = kinds[number % len(kinds)]
            way = chance.choice(kind.ways)
            whole = kind.whole
            data = way(whole, chance)
            if data == whole:
                continue
            wrong = kind.try_with(data, way)
            answers += 1
            if wrong:
                failures.append(f"{number}: {type(kind).__name__} {kind.name}, {way.__name__}: {wrong}")
                print(failures[-1], flush=True)
    print(f"{answers} damaged files, seed {SEED}: {len(failures)} failures")
    return 1 if failures or answers < 0.9 * NUMBER else 0


if __name__ == "__main__":
    sys.exit(main())
