#!/usr/bin/env python3
"""A run on two ranks that is killed again and again, and goes on each time on other ranks, to the same bits.

Called by ctest: kill_run_test.py THALWEG MPIEXEC NUMBER_OF_KILLS [SEED]. SIGKILL to mpirun and its ranks at once, as
when a node fails: every fourth time at a random moment, else within the writing of a checkpoint, of a part of the
records or of a frame, as soon as its unfinished file is seen and a random moment later. The run writes a checkpoint
every few steps, and whatever a run can write beside it; in the end every file must be that of a run that was never
killed.
"""
import os
import random
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

KILLS = int(sys.argv[3])
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 1
del sys.argv[3:]
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
import numpy
import thalweg
from program import ProgramTest


class Killed(ProgramTest):
    CASE = """
system: resolved
name: killed
domain:
  size: [0.024, 0.016, 0.024]
  spacing: 0.8e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, smagorinsky_constant: 0.27, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.05}
grains: [{count: 6, diameter: 4.8e-3, density: 2550, placement: {pattern: random, seed: 1}}]
contact: {restitution: 0.9}
coupling: {grain_steps_per_fluid_step: 20}
output:
  series: {every: 0.001}
  grains: {every: 0.002}
  fluid: {every: 0.004, fields: [velocity]}
  grain_parts: [{name: some, ids: [1, 2], every: 0.003}]
  fluid_parts: [{name: bottom, plane: {axis: z, at: 0.001}, fields: [pressure], every: 0.003}]
  checkpoint: {every: 0.002, keep: 2}
analysis:
  transport_rate: {}
  fluid_statistics: {every: 1.0e-3}
  tracks: {grains: [0, 3], every: 2.0e-4}
  probes: {points: [[0.01, 0.01, 0.01]], every: 3.0e-4}
  entrainment: {grains: [0, 1, 2, 3, 4, 5], rest_time: 1.0e-4, displacement: 0.01, memory: 2.0e-3}
"""
    RANKS = (1, 4)   # that go on; the first part of the run has 2
    # What tells of the runs rather than of their results: times of day, commands, the earlier cases.
    OF_RUNS = ("run.log", "summary.json", "case.yaml", "case_until_step_*.yaml", ".lock")
    UNFINISHED = {"checkpoint": ("checkpoints",), "records": ("tracks", "probes", "entrainment"),
                  "frame": ("grains", "fluid", "grain_parts/some", "fluid_parts/bottom")}
    STEPS_A_KILL = 60    # so that the end is not there before the last kill
    TIMEOUT = 120 + 20 * KILLS

    def setUp(self):
        super().setUp()
        self.chance = random.Random(SEED)
        self.case.write_text(self.CASE + f"run: {{until: {self.STEPS_A_KILL * KILLS * 1e-4:.6g}}}\n")

    def kill(self, process, ranks):
        """ranks: those known so far; to look for them takes longer than to write a checkpoint."""
        for pid in ranks:
            self.kill_one(pid)
        os.killpg(process.pid, signal.SIGKILL)
        for _ in range(100):
            left = self.processes()
            if not left:
                break
            for pid in left:
                self.kill_one(pid)
            time.sleep(0.01)
        process.wait(timeout=30)

    @staticmethod
    def kill_one(pid):
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass

    def begin(self, ranks):
        return subprocess.Popen(
            self.command(("run", self.case, "--out", "run", "--resume"), ranks), cwd=self.folder,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True,
        )

    def wait_until(self, happened, process, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end and process.poll() is None:
            if happened():
                return True
            time.sleep(0.0005)
        return False

    def unfinished(self, kind):
        return [path for folder in self.UNFINISHED[kind] for path in (self.folder / "run" / folder).glob("*.partial")]

    def step(self):
        steps = [int(re.search(r"\d+", path.name)[0]) for path in (self.folder / "run/checkpoints").glob("step_*.h5")]
        return max(steps, default=0)

    def results_of(self, run):
        """Bytes of all files by their places in the folder."""
        paths = [path for path in (self.folder / run).rglob("*") if path.is_file()]
        return {str(path.relative_to(self.folder / run)): path.read_bytes() for path in paths
                if not any(path.match(pattern) for pattern in self.OF_RUNS)}

    def assert_same_results(self, run, other):
        found, expected = self.results_of(run), self.results_of(other)
        self.assertEqual(sorted(found), sorted(expected))
        self.assertEqual([name for name in found if found[name] != expected[name]], [])
        for kind in (
            "series.csv", "profiles.h5", "grains.pvd", "fluid.pvd", "grains/", "fluid/", "grain_parts/some/",
            "fluid_parts/bottom/", "tracks/part", "probes/part", "entrainment/part", "checkpoints/step", "bed.h5",
        ):
            self.assertTrue(any(name.startswith(kind) for name in found), kind)
        self.assertGreaterEqual(len(thalweg.Run(self.folder / run).entrainment), 3)

    def assert_same_rest(self, run, other, begin):
        """Of a run that went on in a folder of its own: what it recorded after that time."""
        for records in ("tracks", "probes"):
            found, expected = (getattr(thalweg.Run(self.folder / out), records) for out in (run, other))
            late = expected["time"] > begin + 1e-9
            for name in ("time", "velocity"):
                numpy.testing.assert_array_equal(found[name], expected[name][late], f"{run}: {records} {name}")

    def wait_for(self, kind, process, before):
        """Until a file of this kind is being written, by a run that has got on; returns the ranks."""
        self.wait_until(lambda: self.step() > before, process, 60)
        ranks = self.processes()
        self.wait_until(lambda: self.unfinished(kind), process, 60)   # it is there from its first byte to the last
        time.sleep(self.chance.uniform(0.0, 0.004 if kind == "checkpoint" else 0.001))
        return ranks

    def test_same_bits_after_any_kill(self):
        kills, within, goes_on = 0, dict.fromkeys(self.UNFINISHED, 0), 0
        for number in range(KILLS):
            before = self.step()
            process = self.begin(2 if number == 0 else self.chance.choice(self.RANKS))
            self.addCleanup(process.stderr.close)
            kind = (*self.UNFINISHED, None)[number % 4]
            ranks = []
            if kind:
                ranks = self.wait_for(kind, process, before)
            else:
                time.sleep(self.chance.uniform(0.0, 1.5))
            if process.poll() is not None:
                self.assertEqual(process.wait(), 0, process.stderr.read())   # the end was there sooner
                break
            self.kill(process, ranks)
            kills += 1
            for kind in within:
                within[kind] += bool(self.unfinished(kind))
            goes_on += self.step() > before
        print(f"{kills} kills, with unfinished files: {within}; {goes_on} after new checkpoints; at step {self.step()}")
        self.assertGreaterEqual(kills, 3 * KILLS // 4)   # the end was not there much sooner
        self.assertGreater(sum(within.values()), KILLS // 8)
        begin = self.step() * 1e-4
        for ranks in self.RANKS:   # also each of the ways to the end
            self.run_well("run", self.case, "--restart", "run", "--out", f"end_{ranks}", ranks=ranks)
        self.run_well("run", self.case, "--restart", "run")
        self.run_well("run", self.case, "--out", "straight", ranks=2)
        self.assert_same_results("run", "straight")
        for ranks in self.RANKS:
            self.assert_same_end(f"end_{ranks}", "straight")
            self.assert_same_rest(f"end_{ranks}", "straight", begin)

    def test_nothing_waits_for_what_a_killed_run_has_left_in_memory(self):
        # Open MPI's semaphores of the files that this run will write, taken: 32 bytes of glibc's sem_t with value 0.
        self.run_well("run", self.case, "--out", "whole", "--until", "0.004")
        names = {path.name for path in (self.folder / "whole").rglob("*.*") if path.suffix in (".vtp", ".vti", ".h5")}
        self.assertGreater(len(names), 5)
        for name in [f"{name}.partial" for name in names] + list(names):
            semaphore = Path("/dev/shm") / f"sem.OMPIO_{name}"
            if semaphore.exists():   # of a run that is writing now
                continue
            semaphore.write_bytes(bytes(32))
            self.addCleanup(semaphore.unlink, missing_ok=True)
        for ranks in (0, 2):
            self.run_well("run", self.case, "--out", f"run_{ranks}", "--until", "0.004", ranks=ranks)


if __name__ == "__main__":
    program.main()
