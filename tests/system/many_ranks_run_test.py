#!/usr/bin/env python3
"""The same bits on 1, 16, 27 and 64 ranks, many more than there are cores, and across a restart on other ranks.

Called by ctest: many_ranks_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest


class ManyRanksRun(ProgramTest):
    # Everything moves: grains fall, drift across the borders between ranks and the periodic faces, and meet the side
    # walls.
    CASE = """
system: resolved
name: wide channel
domain:
  size: [0.0792, 0.0396, 0.0594]     # m: 96 x 48 x 72 cells
  spacing: 0.825e-3                  # m
  boundaries: {x: periodic, y: law_of_the_wall, bottom: no_slip, top: free_slip}
fluid:
  density: 1000
  kinematic_viscosity: 1.0e-6
  smagorinsky_constant: 0.27
  time_step: 1.0e-4
  precision: single
gravity: {magnitude: 9.8, slope: 0.2}
grains:
  - {count: 500, diameter: 4.95e-3, density: 2550, placement: {pattern: uniform, seed: 1}, velocity: [0.3, 0.0, -0.1]}
contact: {normal_stiffness: 20000, tangential_stiffness: 5714, restitution: 0.93, friction: 0.5, wall_friction: 0.45}
coupling: {grain_steps_per_fluid_step: auto}
initial: {fluid: {uniform: [0.3, 0.0, 0.0]}}
run: {until: 0.008}
output:
  series: {every: 0.002}
  grains: {every: 0.004}
  fluid: {every: 0.004, region: slice_y}
  checkpoint: {every: 0.004, keep: 3}
analysis:
  transport_rate: {from: 0.002}
  stress_balance: {from: 0.002}
"""

    def expect_the_same(self, out):
        frames = (path.relative_to(self.folder / "one") for path in sorted((self.folder / "one").glob("*/*.vt?")))
        self.assert_same_end(out, "one", "series.csv", *frames)

    def test_the_same_bits(self):
        self.run_well("run", self.case, "--out", "one")
        self.assertTrue(list((self.folder / "one").glob("grains/*.vtp")))
        for ranks, layout in ((16, "4,2,2"), (27, "3,3,3"), (64, "4,4,4")):
            out = f"on_{ranks}"
            self.run_well("run", self.case, "--out", out, "--layout", layout, ranks=ranks)
            self.expect_the_same(out)

    def test_a_restart_on_other_ranks(self):
        self.run_well("run", self.case, "--out", "one")
        self.run_well("run", self.case, "--out", "part", "--until", "0.004", ranks=27)
        self.run_well("run", self.case, "--restart", "part", ranks=16)
        self.expect_the_same("part")


if __name__ == "__main__":
    program.main()
