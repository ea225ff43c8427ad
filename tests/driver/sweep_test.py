"""`thalweg sweep` as its user meets it: tables, a kill and going on, what is refused.

Called by ctest: sweep_test.py THALWEG MPIEXEC [unittest arguments]
"""
import csv
import json
import os
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import THALWEG, ProgramTest

# Two grains that lie on a floor with friction and slide, without rolling, where it is steep enough.
CASE = """
system: grains
domain:
  size: [0.02, 0.02, 0.02]
  spacing: 1.0e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
gravity: {magnitude: 9.8, slope: 0.5}
grains:
  - {density: 2550, shape: {clump: [{position: [0, 0, 0], diameter: 5.0e-3}, {position: [6.0e-3, 0, 0], diameter: 5.0e-3},
     {position: [3.0e-3, 5.0e-3, 0], diameter: 5.0e-3}]}, orientation: {axis: [0, 0, 1], angle: 0},
     placement: {positions: [[0.01, 0.01, 2.5e-3]]}}
contact: {normal_stiffness: 20000, tangential_stiffness: 5714, restitution: 0.5, wall_friction: 0.3}
run: {until: 0.2, time_step: 5.0e-6}
output: {checkpoint: {every: 0.02}}
"""


class Sweep(ProgramTest):
    CASE = CASE

    def write(self, text, name="sweep.yaml"):
        (self.folder / name).write_text("case: case.yaml\n" + text)
        return name

    def table(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))

    def test_one_table_of_all_runs_and_none_is_repeated(self):
        sweep = self.write(
            "vary: {gravity.slope: [0.1, 0.6], contact.wall_friction: {from: 0.2, to: 0.4, count: 2}}\n"
            "columns: [grain_energy.grain_momentum_x, figures.largest_grain_speed, simulated_time, gone.bye]\n"
        )
        result = self.run_well("sweep", sweep)
        self.assertIn("4 of 4 runs done", result.stdout)
        self.assertIn("no run has the number gone.bye", result.stderr)
        rows = self.table("sweep/runs.csv")
        self.assertAlmostEqual(float(rows[0]["simulated_time [s]"]), 0.2, delta=3e-4)
        self.assertEqual(
            [(row["gravity.slope [1]"], row["contact.wall_friction [1]"], row["state"]) for row in rows],
            [("0.1", "0.2", "done"), ("0.1", "0.4", "done"), ("0.6", "0.2", "done"), ("0.6", "0.4", "done")],
        )
        speeds = [float(row["figures.largest_grain_speed [m/s]"]) for row in rows]
        # Down a slope S with friction mu: t g (sin - mu cos), or rest.
        for speed, slope, friction in zip(speeds, (0.1, 0.1, 0.6, 0.6), (0.2, 0.4, 0.2, 0.4)):
            expected = 0.2 * 9.8 * max(0.0, slope - friction) / (1.0 + slope * slope) ** 0.5
            self.assertAlmostEqual(speed, expected, delta=0.02 * 9.8 * 0.2)
        before = {path: path.stat().st_mtime_ns for path in (self.folder / "sweep/runs").rglob("*.h5")}
        self.run_well("sweep", sweep)
        self.assertEqual(before, {path: path.stat().st_mtime_ns for path in (self.folder / "sweep/runs").rglob("*.h5")})

    def test_results_of_several_versions_are_told_apart(self):
        sweep = self.write("vary: {gravity.slope: [0.1, 0.2]}\nset: {run.until: 0.01}\n")
        self.assertNotIn("versions", self.run_well("sweep", sweep).stderr)
        summary = self.folder / "sweep/runs/slope_0.1/summary.json"
        summary.write_text(json.dumps(json.loads(summary.read_text()) | {"version": "0.0.9"}))
        self.assertIn("made by several versions of the program (column version of runs.csv): 0.0.9, ",
                      self.run_well("sweep", sweep).stderr)
        self.assertEqual(self.table("sweep/runs.csv")[0]["version"], "0.0.9")

    def test_bisection_finds_the_angle_of_friction(self):
        sweep = self.write("vary: {contact.wall_friction: [0.2, 0.4]}\n"
                           "bisect: {key: gravity.slope, from: 0.05, to: 1.0, width: 0.02,\n"
                           "         holds: figures.largest_grain_speed > 1e-2}\n")
        self.run_well("sweep", sweep)
        for row in self.table("sweep/thresholds.csv"):
            self.assertEqual(row["state"], "found")
            # tan of the angle of friction is mu; what slides at 0.01 m/s after 0.2 s is 0.005 g steeper.
            friction = float(row["contact.wall_friction [1]"])
            self.assertLessEqual(float(row["lower [1]"]), friction + 0.006)
            self.assertGreaterEqual(float(row["upper [1]"]), friction)
            self.assertLessEqual(float(row["half_width [1]"]), 0.01)

    def test_a_repetition_that_no_longer_matters_is_stopped(self):
        sweep = self.write("bisect: {key: gravity.slope, from: 0.1, to: 1.0, width: 0.6,\n"
                           "         holds: figures.largest_grain_speed > 1e-2,\n"
                           "         repeat: {run.until: [0.01, 0.02, 1000.0]}}\n")
        self.run_well("sweep", sweep, "--jobs", "3")
        self.assertEqual({row["run.until [s]"]: row["state"] for row in self.table("sweep/runs.csv")
                          if row["state"] != "waiting"}, {"0.01": "done", "0.02": "done", "1000.0": "begun"})
        self.assertEqual(self.table("sweep/thresholds.csv")[0]["state"], "found")

    def test_goes_on_after_a_kill_with_the_same_bits(self):
        sweep = self.write("set: {run.until: 1.0}\nvary: {gravity.slope: [0.5, 0.6]}\n")
        going = subprocess.Popen([THALWEG, "sweep", sweep, "--jobs", "2"], cwd=self.folder, stdout=subprocess.DEVNULL)
        latest = self.folder / "sweep/runs/slope_0.5/checkpoints/latest"
        deadline = time.monotonic() + 60.0
        while not latest.exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        going.kill()
        going.wait()
        for name in ("slope_0.5", "slope_0.6"):   # as where the kill came between a checkpoint and `latest`
            (self.folder / "sweep/runs" / name / "checkpoints/latest").unlink(missing_ok=True)
        said = self.run_well("sweep", sweep).stdout
        self.assertIn("resuming from", (self.folder / "sweep/runs/slope_0.5.txt").read_text())
        self.assertIn("2 of 2 runs done", said)
        self.run_well("run", self.case, "--set", "gravity.slope=0.5", "--set", "run.until=1.0", "--out", "alone")
        self.assert_same_bed("sweep/runs/slope_0.5", "alone")

    def test_a_signal_stops_it_in_good_order(self):
        sweep = self.write("set: {run.until: 100.0}\nvary: {gravity.slope: [0.5, 0.6, 0.7]}\n")
        for number in (signal.SIGTERM, signal.SIGHUP):
            going = subprocess.Popen(
                [THALWEG, "sweep", sweep, "--jobs", "1", "--out", number.name], cwd=self.folder, stdout=subprocess.PIPE,
                text=True, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL),
            )
            self.wait_for_log(f"{number.name}/runs/slope_0.5", going)
            time.sleep(0.5)
            os.kill(going.pid, number)
            said, _ = going.communicate(timeout=60)
            self.assertEqual(going.returncode, 3)   # as thalweg run says
            self.assertIn("the same command resumes the sweep", said)
            self.assertEqual(
                [row["state"] for row in self.table(f"{number.name}/runs.csv")], ["begun", "waiting", "waiting"]
            )
            self.assertTrue((self.folder / number.name / "runs/slope_0.5/checkpoints/latest").exists())

    def test_a_run_that_fails_is_named_and_the_others_go_on(self):
        sweep = self.write("vary: {contact.wall_friction: [-1, 0.3]}\nset: {run.until: 0.01}\n")
        result = self.thalweg("sweep", sweep)
        self.assertEqual(result.returncode, 1)
        self.assertIn("1 of the runs have failed", result.stderr)
        failed, done = self.table("sweep/runs.csv")
        self.assertEqual((failed["state"], done["state"]), ("failed", "done"))
        self.assertIn("contact.wall_friction", failed["failure"])

    def test_a_case_that_is_edited_meanwhile_is_not_mixed_in(self):
        sweep = self.write("vary: {contact.wall_friction: {from: 0.2, to: 0.3, count: 8}}\n")
        process = subprocess.Popen([THALWEG, "sweep", sweep, "--jobs", "1"], cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        while process.poll() is None and not list(self.folder.glob("sweep/runs/*/summary.json")):
            time.sleep(0.02)
        self.case.write_text(self.CASE.replace("restitution: 0.5", "restitution: 0.6"))
        self.assertEqual(process.wait(60), 2)
        self.assertIn("has been changed since this sweep began", process.stderr.read())
        self.case.write_text(self.CASE)
        self.run_well("sweep", sweep)
        self.assertEqual({row["state"] for row in self.table("sweep/runs.csv")}, {"done"})

    def test_a_run_without_the_figure_of_a_bisection_has_failed(self):
        sweep = self.write(
            "set: {analysis.transport_rate: {from: 1}}\n"
            "bisect: {key: gravity.slope, from: 0.1, to: 0.5, width: 0.2, holds: transport_rate.q_s_mean > 0}\n"
        )
        said = self.thalweg("sweep", sweep)
        self.assertEqual(said.returncode, 1, said.stderr)
        self.assertIn("of the runs have failed", said.stderr)
        self.assertIn("have no number transport_rate.q_s_mean", self.table("sweep/runs.csv")[0]["failure"])
        self.assertEqual([row["state"] for row in self.table("sweep/thresholds.csv")], ["failed"])

    def test_a_misspelt_key_is_refused_before_anything_is_run(self):
        sweep = self.write("vary: {contact.wal_friction: [0.2, 0.3]}\nset: {run.until: 0.01}\n")
        result = self.thalweg("sweep", sweep)
        self.assertEqual(result.returncode, 2)
        self.assertIn("did you mean contact.wall_friction", result.stderr)
        self.assertFalse((self.folder / "sweep/runs").exists())

    def test_a_refused_bisection_can_be_corrected(self):
        bisect = (
            "bisect: {key: gravity.slope, from: 0.1, to: 0.9, width: 0.5, holds: figures.largest_grain_speed > 0.01}\n"
        )
        sweep = self.write("set: {contact.wal_friction: 0.3}\n" + bisect)
        self.assertEqual(self.thalweg("sweep", sweep).returncode, 1)
        self.write("set: {contact.wall_friction: 0.3}\n" + bisect)
        self.run_well("sweep", sweep)
        self.assertEqual([row["state"] for row in self.table("sweep/thresholds.csv")], ["found"])

    def test_a_task_of_an_array_job_says_that_it_was_stopped(self):
        sweep = self.write("set: {run.until: 100.0}\nvary: {gravity.slope: [0.5, 0.6]}\n")
        going = subprocess.Popen([THALWEG, "sweep", sweep, "--task", "0"], cwd=self.folder, stdout=subprocess.DEVNULL)
        self.wait_for_log("sweep/runs/slope_0.5", going)
        going.send_signal(signal.SIGTERM)
        self.assertEqual(going.wait(60), 3)

    def test_a_task_of_an_array_job_goes_back_into_the_queue_when_its_time_is_up(self):
        sweep = self.write("set: {run.until: 1.5}\nvary: {gravity.slope: [0.5, 0.6]}\n")
        job, asked, commands = self.folder / "job.sh", self.folder / "asked", self.folder / "commands"
        job.write_text(self.run_well("sweep", sweep, "--slurm").stdout)
        commands.mkdir()
        (commands / "scontrol").write_text(f'#!/bin/sh\necho "$*" >> "{asked}"\n')
        (commands / "scontrol").chmod(0o755)
        environment = os.environ | {
            "PATH": f"{commands}:{os.environ['PATH']}", "SLURM_ARRAY_TASK_ID": "1", "SLURM_JOB_ID": "17",
        }
        for sent, code, queued in (
            (signal.SIGUSR1, 0, True), (signal.SIGTERM, -signal.SIGTERM, False), (None, 0, False),
        ):
            (self.folder / "sweep/runs/slope_0.6/run.log").unlink(missing_ok=True)
            task = subprocess.Popen(
                ["bash", job], cwd=self.folder, env=environment, stdout=subprocess.DEVNULL, start_new_session=True
            )
            if sent is not None:
                self.wait_for_log("sweep/runs/slope_0.6", task)
            if sent == signal.SIGTERM:   # as scancel does to all processes of a job
                os.killpg(task.pid, sent)
            elif sent is not None:
                task.send_signal(sent)
            self.assertEqual(task.wait(60), code)
            self.assertEqual(asked.exists(), queued)
            if queued:
                self.assertEqual(asked.read_text(), "requeue 17\n")
                asked.unlink()
        self.run_well("sweep", sweep, "--tables")
        self.assertEqual([row["state"] for row in self.table("sweep/runs.csv")], ["waiting", "done"])

    def wait_for_log(self, run, process):
        deadline = time.monotonic() + 60.0
        while not (self.folder / run / "run.log").exists() and time.monotonic() < deadline and process.poll() is None:
            time.sleep(0.02)

    def test_folders_of_any_name_and_a_launcher_of_ones_own(self):
        folder = self.folder / "tau[0.05] of bed*, fein ü"
        folder.mkdir()
        (folder / "case.yaml").write_text(self.CASE)
        (folder / "some runs.yaml").write_text("case: case.yaml\nset: {run.until: 0.03}\nranks: 2\n"
                                               "vary: {gravity.slope: [0.5], name: ['it''s [a], b']}\n")
        launcher = self.folder / "my launcher"
        launcher.write_text(f'#!/bin/sh\necho "$*" > "{self.folder}/launched"\nshift\nexec "{program.MPIEXEC}" "$@"\n')
        launcher.chmod(0o755)
        run = folder / "some runs/runs/slope_0.5-name_it_s__a___b"
        for _ in range(2):
            result = subprocess.run(
                [THALWEG, "sweep", folder / "some runs.yaml"], capture_output=True, text=True, cwd=self.folder,
                env=os.environ | {"THALWEG_LAUNCH": f"'{launcher}' --mpi=pmix"}, timeout=120,
            )
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            self.assertTrue((self.folder / "launched").read_text().startswith(f"--mpi=pmix -n 2 {THALWEG} run "))
            self.assertTrue(json.loads((run / "summary.json").read_text())["finished"])
            (run / "summary.json").unlink()   # as after a kill
        self.assertIn("resuming from", run.with_name(run.name + ".txt").read_text())

    def test_the_program_tells_what_the_machine_has(self):
        teller = self.folder / "teller"
        teller.write_text('#!/bin/sh\necho "$THALWEG_CORES $THALWEG_MEMORY"\n')
        teller.chmod(0o755)
        own = sorted(os.sched_getaffinity(0))
        for cores in {1, min(2, len(own))}:
            said = subprocess.run(
                [THALWEG, "sweep"], env=os.environ | {"THALWEG_PYTHON": str(teller)}, capture_output=True, text=True,
                preexec_fn=lambda: os.sched_setaffinity(0, own[:cores]),
            ).stdout.split()
            self.assertEqual(int(said[0]), cores)
            scripts = Path(__file__).resolve().parents[2] / "scripts"
            by_script = subprocess.run(
                ["bash", "-euc", f"source {scripts}/mpi_environment; available_cores"], capture_output=True, text=True,
                preexec_fn=lambda: os.sched_setaffinity(0, own[:cores]),
            ).stdout
            self.assertEqual(int(by_script), cores)
            self.assertGreater(float(said[1]), 1e7)

    def test_no_more_runs_at_a_time_than_there_is_memory_for(self):
        sweep = self.write("set: {run.until: 0.01}\nvary: {contact.wall_friction: [0.2, 0.3, 0.4]}\n")
        said = self.run_well("check", self.case).stdout
        amount, unit = said[said.index("memory "):].split()[2:4]
        needed = float(amount) * {"MB": 1e6, "GB": 1e9}[unit]
        package = Path(__file__).resolve().parents[2] / "python"
        result = subprocess.run(
            [sys.executable, "-m", "thalweg", "sweep", sweep], cwd=self.folder, capture_output=True, text=True,
            timeout=120,
            env=os.environ
            | {
                "PYTHONPATH": str(package), "THALWEG_PROGRAM": THALWEG, "THALWEG_CORES": "3",
                "THALWEG_MEMORY": f"{1.9 * needed:.0f}",
            },
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(
            f"1 run at a time, though there are cores for 3: a run takes up to {needed / 1e9:.3g} GB", result.stdout
        )
        self.assertNotIn("2 going", result.stdout)
        self.assertIn("3 of 3 runs done", result.stdout)

    def test_tasks_of_an_array_job_and_their_tables(self):
        sweep = self.write("set: {run.until: 0.01}\nvary: {contact.wall_friction: [0.2, 0.3]}\n")
        job = self.run_well("sweep", sweep, "--slurm").stdout
        self.assertIn("--array=0-1", job)
        self.assertNotIn("--retry", job)
        self.assertIn("--jobs 1 --retry &\n", self.run_well("sweep", sweep, "--slurm", "--retry").stdout)
        self.assertIn("contact.wall_friction = 0.3: waiting", self.run_well("sweep", sweep, "--dry-run").stdout)
        self.run_well("sweep", sweep, "--task", "1")
        for task in ([], ["--task", "1"]):
            self.run_well("sweep", sweep, "--tables", *task)
            self.assertEqual([row["state"] for row in self.table("sweep/runs.csv")], ["waiting", "done"])

    def test_warnings_are_passed_on_once_with_the_names_of_the_runs(self):
        # Rows every 1e-7 s are less than a step of 5e-6 s; the third run has no such warning.
        sweep = self.write("set: {run.until: 0.001}\nvary: {output.series.every: [1.0e-7, 2.0e-7, 5.0e-4]}\n")
        text = "less than a step"
        planned = self.run_well("sweep", sweep, "--dry-run").stdout
        done = self.run_well("sweep", sweep).stdout
        for said in (planned, done):
            said = " ".join(said.split())
            self.assertEqual(said.count(text), 1, said)
            self.assertIn(
                "warning: every_1e-07, every_2e-07 (the numbers are those of every_1e-07): output.series.every", said
            )
        rows = {row["run"]: row["warnings"] for row in self.table("sweep/runs.csv")}
        self.assertEqual(rows, {"every_1e-07": "1", "every_2e-07": "1", "every_0.0005": "0"})

    def test_tables_in_grain_units_do_not_name_those_of_si(self):
        model_fluid = Path(__file__).resolve().parents[2] / "cases/model_fluid/case.yaml"
        (self.folder / "grain.yaml").write_text(
            f"case: {model_fluid}\nset: {{run.until: 0.1, run.until_at_rest: null}}\n"
            "vary: {model_fluid.shields_number: [0.1]}\n"
            "columns: [simulated_time, figures.largest_grain_speed]\n"
        )
        self.run_well("sweep", "grain.yaml")
        self.assertEqual(
            list(self.table("grain/runs.csv")[0]),
            [
                "run", "run.until", "run.until_at_rest", "model_fluid.shields_number [1]", "state", "warnings",
                "version", "wall_time [s]", "simulated_time", "figures.largest_grain_speed", "failure",
            ],
        )

    def test_refusals(self):
        self.assert_refused("sweep", self.write("", "small.yaml"), "--jobs", "0", words=["--jobs 0"])
        (self.folder / "dated.yaml").write_bytes(b"case: \xff\n")
        self.assert_refused("sweep", "dated.yaml", words=["dated.yaml", "UTF-8"])

        self.write("", "without_an_ending")
        self.assert_refused("sweep", "without_an_ending", words=["without_an_ending", "not a folder", "--out"])
        self.assert_refused("sweep", "gone.yaml", words=["gone.yaml", "No such file"])
        self.assert_refused(
            "sweep", self.write("vary: {contact.wall_friction: 1}\n"),
            words=["sweep.yaml", "contact.wall_friction", "list of values"],
        )
        sweep = self.write("set: {run.until: 0.01}\nvary: {contact.wall_friction: [0.2]}\n")
        self.run_well("sweep", sweep)
        self.case.write_text(CASE.replace("restitution: 0.5", "restitution: 0.6"))
        self.assert_refused("sweep", sweep, words=["the case has changed since"])


if __name__ == "__main__":
    program.main()
