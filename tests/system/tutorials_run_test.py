#!/usr/bin/env python3
"""The tutorials: `thalweg check` has nothing to warn of, every case starts, every sweep can be listed, the pages quote what
check prints, and the checks tell a run that is as it should be from one that is not there.

Called by ctest: tutorials_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import program
from program import ProgramTest
from thalweg.case_file import read_case

TUTORIALS = "cases/tutorials"
STEPS = 20
# Numbers on the page of a case, and in what check prints of it.
QUOTED = (
    ("tutorials/2_water_over_the_bed", r"\*\*Shields\*\* ([\d.]+), from the hydraulic radius",
     r"([\d.]+) from the hydraulic radius"),
    ("tutorials/2_water_over_the_bed", r"\*\*flow\*\*: at most ([\d.]+) cells per step", r"flow .*: ([\d.]+) cells per step"),
    ("tutorials/2_water_over_the_bed", r"From rest it would take ([\d.]+) s", r"from rest the flow takes about ([\d.]+) s"),
    ("tutorials/4_settling_sphere", r"between Reynolds numbers of (\d+) and (\d+)", r"no table of it between (\d+) and (\d+)"),
    ("tutorials/8_clump_from_a_scan", r"([\d.]+) cells across the shortest axis", r"([\d.]+) cells across the shortest axis"),
    ("quickstart", r"From rest the flow would take ([\d.]+) s", r"from rest the flow takes about ([\d.]+) s"),
    ("quickstart", r"([\d.]+) % of a diameter under the weight of the bed and ([\d.]+) %",
     r"([\d.]+) % of a diameter under the weight of the bed, ([\d.]+) %"),
)


class Tutorials(ProgramTest):
    def setUp(self):
        super().setUp()
        shutil.copytree(ROOT / "cases", self.folder / "cases")
        self.run_well("run", "cases/settled_bed/case.yaml", "--out", "run/settled_bed")
        self.run_well("run", f"{TUTORIALS}/1_settled_bed/case.yaml", "--out", "run/small_bed")

    def check_script(self, tutorial, *folders):
        return subprocess.run(
            [sys.executable, "-B", ROOT / TUTORIALS / tutorial / "check.py", *folders], cwd=self.folder,
            capture_output=True, text=True,
        )

    def test_the_beds_are_as_expected(self):
        done = self.check_script("1_settled_bed")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count("pass"), 6)
        # The two beds differ: in the place of the other neither is what it should be.
        done = self.check_script("1_settled_bed", "run/small_bed", "run/settled_bed")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertEqual(done.stdout.count("FAIL"), 2)

    def test_every_case_is_checked_and_starts(self):
        cases = sorted((self.folder / TUTORIALS).glob("*/case.yaml"))
        self.assertEqual(len(cases), 8)   # the third varies the case of the second
        self.run_well("run", f"{TUTORIALS}/7_scour_at_a_pier/pour.yaml", "--out", "run/pier_bed", "--until", "0.05")
        self.run_well("run", f"{TUTORIALS}/9_feed_flume/bed.yaml", "--out", "run/feed_bed", "--until", "0.2")
        for case in cases:
            name = case.parent.name
            self.assertNotIn("\nwarning", self.run_well("check", case).stdout, name)
            step = read_case(case).get("fluid", {}).get("time_step", 1e-4)   # s; grains alone have no step of the fluid
            self.run_well("run", case, "--out", f"run/{name}", "--until", f"{STEPS * step:.9g}", ranks=2)
            self.assertTrue(self.summary(f"run/{name}")["finished"])

    def test_every_sweep_can_be_listed(self):
        sweeps = [
            path
            for path in sorted((self.folder / TUTORIALS).glob("*/*.yaml"))
            if path.name not in ("case.yaml", "pour.yaml", "bed.yaml")
        ]
        self.assertEqual(len(sweeps), 3)
        for sweep in sweeps:
            listed = self.run_well("sweep", sweep, "--out", "run/sweep", "--dry-run").stdout
            self.assertGreaterEqual(listed.count("waiting"), 3, listed)

    def test_the_pages_quote_what_check_prints(self):
        for folder, on_page, in_report in QUOTED:
            with self.subTest(folder=folder, on_page=on_page):
                page = " ".join((ROOT / "cases" / folder / "README.md").read_text().split())
                quoted = re.search(on_page, page).groups()
                printed = re.search(in_report, self.run_well("check", f"cases/{folder}/case.yaml").stdout).groups()
                for number, exact in zip(quoted, printed):
                    digits = len(number.partition(".")[2])
                    self.assertEqual(number, f"{float(exact):.{digits}f}")

    def test_the_page_on_stability_has_the_density_limit_of_the_quickstart(self):
        case = read_case(ROOT / "cases/quickstart/case.yaml")
        fluid, grains, spacing = case["fluid"], case["grains"][0], case["domain"]["spacing"]
        weight = 2 / 3 * (grains["density"] - fluid["density"]) * case["gravity"]["magnitude"] * grains["diameter"]   # Pa
        per_cent = 100 * weight / (fluid["density"] * (spacing / fluid["time_step"]) ** 2 / 3)
        page = (ROOT / "docs/stability.md").read_text()
        self.assertEqual(re.findall(r"In `cases/quickstart` that is (.*?)%", page), [f"{weight:.0f} Pa or {per_cent:.2f} "])

    def test_a_run_that_is_not_there(self):
        scripts = sorted((ROOT / TUTORIALS).glob("*/check.py"))
        self.assertEqual(len(scripts), 9)
        for script in scripts[1:]:   # the beds of the first are there
            done = self.check_script(script.parent.name)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn("there is no", done.stderr)


if __name__ == "__main__":
    program.main()
