#!/usr/bin/env python3
"""`thalweg info`: one run, a table of runs.

Called by ctest: info_test.py THALWEG MPIEXEC [unittest arguments]
"""
import csv
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import h5py

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
import program
from program import TUMBLING_GRAINS, ProgramTest


class Info(ProgramTest):
    CASE = TUMBLING_GRAINS

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

    def test_json_has_what_the_text_says(self):
        self.run_well("run", self.case)
        text = self.run_well("info", "run").stdout
        found = json.loads(self.run_well("info", "--json", "run").stdout)
        self.assertEqual((found["path"], found["state"], found["summary"]), ("run", "finished", self.summary("run")))
        self.assertEqual(found["last_line"], (self.folder / "run/run.log").read_text().splitlines()[-1])
        self.assertIn(f"last line   {found['last_line']}\n", text)
        path = self.last_checkpoint("run")
        checkpoint = found["checkpoint"]
        with h5py.File(path) as file:
            self.assertEqual((checkpoint["time"], checkpoint["step"], checkpoint["time_step"]),
                             tuple(file["run"].attrs[name] for name in ("time", "step", "time_step")))
            datasets = {}
            file.visititems(
                lambda name, item: datasets.update({name: list(item.shape)}) if isinstance(item, h5py.Dataset) else None
            )
        self.assertEqual({entry["path"]: entry["shape"] for entry in checkpoint["datasets"]}, datasets)
        for entry in checkpoint["datasets"]:
            self.assertIn(entry["path"], text)
        self.assertEqual((checkpoint["name"], checkpoint["system"]), ("tumbling grains", "grains"))
        of_file = json.loads(self.run_well("info", "--json", path).stdout)
        self.assertEqual(of_file.keys(), {"path", "checkpoint"})
        self.assertEqual(of_file["checkpoint"]["datasets"], checkpoint["datasets"])
        (self.folder / "run/summary.json").unlink()
        shutil.rmtree(self.folder / "run/checkpoints")
        found = json.loads(self.run_well("info", "--json", "run").stdout)
        self.assertEqual((found["summary"], found["checkpoint"]), (None, None))
        self.assertIn("not running: it was killed", found["state"])
        self.assert_refused("info", "--json", "--csv", "run", words=["--csv"])

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
        (self.folder / "sweep/runs").mkdir(parents=True)
        for name in "ba":
            (self.folder / name).rename(self.folder / "sweep/runs" / name)
        _, *rows = csv.reader(self.run_well("info", "--csv", "c", "sweep").stdout.splitlines())
        self.assertEqual([row[0] for row in rows], ["c", "sweep/runs/a", "sweep/runs/b"])
        self.assert_refused("info", "a", "b", words=["--csv"])
        self.assert_refused("info", "--csv", "c", "nowhere", words=["nowhere"])


if __name__ == "__main__":
    program.main()
