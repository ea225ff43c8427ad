#!/usr/bin/env python3
"""Provenance of a run: where and with what it ran, what it has read, and a run folder that can be repeated elsewhere.

Called by ctest: provenance_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import hashlib
import os
import socket
import sys
from datetime import datetime, timedelta, timezone
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import SLIDING_GRAINS, ProgramTest
from stl_box import write_box


class ProvenanceRun(ProgramTest):
    CASE = SLIDING_GRAINS + """
solids: [{stl: surfaces/sill.stl, scale: 1.0e-3}]
run: {until: 0.002}
output: {series: {every: 0.001}, checkpoint: {every: 0.001, keep: 3}}
"""
    BED = ("--set", "grains=[{placement: {file: bed/bed.h5}}]")

    def setUp(self):
        super().setUp()
        (self.folder / "tree/surfaces").mkdir(parents=True)
        self.case.rename(self.folder / "tree/case.yaml")
        self.case = self.folder / "tree/case.yaml"
        write_box(self.folder / "tree/surfaces/sill.stl", (0, -1, -1), (5, 31, 6))
        self.run_well("run", self.case, "--out", "tree/bed")
        self.run_well("run", self.case, "--out", "tree/runs/a", *self.BED)

    def test_what_the_summary_says(self):
        found = self.summary("tree/runs/a")["provenance"]
        self.assertLess(
            abs(datetime.now(timezone.utc) - datetime.fromisoformat(found["started"])), timedelta(minutes=10)
        )
        self.assertEqual((found["host"], found["nodes"]), (socket.gethostname(), 1))
        models = [
            line.split(": ", 1)[1].strip()
            for line in Path("/proc/cpuinfo").read_text().splitlines()
            if line.startswith("model name")
        ]
        self.assertEqual(found["processor"], models[0])
        self.assertRegex(found["compiler"], r"^(GNU|Clang) \d+\.")
        self.assertIn("-ffp-contract=off", found["compiler_flags"].split())
        self.assertFalse([flag for flag in found["compiler_flags"].split() if flag.startswith("-W")])
        self.assertRegex(found["mpi"] + found["hdf5"], r"\d\.\d")
        sums = {key: hashlib.sha256((self.folder / "tree" / file).read_bytes()).hexdigest()
                for key, file in (("grains.0.placement.file", "bed/bed.h5"), ("solids.0.stl", "surfaces/sill.stl"))}
        self.assertEqual(
            found["inputs"],
            [
                {
                    "key": "grains.0.placement.file", "path": "../../bed/bed.h5",
                    "sha256": sums["grains.0.placement.file"],
                }, {"key": "solids.0.stl", "path": "../../surfaces/sill.stl", "sha256": sums["solids.0.stl"]},
            ],
        )
        log, info = (self.folder / "tree/runs/a/run.log").read_text(), self.run_well("info", "tree/runs/a").stdout
        for word in (
            found["started"], found["host"], found["compiler"], found["compiler_flags"], found["mpi"], *sums.values(),
        ):
            self.assertIn(word, log)
            self.assertIn(word, info)
        self.assertNotIn("provenance", self.run_well("info", "--csv", "tree/runs/a").stdout)

    def test_a_folder_that_has_moved_with_its_inputs_is_repeated(self):
        before = (self.folder / "tree/runs/a/bed.h5").read_bytes()
        (self.folder / "tree").rename(self.folder / "elsewhere")
        kept = yaml.safe_load((self.folder / "elsewhere/runs/a/case.yaml").read_text())
        self.assertEqual(
            (kept["grains"][0]["placement"]["file"], kept["solids"][0]["stl"]),
            ("../../bed/bed.h5", "../../surfaces/sill.stl"),
        )
        os.symlink(self.folder / "elsewhere/runs/a", self.folder / "link")
        for number, case in enumerate(("elsewhere/runs/a/case.yaml", "link/case.yaml")):
            self.run_well("run", case, "--out", f"again/{number}")
            self.assertEqual((self.folder / f"again/{number}/bed.h5").read_bytes(), before)

    def test_a_restart_sees_the_same_surface(self):
        half = self.folder / "tree/runs/a/checkpoints"
        half = sorted(half.glob("step_*.h5"), key=lambda path: path.stat().st_mtime)[-2]
        for out in ("tree/runs/a", "tree/b"):
            said = self.run_well("run", self.case, "--out", out, *self.BED, "--restart", half).stdout
            self.assertNotIn("changed since then", said)
        write_box(self.folder / "tree/surfaces/other.stl", (0, -1, -1), (5, 31, 6))
        said = self.run_well(
            "run", self.case, "--out", "tree/c", *self.BED, "--restart", "tree/b", "--until", "0.003", "--set",
            "solids.0.stl=surfaces/other.stl",
        ).stdout
        self.assertIn("changed since then: solids.0.stl: ../surfaces/sill.stl -> ", said)


if __name__ == "__main__":
    program.main()
