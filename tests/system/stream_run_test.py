#!/usr/bin/env python3
"""A sphere held in a stream from an inlet to an outlet, with the defaults for water: its wake leaves the box.

Called by ctest: stream_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest

CASE = Path(__file__).resolve().parents[2] / "benchmarks/validation/sphere_drag_curve/stream.yaml"
D, U, CELLS = 5.0e-3, 0.2, 6
TOWED = 0.918   # drag coefficient of the same sphere towed through a box as wide (the README beside the case)


class Stream(ProgramTest):
    CASE = CASE.read_text(encoding="utf-8")

    def test_lets_the_wake_of_a_sphere_leave(self):
        self.run_well("run", self.case, "--set", f"domain.spacing={D / CELLS:.10g}", "--set",
                      f"fluid.time_step={0.08 * D / CELLS / U:.10g}", "--until", "0.6")   # 24 d/U, two boxes
        series = self.series()
        # The fastest water is beside the sphere, where potential flow has 1.5 times the speed of the stream.
        self.assertLess(series["largest_fluid_speed"][-1], 1.5 * U)
        drag = series["grains_0_fluid_force_x"][-200:]   # of 8 d/U
        coefficients = [force / (math.pi / 8.0 * 1000.0 * U**2 * D**2) for force in drag]
        mean = sum(coefficients) / len(coefficients)
        # Both boxes are five diameters wide, but this one is short: within a tenth of the towed sphere.
        self.assertAlmostEqual(mean, TOWED, delta=0.1 * TOWED)
        # Nothing rings: a wave of one hundredth of the speed has a pressure of rho c_s U/100 = 0.07 rho U^2, which is a
        # drag coefficient of 0.14 on a sphere between its crest and its trough.
        self.assertLess(max(coefficients) - min(coefficients), 0.1)

    def test_has_the_same_bits_on_any_ranks_and_after_a_restart(self):
        coarse = ("--set", f"domain.spacing={D / 4:.10g}", "--set", f"fluid.time_step={0.08 * D / 4 / U:.10g}", "--set",
                  "output.checkpoint={every: 0.01}", "--set", "run.until=0.02")
        self.run_well("run", self.case, "--out", "one", *coarse)
        self.run_well("run", self.case, "--out", "three", *coarse, ranks=3)
        self.run_well("run", self.case, "--out", "again", *coarse, "--until", "0.011", ranks=2)
        self.run_well("run", self.case, "--out", "again", "--restart", "again", *coarse)
        for out in ("three", "again"):
            self.assert_same_end(out, "one")


if __name__ == "__main__":
    program.main()
