#!/usr/bin/env python3
"""A bed around a sill of overlapping fixed spheres: check, the run and analyze have one height of it.

Called by ctest: obstacle_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest
from thalweg import Run, bed

D = 6.0e-3
SILL = ", ".join(f"[0.03, {0.004 * n:.3f}, 0.004]" for n in range(1, 13))   # of 16 mm, 4 mm apart, sunk into the floor


class Sill(ProgramTest):
    CASE = f"""
system: grains
name: sill
domain: {{size: [0.072, 0.048, 0.042], spacing: 1.0e-3, boundaries: {{x: periodic, y: periodic, bottom: no_slip, top: no_slip}}}}
gravity: {{magnitude: 9.81}}
grains:
  - {{diameter: 16.0e-3, density: 2650, fixed: true, placement: {{positions: [{SILL}]}}}}
  - {{fill: {{depth: 0.012}}, diameter: {D}, density: 2650, placement: {{pattern: random, seed: 1}}}}
contact: {{normal_stiffness: 20000, restitution: 0.5, tangential_damping: 0.5, friction: 0.5}}
run: {{until: 0.35}}
output: {{series: {{every: 0.05}}, grains: {{every: 0.35}}}}
analysis: {{bed_surface: {{every: 0.05}}}}
"""

    def expected_by_check(self, *settings):
        report = self.run_well("check", self.case, *settings).stdout
        return float(re.search(r"settles at about ([\d.e-]+) m", report).group(1))

    def test_has_one_height_in_check_run_and_analyze(self):
        self.run_well("run", self.case)
        found = self.summary("run")["bed"]
        # Poured spheres: 0.36 to 0.45, and more between near walls. All grains and overlaps counted twice it was -0.1.
        self.assertGreater(found["porosity"], 0.36)
        self.assertLess(found["porosity"], 0.48)
        # What check takes for 0.4: the same grains in the same room, with the sill's 2.2 mm.
        sill = self.expected_by_check() - 0.012
        self.assertAlmostEqual(sill, 0.0022, delta=0.0001)
        self.assertAlmostEqual(found["bed_height"], 0.012 * 0.6 / (1.0 - found["porosity"]) + sill, delta=0.15 * D)
        # The frames in layers of a quarter of a diameter.
        self.assertAlmostEqual(bed.bed_height(Run(self.folder / "run"), start=0.3), found["bed_height"], delta=0.15 * D)
        self.assertEqual(self.series()["bed_height"][-1], found["bed_height"])

    def test_has_the_same_bits_on_any_ranks_and_after_a_restart(self):
        early = (
            "--set", "run.until=0.02", "--set", "output.series.every=0.005", "--set",
            "analysis.bed_surface.every=0.005", "--set", "output.checkpoint.every=0.01",
        )
        self.run_well("run", self.case, "--out", "one", *early)
        self.run_well("run", self.case, "--out", "three", *early, ranks=3)
        self.run_well("run", self.case, "--out", "again", *early, "--until", "0.011", ranks=2)
        self.run_well("run", self.case, "--out", "again", "--restart", "again", *early)
        for out in ("three", "again"):
            self.assertEqual(
                (self.folder / out / "series.csv").read_bytes(), (self.folder / "one/series.csv").read_bytes(), out
            )
            self.assert_same_end(out, "one")


if __name__ == "__main__":
    program.main()
