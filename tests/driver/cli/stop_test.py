#!/usr/bin/env python3
"""A run is stopped by signals, by `thalweg stop` or by its wall time, and continued with the same bits.

Called by ctest: stop_test.py THALWEG MPIEXEC [unittest arguments]
"""
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
import program
from program import TUMBLING_GRAINS, ProgramTest, files_below

# Grains that never come to rest: no gravity, no loss in contacts along the normal, no friction.
PERPETUAL = TUMBLING_GRAINS.replace("slope: 0.5", "slope: 0").replace("magnitude: 9.8", "magnitude: 0") \
    .replace("restitution: 0.8, friction: 0.5", "restitution: 1, friction: 0, wall_friction: 0") \
    .replace("seed: 3}}", "seed: 3}, velocity: [0.1, 0, 0]}\n"
             "  - {count: 10, diameter: 6.0e-3, density: 2550, placement: {pattern: random},"
             " velocity: [-0.2, 0.1, 0.1]}") \
    .replace("{from: 0.05}", "{from: 0}").replace("every: 0.04", "every: 100").replace("every: 0.02", "every: 20") \
    .replace("every: 2.0e-3", "every: 0.1")

# Grains that take many seconds to be placed.
DENSE = "grains=[{count: 400000, diameter: 3.0e-4, density: 2550, placement: {pattern: dense}}]"


