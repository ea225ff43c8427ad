#!/usr/bin/env python3
"""`thalweg run`: the folder of a run, failures, and the same bits on any number of ranks.

Called by ctest: run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
import program
from program import TUMBLING_GRAINS, ProgramTest


class Running(ProgramTest):
    CASE = TUMBLING_GRAINS

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
        shorter = ("--until", "0.01005", "--set", "analysis.transport_rate={}")   # not a whole number of steps
        self.assertIn(" 51 steps to 0.01005 s", self.run_well("run", self.case, "--overwrite", *shorter).stdout)
        self.assertEqual(self.summary("run")["steps"], 51)

        self.assertIn("finished", self.run_well("info", run).stdout)
        self.assertIn("step 51", self.run_well("info", self.last_checkpoint("run")).stdout)
        self.assert_refused("info", self.case, words=["case.yaml"])

    def test_the_case_as_run_runs_again_with_the_same_bits(self):
        self.run_well("run", self.case, "--out", "a", "--until", "0.01", "--set", "analysis.transport_rate.from=0.004")
        self.run_well("run", "a/case.yaml", "--out", "b")
        self.assert_same_end("a", "b")

    def test_the_same_bits_on_any_ranks_and_layout(self):
        self.run_well("run", self.case, "--out", "one")
        for ranks, layout in ((2, "2,1,1"), (2, "1,1,2"), (4, "2,2,1")):
            out = "on_" + layout.replace(",", "x")
            self.run_well("run", self.case, "--out", out, "--layout", layout, ranks=ranks)
            self.assertEqual(self.summary(out)["ranks"], ranks)
            self.assert_same_end(out, "one", "series.csv")

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
        self.assert_refused(
            "run", self.case, "--until", "0.02", "--restart", "run", words=["0.0202 s already", "--until"]
        )

    def test_goes_on_when_nobody_reads_what_it_says(self):
        reader, writer = os.pipe()
        os.close(reader)
        run = subprocess.run(
            self.command(("run", self.case, "--out", "run"), 0), stdout=writer, stderr=writer, cwd=self.folder,
            timeout=120,
        )
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

    def test_a_run_says_what_memory_it_held(self):
        self.run_well("run", self.case)
        summary = self.summary("run")
        self.assertGreater(summary["memory_bytes"], 1e7)
        self.assertLessEqual(summary["memory_bytes_of_largest_rank"], summary["memory_bytes"])
        self.assertRegex((self.folder / "run/run.log").read_text(), r"\nmemory: \d.* on all ranks, at most \d")


if __name__ == "__main__":
    program.main()
