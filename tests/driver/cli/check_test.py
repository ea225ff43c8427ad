#!/usr/bin/env python3
"""`thalweg check`: what it reports and plans, and the cases it refuses as `thalweg run` does.

Called by ctest: check_test.py THALWEG MPIEXEC [unittest arguments]
"""
import json
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
import program
from program import TUMBLING_GRAINS, ProgramTest, files_below


class Check(ProgramTest):
    CASE = TUMBLING_GRAINS

    def test_check_says_what_a_case_means(self):
        report = self.run_well("check", self.case).stdout
        self.assertEqual(files_below(self.folder), ["case.yaml"])
        # Pair of 5 mm spheres of 2550 kg/m^3, e = 0.8: omega_0 = sqrt(k/(m/2)), zeta = 0.0709 (attraction) or so:
        # t_c = pi/omega_0 = 2.029e-4 s within 1 %; in sub-steps of 4e-6 s: 50.9.
        self.assertRegex(report, r"contact +lasts 0\.00020[2-5] s: 5[01]\.\d sub-steps of 4e-06 s")
        # 0.1 s in steps of 50 * 4e-6 s, 40 grains with 50 sub-steps each.
        self.assertRegex(report, r"work +500 steps to 0\.1 s, 1e\+06 grain-steps")

    def test_check_plans_other_numbers_of_ranks(self):
        """The rows of the table; what is in them is the business of performance_model_test."""
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

    def test_cases_that_cannot_be_run(self):
        self.assert_refused("run", "missing.yaml", words=["missing.yaml"])
        for command in ("run", "check"):
            self.assert_refused(command, self.case, "--set", "gravity.magnitde=9.8", words=["magnitde"])
            self.assert_refused(command, self.case, "--set", "grains.0.diameter=-0.005", words=["grains.0.diameter"])
            self.assert_refused(command, self.case, "--set", "grains.0.density=heavy",
                                words=["grains.0.density", "heavy"])
            self.assert_refused(command, self.case, "--set", "grains.0.count=4000", words=["grains.0"])
            self.assert_refused(command, self.case, "--set", "run.time_step=1e-3", words=["time"])
            self.assert_refused(command, self.case, "--set", "gravity.slope=", words=["gravity.slope=", "null to remove"])
            (self.folder / "slopes.yaml").write_text("case: case.yaml\nvary: {gravity.slope: [0.1, 0.2]}\n")
            self.assert_refused(command, "slopes.yaml", words=["this is a sweep", "thalweg sweep slopes.yaml"])
        self.assert_refused("check", self.case, "--ranks", "0", words=["--ranks: 0 is not a positive number"])
        self.assert_refused("run", self.case, "--layout", "2,1,1", words=["--layout", "2 rank"])
        self.assert_refused("run", self.case, "--restart", "nowhere", words=["nowhere"])

    def test_cases_that_cannot_be_run_on_two_ranks(self):
        self.assert_refused("run", self.case, "--set", "grains.0.diameter=-0.005", words=["grains.0.diameter"], ranks=2)
        self.assert_refused("run", self.case, "--layout", "1,1,1", words=["--layout"], ranks=2)
        self.assert_refused("run", self.case, "--set", "grains.0.count=4000", words=["grains.0"], ranks=2)

    def test_what_the_machine_has_no_memory_for_is_refused(self):
        """Of 1.6e10 cells, 1.2 TB in their populations alone: check says so below its report, and run before it
        starts."""
        channel = str(Path(__file__).resolve().parents[3] / "cases/clear_channel/case.yaml")
        huge = ("--set", "domain.size=[2, 1, 1]", "--set", "domain.spacing=0.5e-3", "--set", "fluid.time_step=2e-5")
        checked = self.thalweg("check", channel, *huge)
        self.assertEqual(checked.returncode, 2)
        self.assertRegex(checked.stdout, r"memory +about .* more than the .* of this machine")
        self.assertRegex(checked.stderr, r"the run takes about .* of memory.*: use at least \d+ such nodes")
        for ranks in (0, 2):
            ran = self.thalweg("run", channel, *huge, "--out", "run", ranks=ranks)
            self.assertEqual(ran.returncode, 2)
            self.assertRegex(ran.stderr, r"use at least \d+ such nodes")
        self.assertEqual(files_below(self.folder), ["case.yaml"])

    def test_solve_prints_keys_and_json_figures_but_not_both(self):
        self.assert_refused("check", self.case, "--solve", "--json", words=["--solve excludes --json"])
        for option in ("--solve", "--json"):   # the table of ranks has neither
            self.assert_refused("check", self.case, option, "--ranks", "1", words=["excludes"])

    def test_json_has_the_shields_number_of_the_lines(self):
        case = Path(__file__).resolve().parents[3] / "cases/quickstart/case.yaml"
        held = ("--set", "gravity.slope=0", "--set", "fluid.mean_velocity={velocity: 0.3, response_time: 0.1}")
        for settings in ((), held):
            (said,) = re.findall(r"^Shields .*?([0-9.e-]+) (?:from the hydraulic|by the mean)",
                                 self.run_well("check", case, *settings).stdout, re.MULTILINE)
            figures = json.loads(self.run_well("check", case, *settings, "--json").stdout)["figures"]
            self.assertAlmostEqual(figures["shields_number"] / float(said), 1.0, 3)

    def test_rows_of_a_column_come_with_its_step(self):
        case = Path(__file__).resolve().parents[3] / "cases/continuum/case.yaml"
        checked = self.run_well("check", case, "--set", "output.series=null", "--set", "run.time_step=2.5").stdout
        self.assertIn("no warning", checked)

    def test_a_box_in_millimetres_of_cells_in_metres(self):
        """The grains and cells of a case in m, and its box in mm: 2e11 cells, and no advice to make them coarser."""
        box = ("--set", "domain.size=[88, 44]")
        case = Path(__file__).resolve().parents[3] / "cases/graded_bed/case.yaml"
        self.assertNotIn("looks like millimetres", self.run_well("check", case).stdout)
        checked = self.thalweg("check", case, *box)
        self.assertEqual(checked.returncode, 2)
        warnings = [line for line in checked.stdout.splitlines() if line.startswith("warning")]
        self.assertEqual(len(warnings), 1, checked.stdout)
        self.assertIn("looks like millimetres: lengths are in m, and domain.size: 88 mm is 0.088 m.", warnings[0])


if __name__ == "__main__":
    program.main()
