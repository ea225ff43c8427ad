#!/usr/bin/env python3
"""The program as its user meets it: exit codes, messages, files, signals, restarts.

Called by ctest: program_test.py THALWEG MPIEXEC [unittest arguments]
"""
import csv
import json
import os
import signal
import subprocess
import sys
import time
import unittest.mock
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
import program
import thalweg
from thalweg import transport
from program import ProgramTest, files_below

# 40 grains tumbling down a bumpy slope: contacts, walls, periodic sides and, on several ranks, migration.
CASE = """
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


# As on the login nodes of some clusters: there is no such way to send messages, for Open MPI and for MPICH's libraries.
NO_MPI = {"OMPI_MCA_pml": "none_such", "FI_PROVIDER": "none_such", "UCX_TLS": "none_such"}


class DryGrains(ProgramTest):
    CASE = CASE


class CommandLine(DryGrains):
    def test_help_and_version(self):
        self.assertIn("mpirun -n 8 thalweg run", self.run_well("--help").stdout)
        self.assertRegex(self.run_well("--version").stdout, r"^thalweg \d+\.\d+\.\d+")
        self.assertIn("--walltime", self.run_well("run", "--help").stdout)

    def test_analyze_says_what_the_sediment_does(self):
        self.run_well("run", self.case, "--out", "run")
        said = self.run_well("analyze", "run", "--from", "0.06").stdout
        self.assertRegex(said, r"transport  q_s = [-0-9.e]+ \+- [0-9.e-]+ m\^2/s")   # no q* without a fluid
        self.assertTrue((self.folder / "run/analysis/layers.csv").exists())
        self.assertIn("--until SECONDS", self.run_well("analyze", "--help").stdout)
        self.assert_refused("analyze", "nowhere", words=["nowhere", "case.yaml"])

    def assert_one_mean(self, out):
        """run.log, summary.json and `thalweg analyze` say the same. Returns transport_rate of summary.json."""
        log = (self.folder / out / "run.log").read_text()
        said = self.run_well("analyze", out).stdout
        sentences = [line.split("transport: ")[1] for line in log.splitlines() if "transport: " in line][-2:]
        self.assertEqual(len(sentences), 2, log)
        self.assertEqual([line.removeprefix("transport").strip() for line in said.splitlines() if line.startswith("transport")],
                         sentences)
        of_run = self.summary(out)["transport_rate"]
        analyzed = json.loads((self.folder / out / "analysis/summary.json").read_text())
        for name, value in (("q_s_mean", "mean"), ("q_s_error", "error"), ("q_s_deviation", "deviation"),
                            ("q_s_independent", "independent"), ("q_s_drift", "drift"), ("q_s_drift_error", "drift_error")):
            self.assertEqual(analyzed["q_s"][value], of_run[name], name)
        self.assertEqual(analyzed["moving_grains"], {"mean": of_run["moving_grains_mean"], "error": of_run["moving_grains_error"]})
        return of_run

    def test_the_run_and_its_reader_agree_on_mean_error_and_what_is_steady(self):
        # 26 rows; 501; 25 of a run that ends between two rows.
        self.run_well("run", self.case, "--out", "run")
        self.run_well("run", self.case, "--out", "fine", "--set", "output.series.every=2e-4", "--set",
                      "analysis.transport_rate.from=0")
        self.run_well("run", self.case, "--out", "early", "--until", "0.0994")
        for out, count in (("run", 26), ("fine", 501), ("early", 25)):
            of_run = self.assert_one_mean(out)
            # The same from the rows of series.csv, which hold every digit.
            run = thalweg.Run(self.folder / out)
            rate = transport.transport(run, run.averaged_from("transport_rate"))
            self.assertEqual((rate.measurements, of_run["measurements"]), (count, count))
            for name, value in (("mean", rate.rate.mean), ("error", rate.rate.error), ("deviation", rate.rate.deviation),
                                ("independent", rate.rate.independent), ("drift", rate.verdict.drift),
                                ("drift_error", rate.verdict.error)):
                self.assertAlmostEqual(value / of_run[f"q_s_{name}"], 1.0, 11, (out, name))
            self.assertEqual(of_run["steady"] == 1, rate.verdict.steady is True)
        # Where a restart has changed the interval the run's mean begins anew; where it measures more often than there are rows,
        # these are too few: the numbers are still those of the run.
        self.run_well("run", self.case, "--out", "early", "--restart", "early", "--until", "0.15", "--set",
                      "output.series.every=1e-3")
        self.assertLess(self.assert_one_mean("early")["measurements"], 53)
        self.run_well("run", self.case, "--out", "often", "--set", "analysis.transport_rate.every=2e-4")
        self.assertEqual(self.assert_one_mean("often")["measurements"], 251)

    def test_on_several_ranks_only_one_speaks(self):
        self.assertEqual(self.run_well("--version", ranks=2).stdout.count("thalweg"), 1)
        self.assertEqual(self.run_well("defaults", ranks=2).stdout.count("system: resolved  "), 1)
        self.assertEqual(self.run_well("check", self.case, ranks=2).stdout.count("tumbling grains"), 1)

    def test_answers_where_mpi_cannot_start(self):
        with unittest.mock.patch.dict(os.environ, NO_MPI):
            self.assertNotEqual(self.thalweg("run", self.case).returncode, 0)   # the only command that needs MPI
            self.run_well("--help")
            self.run_well("defaults", "fluid")
            self.assert_refused("fly", words=["fly"])
            self.assertIn("tumbling grains", self.run_well("check", self.case).stdout)
            self.assert_refused("check", self.case, "--set", "grains.0.diameter=-0.005", words=["grains.0.diameter"])
            self.assert_refused("info", "nowhere", words=["nowhere"])

    def test_reads_a_run_where_mpi_cannot_start(self):
        self.run_well("run", self.case, "--out", "run")
        with_mpi = self.run_well("info", "run").stdout
        placed = ["--set", "grains.0={placement: {file: run/bed.h5}}"]
        bed = self.run_well("check", self.case, *placed).stdout
        with unittest.mock.patch.dict(os.environ, NO_MPI):
            self.assertEqual(self.run_well("info", "run").stdout, with_mpi)
            self.assertIn("grains/position", with_mpi)
            without_speed = [line for line in bed.splitlines() if not line.startswith("time ")]
            again = self.run_well("check", self.case, *placed).stdout
            self.assertEqual([line for line in again.splitlines() if not line.startswith("time ")], without_speed)
            self.assertIn("40 of", again)

    def test_wrong_words(self):
        self.assert_refused("fly", words=["fly"])
        self.assert_refused(words=["--help"])
        self.assert_refused("run", words=["CASE.yaml"])
        self.assert_refused("run", self.case, "--layout", "2,x,1", words=["--layout", "2,x,1"])
        self.assert_refused("run", self.case, "--walltime", "soon", words=["--walltime", "soon"])

    def test_cases_that_cannot_be_run(self):
        self.assert_refused("run", "missing.yaml", words=["missing.yaml"])
        for command in ("run", "check"):
            self.assert_refused(command, self.case, "--set", "gravity.magnitde=9.8", words=["magnitde"])
            self.assert_refused(command, self.case, "--set", "grains.0.diameter=-0.005", words=["grains.0.diameter"])
            self.assert_refused(command, self.case, "--set", "grains.0.density=heavy",
                                words=["grains.0.density", "heavy"])
            self.assert_refused(command, self.case, "--set", "grains.0.count=4000", words=["grains.0"])
            self.assert_refused(command, self.case, "--set", "run.time_step=1e-3", words=["time"])
            self.assert_refused(command, self.case, "--set", "gravity.slope=", words=["gravity.slope=", "null to take"])
            (self.folder / "slopes.yaml").write_text("case: case.yaml\nvary: {gravity.slope: [0.1, 0.2]}\n")
            self.assert_refused(command, "slopes.yaml", words=["this is a sweep", "thalweg sweep slopes.yaml"])
        self.assert_refused("check", self.case, "--ranks", "0", words=["--ranks: 0 is no number above 0"])
        self.assert_refused("run", self.case, "--layout", "2,1,1", words=["--layout", "2 rank"])
        self.assert_refused("run", self.case, "--restart", "nowhere", words=["nowhere"])

    def test_cases_that_cannot_be_run_on_two_ranks(self):
        self.assert_refused("run", self.case, "--set", "grains.0.diameter=-0.005", words=["grains.0.diameter"], ranks=2)
        self.assert_refused("run", self.case, "--layout", "1,1,1", words=["--layout"], ranks=2)
        self.assert_refused("run", self.case, "--set", "grains.0.count=4000", words=["grains.0"], ranks=2)

    def test_defaults_are_a_case(self):
        text = self.run_well("defaults", "grains").stdout
        (self.folder / "defaults.yaml").write_text(text)
        self.run_well("check", "defaults.yaml")
        self.assert_refused("defaults", "plasma", words=["plasma"])
        section = self.run_well("defaults", "grains.contact").stdout
        self.assertIn("\ncontact: ", section)
        self.assertNotIn("\nrun:", section)

    def test_check_plans_other_numbers_of_ranks(self):
        """The rows of the table; what is in them is the business of rank_cost_test."""
        for ranks in (0, 2):
            report = self.run_well("check", self.case, "--ranks", "1,2,4", ranks=ranks).stdout
            self.assertEqual(report.count("tumbling grains"), 1)
            self.assertIn(f"measured on {max(1, ranks)} core", report)
            rows = [line.split() for line in report.splitlines()[-3:]]
            # ranks; layout x, y and z between signs; cells; grains; ghosts; memory; messages; bytes sent; ms a step
            for row, number in zip(rows, (1, 2, 4)):
                self.assertEqual(int(row[0]), number)
                self.assertEqual(int(row[1]) * int(row[3]) * int(row[5]), number)
                self.assertEqual(int(row[7]), 40 // number)
                self.assertGreater(float(row[14]), 0.0)
            self.assertEqual((rows[0][8], rows[0][11]), ("0", "0"))
        self.assert_refused("check", self.case, "--ranks", "0", words=["--ranks"])
        self.assert_refused("check", self.case, "--ranks", "1000000", words=["ranks"])

    def test_what_the_machine_has_no_memory_for_is_refused(self):
        """Of 1.6e10 cells, 1.2 TB in their populations alone: check says so below its report, and run before it starts."""
        channel = str(Path(__file__).resolve().parents[2] / "cases/clear_channel/case.yaml")
        huge = ("--set", "domain.size=[2, 1, 1]", "--set", "domain.spacing=0.5e-3", "--set", "fluid.time_step=2e-5")
        checked = self.thalweg("check", channel, *huge)
        self.assertEqual(checked.returncode, 2)
        self.assertRegex(checked.stdout, r"memory +about .* more than the .* of this machine")
        self.assertRegex(checked.stderr, r"the run takes about .* of memory.*: take at least \d+ such nodes")
        for ranks in (0, 2):
            ran = self.thalweg("run", channel, *huge, "--out", "run", ranks=ranks)
            self.assertEqual(ran.returncode, 2)
            self.assertRegex(ran.stderr, r"take at least \d+ such nodes")
        self.assertEqual(files_below(self.folder), ["case.yaml"])

    def test_a_run_says_what_memory_it_held(self):
        self.run_well("run", self.case)
        summary = self.summary("run")
        self.assertGreater(summary["memory_bytes"], 1e7)
        self.assertLessEqual(summary["memory_bytes_of_largest_rank"], summary["memory_bytes"])
        self.assertRegex((self.folder / "run/run.log").read_text(), r"\nmemory: \d.* on all ranks, at most \d")

    def test_check_says_what_a_case_means(self):
        report = self.run_well("check", self.case).stdout
        self.assertEqual(files_below(self.folder), ["case.yaml"])
        # Pair of 5 mm spheres of 2550 kg/m^3, e = 0.8: omega_0 = sqrt(k/(m/2)), zeta = 0.0709 (attraction) or so:
        # t_c = pi/omega_0 = 2.029e-4 s within 1 %; in sub-steps of 4e-6 s: 50.9.
        self.assertRegex(report, r"contact +lasts 0\.00020[2-5] s: 5[01]\.\d sub-steps of 4e-06 s")
        # 0.1 s in steps of 50 * 4e-6 s, 40 grains with 50 sub-steps each.
        self.assertRegex(report, r"work +500 steps to 0\.1 s, 1e\+06 grain-steps")


class Running(DryGrains):
    def test_a_run_leaves_a_complete_folder_and_is_not_overwritten(self):
        result = self.run_well("run", self.case)
        run = self.folder / "run"
        for name in ("case.yaml", "run.log", "series.csv", "grains.pvd", "summary.json"):
            self.assertTrue((run / name).is_file(), name)
        summary = self.summary("run")
        self.assertTrue(summary["finished"])
        self.assertEqual(summary["steps"], 500)
        self.assertEqual(summary["grains"], 40)
        self.assertAlmostEqual(summary["simulated_time"], 0.1, delta=1e-12)
        self.assertGreater(summary["grain_steps_per_second"], 0)
        self.assertAlmostEqual(sum(p["share"] for p in summary["phases"].values()), 1.0, delta=0.05)
        self.assertNotIn("phase", result.stdout)  # for the log only
        self.assertIn("\nphase ", (run / "run.log").read_text())
        # A row every 2 ms from 0 to 0.1 s; the mean over the rows from 0.05 s on.
        lines = (run / "series.csv").read_text().splitlines()
        header = [column.split(" [")[0] for column in lines[0].split(",")]
        rows = [[float(x) for x in line.split(",")] for line in lines[1:]]
        self.assertEqual(len(rows), 51)
        fluxes = [row[header.index("q_s")] for row in rows if row[0] > 0.0499]
        self.assertEqual(len(fluxes), 26)
        mean = sum(fluxes) / len(fluxes)
        self.assertAlmostEqual(summary["transport_rate"]["q_s_mean"], mean, delta=1e-12 * abs(mean))
        self.assertGreater(mean, 0)
        self.assertEqual(len(list((run / "checkpoints").glob("*.h5"))), 2)

        before = (run / "summary.json").read_bytes()
        self.assert_refused("run", self.case, words=["--overwrite", "--restart"])
        self.assertEqual((run / "summary.json").read_bytes(), before)
        self.run_well("run", self.case, "--overwrite", "--until", "0.01", "--set", "analysis.transport_rate={}")
        self.assertEqual(self.summary("run")["steps"], 50)

        self.assertIn("finished", self.run_well("info", run).stdout)
        self.assertIn("step 50", self.run_well("info", self.last_checkpoint("run")).stdout)
        self.assert_refused("info", self.case, words=["case.yaml"])

    def test_info_reads_only_the_end_of_a_long_log(self):
        self.run_well("run", self.case, "--until", "0.01")
        with open(self.folder / "run/run.log", "r+b") as log:
            log.truncate(2**31)   # takes no room on the disk, and would take it in memory
            log.seek(0, os.SEEK_END)
            log.write(b"\nnow\n")
        process = subprocess.Popen(self.command(["info", "run"], 0), cwd=self.folder, stdout=subprocess.PIPE, text=True)
        with process.stdout:
            self.assertIn("last line   now\n", process.stdout.read())
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0)
        self.assertLess(used.ru_maxrss, 2**20)   # KiB

    def test_the_case_as_run_runs_again_with_the_same_bits(self):
        self.run_well("run", self.case, "--out", "a", "--until", "0.01", "--set", "analysis.transport_rate.from=0.004")
        self.run_well("run", "a/case.yaml", "--out", "b")
        self.assertEqual(self.last_checkpoint("a").read_bytes(), self.last_checkpoint("b").read_bytes())

    def test_the_same_bits_on_any_ranks_and_layout(self):
        self.run_well("run", self.case, "--out", "one")
        reference = self.last_checkpoint("one").read_bytes()
        series = (self.folder / "one" / "series.csv").read_bytes()
        for ranks, layout in ((2, "2,1,1"), (2, "1,1,2"), (4, "2,2,1")):
            out = "on_" + layout.replace(",", "x")
            self.run_well("run", self.case, "--out", out, "--layout", layout, ranks=ranks)
            self.assertEqual(self.summary(out)["ranks"], ranks)
            self.assertEqual(self.last_checkpoint(out).read_bytes(), reference, out)
            self.assertEqual((self.folder / out / "series.csv").read_bytes(), series, out)

    def test_observers_and_output_do_not_touch_the_run(self):
        self.run_well("run", self.case, "--out", "watched")
        self.run_well("run", self.case, "--out", "alone", "--set", "output.series.every=0", "--set",
                      "output.grains.every=0", "--set", "output.checkpoint.every=0")
        import h5py
        with h5py.File(self.last_checkpoint("watched")) as a, h5py.File(self.last_checkpoint("alone")) as b:
            names = []
            a.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
            self.assertTrue(any("position" in name for name in names))
            for name in names:
                if name.startswith("transport_rate/"):   # what the observer remembers of what it saw
                    continue
                self.assertEqual(a[name][()].tobytes(), b[name][()].tobytes(), name)

    def test_a_table_of_runs(self):
        self.run_well("run", self.case, "--out", "a", "--set", 'name="fast, loose"')
        self.run_well("run", self.case, "--out", "b", "--until", "0.02", "--set", "analysis={}")
        self.run_well("run", self.case, "--out", "c", "--until", "0.02")
        (self.folder / "c/summary.json").unlink()   # as while it goes on
        header, *rows = csv.reader(self.run_well("info", "--csv", "a", "b", "c").stdout.splitlines())
        a, b, c = (dict(zip(header, row)) for row in rows)
        self.assertEqual([row["run"] for row in (a, b, c)], ["a", "b", "c"])
        self.assertEqual((a["state"], a["name"], b["state"]), ("finished", "fast, loose", "finished"))
        self.assertIn("not running: it was killed", c["state"])
        self.assertEqual(set(c.values()), {"c", c["state"], ""})
        summary = self.summary("b")
        self.assertEqual(float(b["reference_diameter [m]"]), summary["reference_diameter"])
        self.assertEqual(float(b["bed.porosity"]), summary["bed"]["porosity"])
        self.assertFalse(any(name.startswith(("phases", "units")) for name in header))
        (self.folder / "notes.txt").write_text("not a run\n")
        self.assertEqual(self.run_well("info", "--csv", "a", "notes.txt").stdout.count("\n"), 2)
        self.assert_refused("info", "a", "b", words=["--csv"])
        self.assert_refused("info", "--csv", "a", "nowhere", words=["nowhere"])

    def test_a_failed_run_says_so_and_keeps_its_checkpoint(self):
        # A grain held at 1 m/s leaves the box through its top, 0.02 m away, after about 0.02 s.
        grain = "[{count: 1, diameter: 5.0e-3, density: 2550, placement: {positions: [[0.02, 0.01, 0.02]]}," \
                " prescribed_velocity: [0, 0, 1]}]"
        for ranks in (0, 2):
            out = f"on_{ranks}"
            result = self.thalweg("run", self.case, "--out", out, "--set", "grains=" + grain, "--set",
                                  "output.checkpoint.every=0.01", ranks=ranks)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertEqual(len([line for line in result.stderr.splitlines() if line.startswith("thalweg: ")]), 1)
            self.assertNotIn("MPI_ABORT", result.stderr)
            summary = self.summary(out)
            self.assertFalse(summary["finished"])
            self.assertIn("rain 0", summary["reason"])
            self.assertEqual(self.last_checkpoint(out).name, "step_100.h5")

    def test_what_a_crash_has_left_without_summary_is_finished(self):
        """The last step of a run lies beyond an end that is no whole number of steps."""
        self.run_well("run", self.case, "--out", "run", "--until", "0.020003")
        (self.folder / "run/summary.json").unlink()
        self.run_well("run", self.case, "--out", "run", "--until", "0.020003", "--restart", "run")
        self.assertTrue(self.summary("run")["finished"])
        self.assert_refused("run", self.case, "--until", "0.02", "--restart", "run", words=["0.0202 s already", "--until"])

    def test_goes_on_when_nobody_reads_what_it_says(self):
        reader, writer = os.pipe()
        os.close(reader)
        run = subprocess.run(self.command(("run", self.case, "--out", "run"), 0), stdout=writer, stderr=writer, cwd=self.folder,
                             timeout=120)
        os.close(writer)
        self.assertEqual(run.returncode, 0)
        self.assertTrue(self.summary("run")["finished"])
        self.assertIn("finished at 0.1 s", (self.folder / "run/run.log").read_text())

    def test_says_that_ranks_outnumber_cores(self):
        """Two ranks on one core, which mpirun does not notice."""
        core = str(min(os.sched_getaffinity(0)))
        for yields in ("0", "1"):
            command = self.command(("run", self.case, "--until", "2e-4", "--overwrite"), 2)
            result = subprocess.run(["taskset", "-c", core] + command, cwd=self.folder, capture_output=True, text=True,
                                    timeout=120, env=os.environ | {"OMPI_MCA_mpi_yield_when_idle": yields})
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual("2 ranks share 1 core of a node" in result.stdout, yields == "0", result.stdout)


# Grains that never come to rest: no gravity, no loss in contacts along the normal, no friction.
PERPETUAL = CASE.replace("slope: 0.5", "slope: 0").replace("magnitude: 9.8", "magnitude: 0") \
    .replace("restitution: 0.8, friction: 0.5", "restitution: 1, friction: 0, wall_friction: 0") \
    .replace("seed: 3}}", "seed: 3}, velocity: [0.1, 0, 0]}\n"
             "  - {count: 10, diameter: 6.0e-3, density: 2550, placement: {pattern: random},"
             " velocity: [-0.2, 0.1, 0.1]}") \
    .replace("{from: 0.05}", "{from: 0}").replace("every: 0.04", "every: 100").replace("every: 0.02", "every: 20") \
    .replace("every: 2.0e-3", "every: 0.1")


class Stopping(DryGrains):
    LONG = ("--until", "10000")

    def setUp(self):
        super().setUp()
        self.case.write_text(PERPETUAL)

    def start(self, *arguments, ranks=0, patience=5):
        """A run that would take hours, once it has begun to report."""
        command = self.command(("run", self.case) + self.LONG + arguments, ranks)
        # Open MPI's mpirun answers SIGTERM by passing it on after one second and killing after another; a busy machine
        # needs more.
        patient = os.environ | {"OMPI_MCA_odls_base_sigkill_timeout": str(patience)}
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True, env=patient)
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
        self.assertEqual(self.last_checkpoint("run").read_bytes(), self.last_checkpoint("straight").read_bytes())
        self.assertEqual((self.folder / "run" / "series.csv").read_text(),
                         (self.folder / "straight" / "series.csv").read_text())
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
        self.assertRegex(log, r"to stop early: thalweg stop \S+ \(after Ctrl-C or SIGTERM mpirun leaves only 10 s to save\)")
        self.assertIn("SIGCONT, as mpirun sends it before it kills: saving\n", log)
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
            self.assertIn("going on from", self.run_well("run", self.case, "--restart", "run", "--until", "1").stdout)
        else:
            self.assert_refused("run", self.case, "--restart", "run", words=["has no checkpoint"])

    def stop_by_command(self, ranks):
        process = self.start(ranks=ranks)
        self.assertIn("run saves its state and ends within a step; the command of the run with --restart run", self.run_well("stop", "run").stdout)
        self.assertEqual(process.wait(timeout=30), 4)
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
    program.main()
