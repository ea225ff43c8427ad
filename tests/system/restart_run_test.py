#!/usr/bin/python3
"""Runs that go on: with which case, what may differ from before, and what is kept of that.

Called by ctest: restart_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest


class RestartRun(ProgramTest):
    CASE = """
system: grains
name: restart
domain:
  size: [0.05, 0.03, 0.05]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: no_slip, bottom: no_slip, top: free_slip}
gravity: {magnitude: 9.8, slope: 0.3}
grains: [{count: 40, diameter: 5.0e-3, density: 2550, placement: {pattern: random, seed: 3}}]
contact: {normal_stiffness: 2000, tangential_stiffness: 571, restitution: 0.7, friction: 0.3, wall_friction: 0.3}
run: {until: 0.05, time_step: 1.0e-5}
output: {series: {every: 0.01}}
"""

    def setUp(self):
        super().setUp()
        self.run_well("run", self.case)

    def test_the_same_case_has_nothing_to_tell(self):
        said = self.run_well("run", self.case, "--restart", "run").stdout
        self.assertNotIn("changed since then", said)

    def test_what_has_changed_is_told_and_kept(self):
        said = self.run_well("run", self.case, "--restart", "run", "--until", "0.1", "--set", "contact.friction=0.4").stdout
        self.assertIn("changed since then: run.until: 0.05 -> 0.1", said)
        self.assertIn("changed since then: contact.friction: 0.3 -> 0.4", said)
        log = (self.folder / "run/run.log").read_text()
        self.assertIn("contact.friction: 0.3 -> 0.4", log)
        # A setting that is not repeated is told as well.
        said = self.run_well("run", self.case, "--restart", "run", "--until", "0.15").stdout
        self.assertIn("changed since then: contact.friction: 0.4 -> 0.3", said)
        kept = {path.name: path.read_text() for path in (self.folder / "run").glob("case*.yaml")}
        self.assertEqual(sorted(kept), ["case.yaml", "case_until_step_100.yaml", "case_until_step_200.yaml"])
        self.assertIn("friction: 0.3\n", kept["case_until_step_100.yaml"])
        self.assertIn("friction: 0.4\n", kept["case_until_step_200.yaml"])
        self.run_well("run", self.case, "--overwrite")
        self.assertEqual(len(list((self.folder / "run").glob("case*.yaml"))), 1)

    def test_grains_that_the_checkpoint_has_cannot_be_changed(self):
        for key, value in (("grains.0.density", "2650"), ("grains.0.diameter", "4e-3"), ("grains.0.count", "41")):
            self.assert_refused("run", self.case, "--restart", "run", "--set", f"{key}={value}", "--until", "0.1",
                                words=[key, "in its checkpoint", "initial.from"])

    def test_in_another_folder_too(self):
        checkpoint = self.last_checkpoint("run")
        self.assert_refused("run", self.case, "--restart", checkpoint, "--out", "other", "--set", "grains.0.density=2650",
                            words=["grains.0.density = 2650", "2550"])
        said = self.run_well("run", self.case, "--restart", checkpoint, "--out", "other", "--until", "0.1").stdout
        self.assertIn("changed since then: run.until: 0.05 -> 0.1", said)


if __name__ == "__main__":
    program.main()