class Stopping(ProgramTest):
    CASE = PERPETUAL
    LONG = ("--until", "10000")

    def start(self, *arguments, ranks=0, patience=5):
        """A run that would take hours, once it has begun to report."""
        command = self.command(("run", self.case) + self.LONG + arguments, ranks)
        # Open MPI's mpirun answers SIGTERM by passing it on after one second and killing after another; a busy machine
        # needs more.
        patient = os.environ | {"OMPI_MCA_odls_base_sigkill_timeout": str(patience)}
        with open(self.folder / "said", "w", encoding="utf-8") as said:
            process = subprocess.Popen(
                command, cwd=self.folder, stdout=said, stderr=subprocess.PIPE, text=True, env=patient
            )
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        log = self.folder / "run" / "run.log"
        for _ in range(600):
            if log.exists() and "steps/s" in log.read_text():
                return process
            if process.poll() is not None:
                self.fail("the run ended: " + process.stderr.read())
            time.sleep(0.05)
        self.fail("no progress line within 30 s: " + (log.read_text() if log.exists() else "no log"))

    def assert_can_go_on(self, ranks_before):
        """The stopped run, continued on other ranks for ten steps, has the bits of a run straight to that time."""
        summary = self.summary("run")
        self.assertFalse(summary["finished"])
        until = f"{(summary['steps'] + 10) * 50 * 4e-6:.9g}"
        self.run_well("run", self.case, "--restart", "run", "--until", until, ranks=3 - max(1, ranks_before))
        self.assertTrue(self.summary("run")["finished"])
        self.run_well("run", self.case, "--out", "straight", "--until", until)
        self.assert_same_end("run", "straight", "series.csv")
        self.assertEqual((self.folder / "run" / "grains.pvd").read_text(),
                         (self.folder / "straight" / "grains.pvd").read_text())

    def test_sigterm(self):
        process = self.start()
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=30), 3)
        self.assertEqual(self.summary("run")["reason"], "stopped by SIGTERM")
        self.assertIn("SIGTERM", self.run_well("info", "run").stdout)
        self.assert_can_go_on(1)

    def test_sighup_as_when_a_terminal_closes(self):
        process = self.start()
        process.send_signal(signal.SIGHUP)
        self.assertEqual(process.wait(timeout=30), 3)
        self.assertEqual(self.summary("run")["reason"], "stopped by SIGHUP")
        self.assert_can_go_on(1)

    def test_sigusr1_through_mpirun(self):
        process = self.start(ranks=2)
        process.send_signal(signal.SIGUSR1)
        self.assertEqual(process.wait(timeout=30), 3)
        self.assertEqual(self.summary("run")["reason"], "stopped by SIGUSR1")
        self.assert_can_go_on(2)

    def test_sigterm_to_mpirun_leaves_a_checkpoint(self):
        # mpirun's own exit code then is not the program's: what counts is on the disk.
        process = self.start(ranks=2)
        process.send_signal(signal.SIGTERM)
        process.wait(timeout=40)
        self.assertEqual(self.summary("run")["reason"], "stopped by SIGTERM")
        log = (self.folder / "run/run.log").read_text()
        self.assertRegex(
            log, r"to stop early: thalweg stop \S+ \(after Ctrl-C or SIGTERM mpirun allows only 10 s to save\)"
        )
        self.assertIn("SIGCONT (mpirun sends it before it kills the ranks): saving\n", log)
        self.assert_can_go_on(2)

    def test_ctrl_c_of_mpirun_without_patience_loses_nothing_that_is_whole(self):
        # Two seconds, which a busy machine may exceed: then the run ends without a summary, and what is there counts.
        process = self.start("--set", "output.checkpoint.every=100", ranks=2, patience=1)
        process.send_signal(signal.SIGINT)
        process.wait(timeout=40)
        if (self.folder / "run/summary.json").exists():
            self.assertEqual(self.summary("run")["reason"], "stopped by SIGTERM")
            self.assert_can_go_on(2)
        elif (self.folder / "run/checkpoints/latest").exists():
            self.assertIn("resuming from", self.run_well("run", self.case, "--restart", "run", "--until", "1").stdout)
        else:
            self.assert_refused("run", self.case, "--restart", "run", words=["has no checkpoint"])

    @staticmethod
    def catches_signals(process):
        """Whether the process has come so far that SIGTERM and SIGINT no longer end it."""
        try:
            status = Path(f"/proc/{process}/status").read_text()
        except OSError:   # it has ended
            return False
        caught = int(re.search(r"SigCgt:\s*([0-9a-f]+)", status)[1], 16)
        return all(caught >> (signalled - 1) & 1 for signalled in (signal.SIGTERM, signal.SIGINT))

    def stopped_before_it_begins(self, ranks, signalled):
        """A run that takes long to place its grains, stopped as soon as its processes are there."""
        command = self.command(("run", self.case, "--set", DENSE, "--set", "run.time_step=null"), ranks)
        process = subprocess.Popen(
            command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            env=os.environ | {"OMPI_MCA_odls_base_sigkill_timeout": "1"},
        )
        self.addCleanup(process.kill)
        for _ in range(600):
            if len(self.processes()) == max(1, ranks) and all(map(self.catches_signals, self.processes())):
                break
            time.sleep(0.05)
        process.send_signal(signalled)
        said, complaint = process.communicate(timeout=40)
        self.assertEqual(files_below(self.folder), ["case.yaml"], said + complaint)
        self.assertEqual(complaint.count("stopped by a signal before the run began: nothing was written"), 1, complaint)
        return process.returncode

    def test_a_signal_before_the_run_begins(self):
        for signalled in (signal.SIGTERM, signal.SIGINT):
            self.assertEqual(self.stopped_before_it_begins(0, signalled), 3)

    def test_ctrl_c_of_mpirun_before_the_run_begins(self):
        self.assertNotEqual(self.stopped_before_it_begins(2, signal.SIGINT), 0)   # the code is that of mpirun

    def stop_by_command(self, ranks):
        process = self.start(ranks=ranks)
        self.assertIn(
            "run saves its state and ends within a step; to continue, add --restart run",
            self.run_well("stop", "run").stdout,
        )
        self.assertEqual(process.wait(timeout=30), 4)
        said = (self.folder / "said").read_text()
        self.assertEqual(
            "exit code 4: the run was stopped in good order" in said, ranks > 0
        )  # for mpirun, which complains of it
        self.assertEqual(self.summary("run")["reason"], "stopped on request (thalweg stop)")
        self.assertFalse((self.folder / "run/stop").exists())
        self.assertIn("run has ended", self.run_well("stop", "run").stdout)   # the next run is not meant
        self.assert_can_go_on(ranks)

    def test_thalweg_stop(self):
        self.stop_by_command(0)
        self.assert_refused("stop", "nowhere", words=["nowhere is not a run folder"])

    def test_thalweg_stop_of_two_ranks(self):
        self.stop_by_command(2)

    def test_walltime(self):
        start = time.monotonic()
        self.assertEqual(self.thalweg("run", self.case, *self.LONG, "--walltime", "00:00:03").returncode, 3)
        # Within the three seconds; the bound leaves room for a busy machine (the whole run would take minutes).
        self.assertLess(time.monotonic() - start, 15.0)
        self.assertIn("wall time", self.summary("run")["reason"])
        self.assert_can_go_on(1)


if __name__ == "__main__":
    program.main(side_by_side=True)
