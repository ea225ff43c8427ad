#!/usr/bin/env python3
"""Runs whose disk is full, or whose folder cannot be written: what they say, how they end, and what is left.

Called by ctest: full_disk_run_test.py THALWEG MPIEXEC [unittest arguments]. The full disk is a small file system in
memory, for which the test has to be allowed to mount one; it is skipped otherwise.
"""
import os
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import SLIDING_GRAINS, ProgramTest

CASE = SLIDING_GRAINS + """
run: {until: 0.2, time_step: 1.0e-5}
output: {series: {every: 0.001}, checkpoint: {every: 0.02, keep: 2}, grains: {every: 0.003}}
"""


class SmallDisks(ProgramTest):
    CASE = CASE

    def mount(self, kilobytes, options=""):
        """A file system of its own; the test is skipped where that is not allowed."""
        disk = self.folder / f"disk_{kilobytes}"
        disk.mkdir()
        mounted = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k{options}", "none", disk], capture_output=True, text=True
        )
        if mounted.returncode != 0:
            self.skipTest(f"no file system can be mounted here: {mounted.stderr.strip()}")
        self.addCleanup(subprocess.run, ["umount", disk], check=True)
        return disk


class FullDisk(SmallDisks):
    def test_the_first_file_that_fails_is_named_and_the_last_good_checkpoint_stays(self):
        self.run_well("run", self.case, "--out", "whole")
        failed, with_summary = set(), 0
        for kilobytes in (60, 100, 124, 132, 148, 172):   # all files of the run take more than 200
            with self.subTest(kilobytes=kilobytes):
                disk = self.mount(kilobytes)
                run = disk / "run"
                result = self.thalweg("run", self.case, "--out", run, ranks=2)
                self.assertEqual(result.returncode, 1, result.stderr + result.stdout)
                said = [line for line in result.stderr.splitlines() if line.startswith("thalweg: ")]
                self.assertEqual(len(said), 1, result.stderr)
                named = re.search(r"run/(\S+): cannot write", said[0])
                self.assertIsNotNone(named, said[0])
                self.assertNotIn("summary.json", said[0])
                failed.add(re.sub(r"\d+", "", named[1]))
                if (run / "summary.json").exists():
                    with_summary += 1
                    summary = self.summary(run)
                    self.assertFalse(summary["finished"])
                    self.assertIn(named[0], summary["reason"])
                self.assertEqual([path.name for path in run.rglob("*.partial")], [])
                if not any((run / "checkpoints").glob("step_*.h5")):
                    self.assertIn("There is no checkpoint to restart from", said[0])
                    continue
                good = re.search(r"The last good checkpoint is (\S+)\.$", said[0])
                self.assertIsNotNone(good, said[0])
                self.assertTrue(Path(good[1]).is_file())
                # And it is good: on a larger disk the run goes on to the same end.
                subprocess.run(["mount", "-o", "remount,size=2m", disk], check=True)
                self.run_well("run", self.case, "--restart", run)
                self.assert_same_bed("whole", run)
                self.assertEqual(list(self.series("whole")["time"]), list(self.series(run)["time"]))
        self.assertGreater(len(failed), 1, failed)   # not always the same file
        self.assertGreater(with_summary, 0)


class NoPermission(SmallDisks):
    def test_a_place_where_no_folder_can_be_made_is_refused(self):
        # A file where a folder should be stops root as well as anyone else.
        (self.folder / "file").write_text("")
        for ranks in (0, 2):
            self.assert_refused("run", self.case, "--out", "file/run", ranks=ranks,
                                words=["file/run: cannot create the folder: Not a directory", "--out"])

    def test_a_folder_without_permission_is_refused(self):
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        locked = self.folder / "locked"
        locked.mkdir(mode=0o555)
        self.assert_refused("run", self.case, "--out", "locked/run",
                            words=["locked/run: cannot create the folder: Permission denied"])
        self.run_well("run", self.case, "--until", "0.05")
        for path, words in (
            ("run", "run: cannot write to the folder"), ("run/checkpoints", "run/checkpoints: cannot write to it"),
            ("run/run.log", "run/run.log: cannot write to it"),
        ):
            before = (self.folder / path).stat().st_mode
            (self.folder / path).chmod(0o555)
            self.assert_refused("run", self.case, "--restart", "run", words=[words, "Permission denied"])
            (self.folder / path).chmod(before)

    def test_what_may_not_be_read_is_named(self):
        if os.geteuid() == 0:
            self.skipTest("root may read everywhere")
        self.run_well("run", self.case, "--until", "0.05")
        checkpoint = "run/checkpoints/" + (self.folder / "run/checkpoints/latest").read_text().strip()
        (self.folder / checkpoint).chmod(0)   # an earlier one is no substitute for it
        result = self.thalweg("run", self.case, "--restart", "run", ranks=2)
        self.assertEqual(result.returncode, 2, result.stderr + result.stdout)
        self.assertIn(f"thalweg: {checkpoint}: cannot read the file: Permission denied.\n", result.stderr)
        for mode, command, path, why in (
            (0o311, "run", "case.yaml", "run: cannot list the folder: Permission denied."),
            (0, "check", "run/case.yaml", "run/case.yaml: cannot read the file: Permission denied."),
            (0, "run", "run/case.yaml", "run/case.yaml: cannot read the file: Permission denied."),
        ):
            (self.folder / "run").chmod(mode)
            result = self.thalweg(command, path)
            (self.folder / "run").chmod(0o755)
            self.assertEqual(result.stderr, f"thalweg: {why}\n")

    def test_a_file_system_that_is_read_only_is_refused(self):
        disk = self.mount(100, ",ro")
        self.assert_refused("run", self.case, "--out", disk / "run", ranks=2,
                            words=["disk_100/run: cannot create the folder: Read-only file system"])

    def test_a_run_whose_folder_has_become_read_only_is_refused(self):
        disk = self.mount(2000)
        run = disk / "run"
        self.run_well("run", self.case, "--out", run, "--until", "0.05")
        subprocess.run(["mount", "-o", "remount,ro", disk], check=True)
        for ranks in (0, 2):
            self.assert_refused("run", self.case, "--restart", run, ranks=ranks,
                                words=["disk_2000/run: cannot write to the folder: Read-only file system", "--out"])
        # Elsewhere it can go on from there.
        self.run_well("run", self.case, "--restart", run, "--out", "elsewhere", "--until", "0.06")


if __name__ == "__main__":
    program.main()
