#!/usr/bin/python3
"""The job scripts of scripts/cluster under a stand-in for the queue, which interrupts a run in every way there is.

Called by ctest: cluster_run_test.py THALWEG MPIEXEC [unittest arguments]. Commands of the queue and mpirun are small scripts
ahead in PATH: mpirun is the real one with two ranks, and scontrol and qsub only write down what they are asked for.
"""
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import MPIEXEC, SLIDING_GRAINS, THALWEG, ProgramTest, contents_below

FINISHED, STOPPED = 0, 4   # exit codes
SCRIPTS = Path(__file__).resolve().parents[2] / "scripts/cluster"


class Turns(ProgramTest):
    """Of either queue: subclasses have the script and what it is called with."""
    CASE = SLIDING_GRAINS + """
run: {until: 7, time_step: 0.5e-5}
output: {series: {every: 0.01}}
"""
    SCRIPT = ""
    RUN = "run"   # folder

    def setUp(self):
        super().setUp()
        commands = self.folder / "commands"
        commands.mkdir()
        self.asked = self.folder / "asked"
        for name, text in (("mpirun", f'exec "{shutil.which(MPIEXEC)}" -n 2 "$@"'),
                           ("scontrol", f'echo "$*" >> "{self.asked}"'), ("qsub", f'echo "$*" >> "{self.asked}"')):
            (commands / name).write_text(f"#!/bin/sh\n{text}\n")
            (commands / name).chmod(0o755)
        self.environment = os.environ | {
            "PATH": f"{commands}:{os.environ['PATH']}", "THALWEG": THALWEG, "THALWEG_SCRIPTS": str(SCRIPTS),
            "THALWEG_WALLTIME": "01:00:00", "SLURM_JOB_ID": "17", "PBS_O_WORKDIR": str(self.folder), "CASE": str(self.case),
            "FOLDER": self.RUN}

    def submit(self, **environment):
        process = subprocess.Popen(["bash", str(SCRIPTS / self.SCRIPT), str(self.case), self.RUN], cwd=self.folder,
                                   env=self.environment | environment, start_new_session=True, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
        self.addCleanup(process.stdout.close)
        return process

    def wait_for(self, happened, process):
        for _ in range(1200):
            if happened():
                return
            if process.poll() is not None:
                self.fail("the turn ended: " + process.stdout.read())
            time.sleep(0.02)
        self.fail("nothing has happened within 24 s")

    def is_running(self):
        log = self.folder / self.RUN / "run.log"
        return log.exists() and "steps/s" in log.read_text()[self.log_before:]

    def begin_turn(self, **environment):
        log = self.folder / self.RUN / "run.log"
        self.log_before = len(log.read_text()) if log.exists() else 0
        process = self.submit(**environment)
        self.wait_for(self.is_running, process)
        return process

    def assert_wants_another_turn(self, process):
        said = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, 0, said)
        self.assertTrue(self.asked.exists(), said)
        self.assert_asked_for_the_next(self.asked.read_text().strip())
        self.asked.unlink()

    def assert_ends_the_chain(self, process, code):
        said = process.communicate(timeout=300)[0]
        self.assertEqual(process.returncode, code, said)
        self.assertFalse(self.asked.exists(), said)
        return said

    def end_and_compare(self):
        self.assert_ends_the_chain(self.submit(), FINISHED)
        self.run_well("run", self.case, "--out", "straight")
        self.assertEqual(self.last_checkpoint(self.RUN).read_bytes(), self.last_checkpoint("straight").read_bytes())
        self.assertEqual((self.folder / self.RUN / "series.csv").read_text(), (self.folder / "straight/series.csv").read_text())

    def test_any_interruption_is_survived(self):
        # The node dies before the first checkpoint: everything is killed at once, and the queue runs the job again.
        process = self.begin_turn()
        os.killpg(process.pid, signal.SIGSTOP)   # nobody is to see the others go
        for pid in self.processes():
            os.kill(pid, signal.SIGKILL)
        os.killpg(process.pid, signal.SIGKILL)
        process.wait(timeout=30)
        self.assertFalse(any((self.folder / self.RUN / "checkpoints").glob("step_*.h5")))
        # The queue announces the end; and the program's own wall time is up.
        process = self.begin_turn()
        process.send_signal(signal.SIGUSR1)
        self.assert_wants_another_turn(process)
        self.assert_wants_another_turn(self.submit(THALWEG_WALLTIME="00:00:01"))
        # Whoever takes the job out of the queue, or stops the run, does not want another turn.
        process = self.begin_turn()
        process.send_signal(signal.SIGTERM)
        self.assertIn("TERM before the walltime of 01:00:00", self.assert_ends_the_chain(process, STOPPED))
        process = self.begin_turn()
        self.run_well("stop", self.RUN)
        self.assert_ends_the_chain(process, STOPPED)
        # The same while the next turn waits in the queue, which then leaves the run as it is.
        process = self.begin_turn()
        process.send_signal(signal.SIGUSR1)
        self.assert_wants_another_turn(process)
        self.assertIn("is not running now", self.run_well("stop", self.RUN).stdout)
        latest = self.last_checkpoint(self.RUN)
        self.assertIn("thalweg stop came after", self.assert_ends_the_chain(self.submit(), STOPPED))
        self.assertEqual(self.last_checkpoint(self.RUN), latest)
        self.end_and_compare()
        # Submitted once more by mistake, with and without the checkpoints.
        for _ in range(2):
            before = contents_below(self.folder)
            self.assertIn("nothing to do", self.assert_ends_the_chain(self.submit(), FINISHED))
            self.assertEqual(contents_below(self.folder), before)
            shutil.rmtree(self.folder / self.RUN / "checkpoints", ignore_errors=True)

    def test_what_cannot_go_on_is_not_queued_again(self):
        self.case.write_text(self.CASE.replace("count: 60", "count: -1"))
        process = self.submit()
        said = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, 2, said)
        self.assertFalse(self.asked.exists())


class Slurm(Turns):
    SCRIPT = "slurm.sh"
    RUN = "runs/tau[0.05] of bed*"   # which a shell could take for a pattern, or for several words

    def assert_asked_for_the_next(self, asked):
        self.assertEqual(asked, "requeue 17")


class Pbs(Turns):
    SCRIPT = "pbs.sh"

    def assert_asked_for_the_next(self, asked):
        option, variables, script = asked.split(" ")
        self.assertEqual((option, script), ("-v", str(SCRIPTS / "pbs.sh")))
        self.assertIn(f"CASE={self.case},FOLDER=run,", variables)

    def test_term_at_the_end_of_the_job_wants_another_turn(self):
        """PBS sends it then, and with qdel: a program that has not saved in time, as this one is held up, goes on in the next turn."""
        process = self.begin_turn(THALWEG_WALLTIME="00:00:20")
        begun = time.monotonic()
        pids = self.processes()
        for pid in pids:
            os.kill(pid, signal.SIGSTOP)
        time.sleep(max(0.0, 21.0 - (time.monotonic() - begun)))
        process.send_signal(signal.SIGTERM)
        time.sleep(0.5)
        for pid in pids:
            os.kill(pid, signal.SIGCONT)
        self.assert_wants_another_turn(process)


del Turns   # only what there are queues for


if __name__ == "__main__":
    program.main()
