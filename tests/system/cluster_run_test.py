#!/usr/bin/env python3
"""The job scripts of scripts/cluster under a stand-in for the queue, which interrupts a run in every way there is.

Called by ctest: cluster_run_test.py THALWEG MPIEXEC [unittest arguments]. Commands of the queue and launchers are small
scripts ahead in PATH: mpirun and others are the real one with two ranks; scontrol and qsub only write down what they
are asked for; squeue and qstat tell what a test has written for them.
"""
import json
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

FINISHED, BAD_INPUT, STOPPED = 0, 2, 4   # exit codes
SCRIPTS = Path(__file__).resolve().parents[2] / "scripts/cluster"
OF_THE_QUEUE = ("CASE", "FOLDER", "THALWEG", "SLURM", "PBS")   # beginnings of variables

# Writes down its arguments and the variables that the next job will have, as PBS takes them: -v NAME,NAME=VALUE.
QSUB = """#!/usr/bin/env python3
import json, os, sys
*options, script = sys.argv[1:]
named = options.pop(options.index("-v") + 1).split(",")
options.remove("-v")
variables = dict(name.split("=", 1) if "=" in name else (name, os.environ[name]) for name in named)
with open({asked!r}, "w") as file:
    json.dump({{"options": options, "variables": variables, "script": script}}, file)
"""

# Of OpenPBS, which breaks lines.
QSTAT = """Job Id: 17.server
    Job_Name = bed of glass
    Job_Owner = somebody@login1
    resources_used.cpupercent = 0
    resources_used.ncpus = 256
    resources_used.walltime = 00:00:03
    job_state = R
    queue = long_on_new_nodes
    Account_Name = river
    project = _pbs_project_default
    Resource_List.mem = 200gb
    Resource_List.ncpus = 256
    Resource_List.nodect = 4
    Resource_List.place = scatter:excl
    Resource_List.select = 4:ncpus=64:mpiprocs=64:mem=50gb:cpu_type=some_long_n
\tame_of_a_processor
    Resource_List.walltime = {walltime}
    Variable_List = PBS_O_HOME=/home/somebody,PBS_O_LANG=C,
\tCASE=case.yaml
    comment = Job run at some time, queue = none of these
"""


