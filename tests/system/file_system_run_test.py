#!/usr/bin/env python3
"""File systems as clusters have them: nodes that do not see yet what others have written, and one without locks.

Called by ctest: file_system_run_test.py THALWEG MPIEXEC LIBRARY [unittest arguments]; the library makes such a file
system (tests/support/other_file_system.cpp).
"""
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
LIBRARY = sys.argv.pop(3)
import program
from program import SLIDING_GRAINS, ProgramTest
from stl_box import write_box

PIER = """
system: fluid
domain:
  size: [0.016, 0.008, 0.008]
  spacing: 1.0e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, time_step: 1.0e-3}
gravity: {magnitude: 9.8, slope: 1.0e-5}
solids: [{stl: pier.stl}]
run: {until: 0.1}
"""


class FileSystem(ProgramTest):
    CASE = (
        SLIDING_GRAINS
        + "run: {until: 0.02, time_step: 2.5e-5}\noutput: {series: {every: 0.005}, checkpoint: {every: 0.01}}\n"
    )

    def thalweg_there(self, *arguments, ranks=0, **environment):
        environment = {"LD_PRELOAD": LIBRARY, **environment}
        words = [word for name, value in environment.items() for word in (f"{name}={value}",)]
        command = self.command(arguments, ranks)
        at = command.index(program.THALWEG)
        return subprocess.run(
            command[:at] + ["env", *words] + command[at:], capture_output=True, text=True, timeout=120, cwd=self.folder
        )

    def run_well_there(self, *arguments, **options):
        result = self.thalweg_there(*arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        return result.stdout + result.stderr

    def test_one_rank_looks_for_all(self):
        blind = {"ranks": 2, "BLIND_TO": str(self.folder)}
        self.run_well_there("run", self.case, "--out", "run", "--until", "0.01", **blind)
        self.assertIn("resuming from run/checkpoints/step_8.h5",
                      self.run_well_there("run", self.case, "--out", "run", "--resume", **blind))
        self.run_well("run", self.case, "--out", "straight")
        self.assert_same_bed("run", "straight")
        self.assertIn("nothing to do", self.run_well_there("run", self.case, "--out", "run", "--resume", **blind))
        # To another folder, from a bed file, and from another run.
        self.run_well_there("run", self.case, "--restart", "run", "--out", "later", "--until", "0.03", **blind)
        bed = self.folder / "bed.yaml"
        bed.write_text(
            self.CASE.replace(
                "{count: 60, diameter: 5.0e-3, density: 2550, placement: {pattern: random, seed: 3}}",
                "{placement: {file: run/bed.h5}}",
            )
        )
        self.run_well_there("run", bed, "--out", "from_bed", **blind)
        self.run_well_there(
            "run", self.case, "--out", "begun", "--set", "initial.from=run", "--until", "0.005", **blind
        )
        # What is missing is missing for all, in one sentence.
        refused = self.thalweg_there("run", "nowhere.yaml", "--out", "none", **blind)
        self.assertEqual(refused.returncode, 2)
        self.assertEqual(refused.stderr.count("there is no such file"), 1, refused.stderr)

    def test_one_rank_reads_surfaces_for_all(self):
        self.case.write_text(PIER)
        write_box(self.folder / "pier.stl", (0.004, 0.002, -0.001), (0.006, 0.005, 0.004))
        self.run_well_there("run", self.case, "--out", "run", ranks=2, BLIND_TO=str(self.folder))
        self.run_well("run", self.case, "--out", "alone")
        self.assert_same_end("run", "alone")

    def test_without_locks_the_log_says_so_once(self):
        words = "run cannot be locked: make sure that no other run writes there"
        self.run_well_there("run", self.case, "--out", "run", ranks=2, WITHOUT_LOCKS="1")
        self.assertEqual((self.folder / "run/run.log").read_text().count(words), 1)
        self.run_well("run", self.case, "--out", "with")
        self.assertNotIn("locked", (self.folder / "with/run.log").read_text())


if __name__ == "__main__":
    program.main()
