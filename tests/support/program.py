"""What every test of the whole program needs: a folder of its own, a case in it, and ways to run and to be refused.

A test script is called THE_SCRIPT THALWEG MPIEXEC [unittest arguments]; it ends with program.main(). Behind its import
of this module it finds Thalweg's Python package.
"""
import csv
import io
import json
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))

THALWEG, MPIEXEC = sys.argv[1:3]


# Sixty dry grains that slide down a steep floor; `run` and `output` are to follow.
SLIDING_GRAINS = """
system: grains
name: sliding
domain:
  size: [0.05, 0.03, 0.05]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: no_slip, bottom: no_slip, top: free_slip}
gravity: {magnitude: 9.8, slope: 0.3}
grains: [{count: 60, diameter: 5.0e-3, density: 2550, placement: {pattern: random, seed: 3}}]
contact: {normal_stiffness: 2000, tangential_stiffness: 571, restitution: 0.7, friction: 0.3, wall_friction: 0.3}
"""

# 40 grains tumbling down a bumpy slope: contacts, walls, periodic sides and, on several ranks, migration.
TUMBLING_GRAINS = """
system: grains
name: tumbling grains
domain:
  size: [0.040, 0.020, 0.040]     # m
  spacing: 1.0e-3                 # m
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}
gravity: {magnitude: 9.8, slope: 0.5}
grains:
  - {count: 40, diameter: 5.0e-3, density: 2550, placement: {pattern: random, seed: 3}}
contact: {normal_stiffness: 20000, tangential_stiffness: 5714, restitution: 0.8, friction: 0.5}
run: {until: 0.1, time_step: 4.0e-6}
output:
  series: {every: 2.0e-3}
  grains: {every: 0.02}
  checkpoint: {every: 0.04, keep: 2}
analysis:
  transport_rate: {from: 0.05}
"""


def files_below(folder):
    return sorted(str(p.relative_to(folder)) for p in Path(folder).rglob("*"))


def contents_below(folder):
    """The contents of all files, by path, but for locks."""
    return {path: path.read_bytes() for path in Path(folder).rglob("*") if path.is_file() and path.name != ".lock"}


class ProgramTest(unittest.TestCase):
    CASE = ""   # text of case.yaml; subclasses give theirs
    TIMEOUT = 120   # s, of one run

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        self.case = self.folder / "case.yaml"
        self.case.write_text(self.CASE)

    def command(self, arguments, ranks):
        parallel = [MPIEXEC, "-n", str(ranks)] if ranks else []
        return parallel + [THALWEG] + [str(a) for a in arguments]

    def thalweg(self, *arguments, ranks=0):
        return subprocess.run(self.command(arguments, ranks), capture_output=True, text=True, errors="surrogateescape",
                              timeout=self.TIMEOUT, cwd=self.folder)

    def run_well(self, *arguments, ranks=0):
        result = self.thalweg(*arguments, ranks=ranks)
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        return result

    def processes(self):
        """Ids of the processes of the program that work in the folder of the test. mpirun puts its ranks into groups of
        their own, and they outlive it for a moment."""
        found = []
        for entry in Path("/proc").glob("[0-9]*"):
            try:
                if (
                    entry.joinpath("cwd").resolve() == self.folder
                    and entry.joinpath("exe").resolve() == Path(THALWEG).resolve()
                ):
                    found.append(int(entry.name))
            except OSError:   # it has ended
                pass
        return found

    def summary(self, run):
        return json.loads((self.folder / run / "summary.json").read_text())

    def bed(self, run="run"):
        """The columns of bed.h5 by name, in the order of ids."""
        with h5py.File(self.folder / run / "bed.h5") as file:
            return {name: data[()] for name, data in file["grains"].items()}

    def assert_same_bed(self, one, other):
        """The grains of both runs end with the same bits."""
        a, b = self.bed(one), self.bed(other)
        self.assertEqual(list(a), list(b))
        for name in a:
            self.assertEqual(a[name].tobytes(), b[name].tobytes(), f"{name} of {one} and {other}")

    def series(self, run="run"):
        """The columns of series.csv by name, without units."""
        with open(self.folder / run / "series.csv", newline="") as file:
            header, *rows = csv.reader(file)
        columns = numpy.array([[float(value) for value in row] for row in rows]).T
        return {name.split()[0].split("[")[0]: column for name, column in zip(header, columns)}

    def last_checkpoint(self, run):
        checkpoints = self.folder / run / "checkpoints"
        return checkpoints / (checkpoints / "latest").read_text().strip()

    def assert_same_end(self, run, other, *files):
        """The last checkpoints of both runs have the same bytes, and so have these files of theirs."""
        for one, two in ((self.last_checkpoint(run), self.last_checkpoint(other)),
                         *((self.folder / run / file, self.folder / other / file) for file in files)):
            self.assertTrue(one.read_bytes() == two.read_bytes(), f"{one} and {two} differ")

    def assert_same_state(self, watched, alone):
        """All that the last checkpoint of `alone` holds of grains and fluid has the same bits in that of `watched`."""
        names = []
        with h5py.File(self.last_checkpoint(watched)) as a, h5py.File(self.last_checkpoint(alone)) as b:
            b.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
            self.assertTrue(any("position" in name for name in names) and any("populations" in name for name in names))
            for name in names:
                self.assertEqual(a[name][()].tobytes(), b[name][()].tobytes(), name)

    def assert_refused(self, *arguments, words, ranks=0):
        """Exit code 2, one sentence with the words on standard error, nothing written anywhere."""
        before, contents = files_below(self.folder), contents_below(self.folder)
        result = self.thalweg(*arguments, ranks=ranks)
        self.assertEqual(result.returncode, 2, result.stderr + result.stdout)
        ours = [line for line in result.stderr.splitlines() if line.startswith("thalweg: ")]
        self.assertEqual(len(ours), 1, result.stderr)
        if not ranks:   # else mpirun adds its own words about the exit code
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
            self.assertEqual(result.stdout, "")
        self.assertNotIn("MPI_ABORT", result.stderr)
        for word in words:
            self.assertIn(word, ours[0])
        self.assertEqual(files_below(self.folder), before)
        self.assertEqual(contents_below(self.folder), contents)


class SideBySide:
    """Runner of unittest.main() that runs four tests at a time: for tests that mostly wait. Not for long runs on
    several ranks, which are far slower where they share their cores."""
    def run(self, suite):
        def flat(tests):
            return [one for test in tests for one in (flat(test) if isinstance(test, unittest.TestSuite) else [test])]

        def run_alone(test):
            said = io.StringIO()
            return unittest.TextTestRunner(said, verbosity=2).run(test), said.getvalue()

        every = unittest.TestResult()
        with ThreadPoolExecutor(4) as pool:
            for result, said in pool.map(run_alone, flat(suite)):
                sys.stderr.write(said)
                every.testsRun += result.testsRun
                every.failures += result.failures
                every.errors += result.errors
                every.skipped += result.skipped
                every.unexpectedSuccesses += result.unexpectedSuccesses
        return every


def main(side_by_side=False):
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2, testRunner=SideBySide() if side_by_side else None)