class Turns(ProgramTest):
    """Of either queue: subclasses have the script and what it is called with."""
    CASE = SLIDING_GRAINS + """
run: {until: 700, time_step: 0.5e-5}
output: {series: {every: 0.01}}
"""
    SCRIPT = ""
    RUN = "run"   # folder

    def setUp(self):
        super().setUp()
        commands = self.folder / "commands"
        commands.mkdir()
        self.asked = self.folder / "asked"
        launch = (
            f'echo "$0 $*" >> "{self.folder}/launched"; [ "$1" != --mpi=pmix ] || shift; exec "{shutil.which(MPIEXEC)}"'
            ' -n 2 "$@"'
        )
        for name, text in {
            "mpirun": launch, "srun": launch, "mpiexec": launch, "scontrol": f'echo "$*" >> "{self.asked}"',
            "squeue": f'cat "{self.folder}/squeue"', "qstat": f'[ "$*" = "-f 17.server" ] && cat "{self.folder}/qstat"',
        }.items():
            (commands / name).write_text(f"#!/bin/sh\n{text}\n")
        (commands / "qsub").write_text(QSUB.format(asked=str(self.asked)))
        for command in commands.iterdir():
            command.chmod(0o755)
        clean = {name: value for name, value in os.environ.items() if not name.startswith(OF_THE_QUEUE)}
        self.environment = clean | {
            "PATH": f"{commands}:{os.environ['PATH']}", "THALWEG": THALWEG, "THALWEG_SCRIPTS": str(SCRIPTS),
        }

    def submit(self, left=3600, **environment):
        """left: s until the end of the job, as the queue tells."""
        process = subprocess.Popen(["bash", str(SCRIPTS / self.SCRIPT), str(self.case), self.RUN], cwd=self.folder,
                                   env=self.environment | self.of_queue(left) | environment, start_new_session=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
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
        try:
            return "steps/s" in log.read_text()[self.log_before:]
        except FileNotFoundError:   # not there yet, or not there for a moment while a new one takes its place
            return False

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
        self.assertNotIn("scheduler does not tell", said)
        self.asked.unlink()

    def assert_ends_the_chain(self, process, code):
        said = process.communicate(timeout=300)[0]
        self.assertEqual(process.returncode, code, said)
        self.assertFalse(self.asked.exists(), said)
        return said

    def end_and_compare(self):
        """With an end that is not far, however fast the machine was until here."""
        reached = int(self.last_checkpoint(self.RUN).stem.removeprefix("step_")) * 0.5e-5 * 50
        self.case.write_text(self.CASE.replace("until: 700", f"until: {reached + 0.5:.6g}"))
        self.assert_ends_the_chain(self.submit(), FINISHED)
        self.run_well("run", self.case, "--out", "straight")
        self.assert_same_end(self.RUN, "straight", "series.csv")

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
        self.assert_wants_another_turn(self.submit(left=4))
        self.assert_wants_another_turn(self.submit(THALWEG_WALLTIME="00:00:01", THALWEG_LAUNCH="srun --mpi=pmix"))
        self.assertIn(f"srun --mpi=pmix {THALWEG} run", (self.folder / "launched").read_text().splitlines()[-1])
        # Whoever takes the job out of the queue, or stops the run, does not want another turn.
        process = self.begin_turn()
        process.send_signal(signal.SIGTERM)
        self.assertIn("TERM before the walltime of 00:5", self.assert_ends_the_chain(process, STOPPED))
        process = self.begin_turn()
        self.run_well("stop", self.RUN)
        self.assert_ends_the_chain(process, STOPPED)
        # The same while the next turn waits in the queue, which then leaves the run as it is.
        process = self.begin_turn()
        process.send_signal(signal.SIGUSR1)
        self.assert_wants_another_turn(process)
        self.assertIn("is not running now", self.run_well("stop", self.RUN).stdout)
        latest = self.last_checkpoint(self.RUN)
        self.assertIn("thalweg stop was given after", self.assert_ends_the_chain(self.submit(), STOPPED))
        self.assertEqual(self.last_checkpoint(self.RUN), latest)
        self.end_and_compare()
        # Submitted once more by mistake, with and without the checkpoints.
        for _ in range(2):
            before = contents_below(self.folder / self.RUN)
            self.assertIn("nothing to do", self.assert_ends_the_chain(self.submit(), FINISHED))
            self.assertEqual(contents_below(self.folder / self.RUN), before)
            shutil.rmtree(self.folder / self.RUN / "checkpoints", ignore_errors=True)

    def test_what_cannot_go_on_is_not_queued_again(self):
        self.case.write_text(self.CASE.replace("count: 60", "count: -1"))
        process = self.submit()
        said = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, BAD_INPUT, said)
        self.assertFalse(self.asked.exists())

    def test_a_walltime_that_is_none_is_refused(self):
        self.assertIn("THALWEG_WALLTIME=tomorrow is not a time",
                      self.assert_ends_the_chain(self.submit(THALWEG_WALLTIME="tomorrow"), BAD_INPUT))
        self.assertFalse((self.folder / "launched").exists())

    def walltimes(self):
        """That the program was given, s."""
        lines = (self.folder / "launched").read_text().splitlines()
        clocks = [line.split("--walltime ")[1].split(":") for line in lines if "--walltime" in line]
        return [3600 * int(hours) + 60 * int(minutes) + int(seconds) for hours, minutes, seconds in clocks]


class Slurm(Turns):
    SCRIPT = "slurm.sh"
    RUN = "runs/tau[0.05] of bed*"   # which a shell could take for a pattern, or for several words

    def of_queue(self, left):
        return {"SLURM_JOB_ID": "17", "SLURM_JOB_END_TIME": str(int(time.time()) + left)}

    def assert_asked_for_the_next(self, asked):
        self.assertEqual(asked, "requeue 17")

    def test_walltime_is_that_of_the_queue_less_a_margin(self):
        self.case.write_text(self.CASE.replace("until: 700", "until: 1e-3"))
        for said in ("1-00:00:00", "1:00:00", "UNLIMITED"):
            (self.folder / "squeue").write_text(said + "\n")
            self.assert_ends_the_chain(self.submit(SLURM_JOB_END_TIME=""), FINISHED)
        self.assert_ends_the_chain(self.submit(left=86400), FINISHED)
        self.assert_ends_the_chain(self.submit(THALWEG_WALLTIME="02:00:00"), FINISHED)
        self.assertEqual(len((self.folder / "launched").read_text().splitlines()), 5)
        for walltime, expected in zip(self.walltimes(), (86400 - 600, 3600 - 180, 86400 - 600, 7200), strict=True):
            self.assertAlmostEqual(walltime, expected, delta=2)


