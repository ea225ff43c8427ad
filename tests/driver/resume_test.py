#!/usr/bin/env python3
"""`thalweg run --resume`, which begins a run or goes on with it by what the folder holds, and `thalweg stop` of a run
that is not going.

Called by ctest: resume_test.py THALWEG MPIEXEC [unittest arguments]
"""
import json
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import SLIDING_GRAINS, THALWEG, ProgramTest, contents_below, files_below

ASKED_TO_STOP = 4   # exit code


class Resuming(ProgramTest):
    CASE = SLIDING_GRAINS + """
run: {until: 0.02, time_step: 0.5e-5}
output: {series: {every: 0.001}, checkpoint: {every: 0.005, keep: 2}}
"""
    FOLDERS = ("run", "tau[0.05] of bed", "run*", "-n")   # the last needs --out=

    def resume(self, *more, out="run", ranks=0):
        return self.run_well("run", self.case, f"--out={out}", "--resume", *more, ranks=ranks)

    def assert_left_alone(self, result, before, out="run"):
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"{out} is finished: nothing to do", result.stdout)
        self.assertEqual((files_below(self.folder), contents_below(self.folder)), before)

    def state(self):
        return files_below(self.folder), contents_below(self.folder)

    def test_a_run_that_goes_on_from_another_saves_its_start(self):
        self.run_well("run", self.case, "--out", "first", "--until", "0.01")
        onward = ("--restart", "first", "--set", "gravity.slope=0.5", "--set", "output.checkpoint.every=0")
        self.run_well("run", self.case, "--out", "whole", *onward)
        self.run_well("run", self.case, "--out", "killed", *onward)
        start, *late = sorted(self.folder.glob("killed/checkpoints/step_*.h5"))
        for file in (*late, self.folder / "killed/summary.json"):
            file.unlink()   # as before its first checkpoint
        self.assertEqual(start.name, self.last_checkpoint("first").name)
        said = self.resume(*onward[2:], out="killed").stdout
        self.assertIn(f"resuming from killed/checkpoints/{start.name}", said)
        self.assertEqual(self.last_checkpoint("killed").read_bytes(), self.last_checkpoint("whole").read_bytes())
        self.assertEqual((self.folder / "killed/series.csv").read_text(), (self.folder / "whole/series.csv").read_text())
        # Where not even the start has been saved, there is nothing to begin again from.
        self.run_well("run", self.case, "--out", "killed", "--overwrite", *onward)
        for file in (*self.folder.glob("killed/checkpoints/*"), *self.folder.glob("killed/bed.h5"),
                     self.folder / "killed/summary.json"):
            file.unlink()
        self.assert_refused("run", self.case, "--out", "killed", "--resume", *onward[2:], words=["--restart", "--overwrite"])

    def test_begins_goes_on_and_leaves_alone_in_any_folder(self):
        self.run_well("run", self.case, "--out", "straight")
        straight = self.last_checkpoint("straight").read_bytes()
        for out in self.FOLDERS:
            said = self.resume("--until", "0.008", out=out).stdout
            self.assertNotIn("resuming", said)
            said = self.resume(out=out, ranks=2).stdout   # to the later end of the case
            self.assertIn(f"resuming from {out}/checkpoints/step_32.h5", said)
            self.assertEqual(self.last_checkpoint(out).read_bytes(), straight)
            before = self.state()
            for more in ((), ("--until", "0.02"), ("--until", "0.01"), ("--set", "run.until=+0.02")):
                self.assert_left_alone(self.resume(*more, out=out), before, out)
            self.assert_left_alone(self.resume(out=out, ranks=2), before, out)

    def test_a_finished_run_without_checkpoints_is_left_alone(self):
        self.resume()
        for removed in ("checkpoints/step_80.h5", "checkpoints/step_60.h5", "checkpoints/latest"):
            path = self.folder / "run" / removed
            if path.exists():
                path.unlink()
        for _ in range(2):   # without any checkpoint, and without their folder
            for path in (self.folder / "run/checkpoints").glob("*"):
                path.unlink()
            before = self.state()
            self.assert_left_alone(self.resume(), before)
            self.assert_refused("run", self.case, "--out", "run", "--resume", "--until", "0.03",
                                words=["has not reached 0.03 s", "its checkpoints have been removed", "left alone"])
            (self.folder / "run/bed.h5").unlink(missing_ok=True)
            if (self.folder / "run/checkpoints").exists():
                (self.folder / "run/checkpoints").rmdir()

    def test_what_was_killed_goes_on_or_begins_again(self):
        self.resume("--until", "0.01")
        run, straight = self.folder / "run", self.last_checkpoint("run").read_bytes()
        # Killed between the last checkpoint and the summary, and after a crash that left half a summary.
        for text in (None, '{"finished": tr', ""):
            (run / "summary.json").unlink()
            if text is not None:
                (run / "summary.json").write_text(text)
            self.assertIn("resuming from run/checkpoints/step_40.h5", self.resume("--until", "0.01").stdout)
            self.assertTrue(self.summary("run")["finished"])
            self.assertEqual(self.last_checkpoint("run").read_bytes(), straight)
        # Killed between the first checkpoint and `latest`.
        (run / "summary.json").unlink()
        (run / "checkpoints/latest").unlink()
        self.assertIn("resuming from", self.resume("--until", "0.01").stdout)
        # Killed before its first checkpoint.
        for name in ("summary.json", "bed.h5"):
            (run / name).unlink()
        for path in (run / "checkpoints").glob("*"):
            path.unlink()
        (run / "checkpoints/step_20.h5.partial").write_text("half")
        (run / "notes.txt").write_text("mine")
        self.assertIn("ended before its first checkpoint; starting again", self.resume("--until", "0.01").stdout)
        self.assertEqual(self.last_checkpoint("run").read_bytes(), straight)
        self.assertEqual((run / "notes.txt").read_text(), "mine")

    def test_an_unfinished_run_whose_checkpoints_were_removed_is_not_replaced(self):
        self.resume("--until", "0.01")
        (self.folder / "run/summary.json").unlink()
        shutil.rmtree(self.folder / "run/checkpoints")
        self.assert_refused(
            "run", self.case, "--out", "run", "--resume", words=["its checkpoints have been removed", "--overwrite"]
        )
        (self.folder / "run/bed.h5").unlink()   # as a system without grains has none
        self.assert_refused("run", self.case, "--out", "run", "--resume", words=["its checkpoints have been removed"])

    def test_what_is_no_run_or_cannot_go_on_is_refused(self):
        self.assert_refused(
            "run", self.case, "--out", "run", "--resume", "--set", "grains.0.density=-1", words=["grains.0.density"]
        )
        self.assert_refused("run", "nowhere.yaml", "--out", "run", "--resume", words=["nowhere.yaml"])
        self.assert_refused("run", self.case, "--resume", "--restart", "run", words=["--resume", "--restart"])
        self.assert_refused("run", self.case, "--resume", "--overwrite", words=["--resume", "--overwrite"])
        (self.folder / "run").mkdir()
        (self.folder / "run/notes.txt").write_text("mine")
        self.assert_refused("run", self.case, "--out", "run", "--resume", words=["not a run of Thalweg"])
        (self.folder / "run/notes.txt").unlink()
        self.resume("--until", "0.01")
        self.assert_refused("run", self.case, "--out", "run", "--resume", "--set", "grains.0.density=2650",
                            words=["grains.0.density"])
        # The run is finished at 0.01 s, which is no answer to an end that is no number.
        self.assert_refused("run", self.case, "--out", "run", "--resume", "--set", "run.until=0.01abc",
                            words=["run.until"])

    def test_the_folder_beside_the_case(self):
        self.run_well("run", self.case, "--resume", "--until", "0.005")
        self.assertIn("resuming", self.run_well("run", self.case, "--resume").stdout)
        self.assertTrue(self.summary("run")["finished"])

    def unfinished(self):
        """A run that has come to the end of its wall time, as its folder tells."""
        self.resume("--until", "0.01")
        summary = self.summary("run") | {"finished": False, "reason": "the wall time is nearly up"}
        (self.folder / "run/summary.json").write_text(json.dumps(summary))

    def test_a_stop_between_two_runs_ends_the_next_once(self):
        self.unfinished()
        said = self.run_well("stop", "run").stdout
        self.assertIn(
            "run is not running now. A queued job that would resume it (thalweg run --resume) will end at once", said
        )
        self.assertIn("rm run/stop", said)
        for ranks in (2, 0):
            if not (self.folder / "run/stop").exists():
                self.run_well("stop", "run")
            stopped = self.thalweg("run", self.case, "--out", "run", "--resume", ranks=ranks)
            self.assertEqual(stopped.returncode, ASKED_TO_STOP, stopped.stderr)
            self.assertIn(
                "run: thalweg stop was given after the last run had ended, so this one does not start; repeat the "
                "command to continue the run", stopped.stdout,
            )
        self.assertIn("resuming", self.resume().stdout)
        self.assertTrue(self.summary("run")["finished"])
        self.assertIn("run has ended", self.run_well("stop", "run").stdout)
        self.assertFalse((self.folder / "run/stop").exists())

    def test_advice_can_be_pasted_whatever_the_name_of_the_folder(self):
        folder = "tau[0.05] of bed, 'fein' ü"
        words = shlex.quote(folder)
        first = self.run_well("run", self.case, "--out", folder, "--until", "0.01", ranks=2).stdout
        advice = [line for line in first.splitlines() if "thalweg stop" in line][0]
        self.assertEqual(
            shlex.split(advice.split("to stop early: ")[1].split(" (after")[0]), ["thalweg", "stop", folder]
        )
        self.assert_refused(
            "run", self.case, "--out", folder, words=["continue it with --restart 'tau[0.05] of bed, '\\''fein'\\'' "]
        )
        self.assertEqual(subprocess.run(f"{THALWEG} run {self.case} --restart {words}", shell=True, cwd=self.folder,
                                        stdout=subprocess.DEVNULL).returncode, 0)
        sweep = self.folder / "my sweep.yaml"
        sweep.write_text("case: case.yaml\nvary: {}\n")
        self.assert_refused("run", sweep, words=[f"thalweg sweep '{sweep}' makes"])

    def test_who_restarts_by_hand_means_it(self):
        self.unfinished()
        self.run_well("stop", "run")
        self.assertIn("resuming", self.run_well("run", self.case, "--restart", "run").stdout)
        self.assertFalse((self.folder / "run/stop").exists())


if __name__ == "__main__":
    program.main(side_by_side=True)
