#!/usr/bin/env python3
"""A run on two ranks that is killed again and again, and goes on each time on other ranks, to the same bits.

Called by ctest: kill_run_test.py THALWEG MPIEXEC NUMBER_OF_KILLS [SEED]. SIGKILL to mpirun and its ranks at once, as when a
node fails: every second time at a random moment, else within the writing of a checkpoint, as soon as its unfinished file
is seen and a random moment later. The run writes a checkpoint every few steps, and series, frames and tracks beside it.
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
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
import program
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
  checkpoint: {every: 0.001, keep: 2}
analysis: {transport_rate: {}, tracks: {grains: [0, 3], every: 2.0e-4}}
"""
    RANKS = (1, 2, 4)
    STEPS_A_KILL = 120    # so that the end is not there before the last kill

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
        return subprocess.Popen(self.command(("run", self.case, "--out", "run", "--resume"), ranks), cwd=self.folder, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True, start_new_session=True)

    def wait_until(self, happened, process, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end and process.poll() is None:
            if happened():
                return True
            time.sleep(0.0005)
        return False

    def unfinished(self):
        return list((self.folder / "run/checkpoints").glob("*.partial"))

    def step(self):
        steps = [int(re.search(r"\d+", path.name)[0]) for path in (self.folder / "run/checkpoints").glob("step_*.h5")]
        return max(steps, default=0)

    def assert_same_pictures(self, run, other):
        """The same frames at the same times, and no frame that only one has."""
        for pattern in ("*.pvd", "grains/*", "fluid/*"):
            found = [{path.name: path.read_bytes() for path in (self.folder / out).glob(pattern)} for out in (run, other)]
            self.assertEqual(list(found[0]), list(found[1]))
            self.assertTrue(found[0] and found[0] == found[1], pattern)

    def assert_same_tracks(self, run, other):
        """Of a file that a kill has damaged the rows before the restart are in the one that was set aside."""
        found, expected = (thalweg.Run(self.folder / out).tracks for out in (run, other))
        rows = len(found["time"])
        if not list((self.folder / run).glob("tracks.damaged_*.h5")):
            self.assertEqual(rows, len(expected["time"]))
        for name in ("time", "position", "velocity"):
            self.assertEqual(found[name].tobytes(), expected[name][len(expected["time"]) - rows:].tobytes(), name)

    def test_same_bits_after_any_kill(self):
        kills, within, goes_on = 0, 0, 0
        for number in range(KILLS):
            before = self.step()
            process = self.begin(self.chance.choice(self.RANKS))
            self.addCleanup(process.stderr.close)
            ranks = []
            if number % 2 == 0:   # within a checkpoint: its file is there from its first byte to the last
                self.wait_until(lambda: self.step() > before, process, 60)   # the run gets on
                ranks = self.processes()
                self.wait_until(self.unfinished, process, 60)
                time.sleep(self.chance.uniform(0.0, 0.004))
            else:
                time.sleep(self.chance.uniform(0.0, 1.5))
            if process.poll() is not None:
                self.assertEqual(process.wait(), 0, process.stderr.read())   # the end was there sooner
                break
            self.kill(process, ranks)
            kills += 1
            within += bool(self.unfinished())
            goes_on += self.step() > before
        print(f"{kills} kills, {within} with an unfinished file, {goes_on} after new checkpoints; at step {self.step()}")
        self.assertGreaterEqual(kills, 3 * KILLS // 4)   # the end was not there much sooner
        self.assertGreater(within, KILLS // 8)
        for ranks in self.RANKS:   # also each of the ways to the end
            self.run_well("run", self.case, "--restart", "run", "--out", f"end_{ranks}", ranks=ranks)
        self.run_well("run", self.case, "--restart", "run")
        self.run_well("run", self.case, "--out", "straight", ranks=2)
        straight = self.last_checkpoint("straight").read_bytes()
        for end in ("run",) + tuple(f"end_{ranks}" for ranks in self.RANKS):
            self.assertEqual(self.last_checkpoint(end).read_bytes(), straight, end)
        self.assertEqual((self.folder / "run/series.csv").read_text(), (self.folder / "straight/series.csv").read_text())
        self.assert_same_pictures("run", "straight")
        self.assert_same_tracks("run", "straight")
        self.assertEqual(self.unfinished(), [])


if __name__ == "__main__":
    program.main()