class Pbs(Turns):
    SCRIPT = "pbs.sh"
    RUN = "runs/b[1], fein ü"   # a comma separates the variables of qsub
    qstat = QSTAT

    def of_queue(self, left):
        (self.folder / "qstat").write_text(
            self.qstat.format(walltime=f"{left // 3600:02}:{left // 60 % 60:02}:{left % 60:02}")
        )
        # As CASE=... FOLDER=... qsub -v CASE,FOLDER passes them on.
        return {
            "PBS_JOBID": "17.server", "PBS_O_WORKDIR": str(self.folder), "PBS_O_QUEUE": "long", "CASE": str(self.case),
            "FOLDER": self.RUN,
        }

    def assert_asked_for_the_next(self, asked):
        next_job = json.loads(asked)
        walltime = next_job["options"].pop()
        self.assertRegex(walltime, r"^walltime=\d\d:\d\d:\d\d$")
        self.assertEqual(
            next_job["options"],
            [
                "-q", "long", "-A", "river", "-N", "bed of glass", "-l",
                "select=4:ncpus=64:mpiprocs=64:mem=50gb:cpu_type=some_long_name_of_a_processor", "-l",
                "place=scatter:excl", "-l",
            ],
        )
        variables = next_job["variables"]
        self.assertEqual(variables.pop("THALWEG_WALLTIME", "00:00:01"), "00:00:01")
        self.assertEqual(variables.pop("THALWEG_LAUNCH", "srun --mpi=pmix"), "srun --mpi=pmix")
        self.assertEqual(
            variables, {"CASE": str(self.case), "FOLDER": self.RUN, "THALWEG": THALWEG, "THALWEG_SCRIPTS": str(SCRIPTS)}
        )
        self.assertEqual(next_job["script"], str(SCRIPTS / "pbs.sh"))

    def test_walltime_is_that_of_the_job_less_what_has_passed_and_a_margin(self):
        self.case.write_text(self.CASE.replace("until: 700", "until: 1e-3"))
        self.assert_ends_the_chain(self.submit(left=48 * 3600), FINISHED)
        self.assert_ends_the_chain(self.submit(THALWEG_WALLTIME="02:00:00"), FINISHED)
        self.assertEqual(self.walltimes(), [48 * 3600 - 3 - 600, 7200])
        said = self.assert_ends_the_chain(self.submit(PBS_JOBID="18.server"), FINISHED)
        self.assertIn("qstat -f 18.server fails", said)
        self.assertIn("the scheduler does not tell when this job ends", said)

    def test_the_next_job_of_torque_has_its_nodes(self):
        self.qstat = """Job Id: 17.server
    Job_Name = thalweg
    queue = batch
    group_list = hydro
    project = sand
    Resource_List.nodect = 4
    Resource_List.nodes = 4:ppn=64
    Resource_List.walltime = {walltime}
"""
        process = self.submit(THALWEG_WALLTIME="00:00:01", PBS_O_QUEUE="")
        said = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, 0, said)
        self.assertEqual(
            json.loads(self.asked.read_text())["options"],
            [
                "-q", "batch", "-P", "sand", "-N", "thalweg", "-W", "group_list=hydro", "-l", "nodes=4:ppn=64", "-l",
                "walltime=01:00:00",
            ],
        )

    def test_term_at_the_end_of_the_job_wants_another_turn(self):
        """PBS sends it then, and with qdel: a program that has not saved in time, as this one is held up, goes on in
        the next turn."""
        process = self.begin_turn(left=24)
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
    program.main(side_by_side=True)
