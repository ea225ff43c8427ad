#!/usr/bin/env python3
"""Probes of the fluid in a whole run: what the pictures show, the same file on any ranks, no row twice after a restart.

Called by ctest: probes_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
import thalweg
from program import ProgramTest


class ProbesRun(ProgramTest):
    # A grain flies over the third point.
    CASE = """
system: resolved
name: flow past probes
domain:
  size: [0.0165, 0.010725, 0.0165]   # m: 20 x 13 x 20 cells
  spacing: 0.825e-3                  # m
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, smagorinsky_constant: 0.27, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.1}
grains:
  - count: 1
    diameter: 4.95e-3
    density: 2550
    placement: {positions: [[0.004, 0.005, 0.008]]}
    velocity: [0.8, 0.0, 0.0]
contact: {normal_stiffness: 20000, tangential_stiffness: 5714, restitution: 0.5, friction: 0.5}
initial: {fluid: {uniform: [0.8, 0.0, 0.0]}}
run: {until: 0.02}
output:
  fluid: {every: 0.002, fields: [velocity, pressure, grain_id]}
  checkpoint: {every: 0.01, keep: 3}
analysis:
  probes:
    points: [[0.0, 0.0, 0.0], [0.0165, 0.010725, 0.0165], [0.0105, 0.005, 0.008]]
    lines: [{from: [0.004, 0.002, 0.001], to: [0.004, 0.002, 0.016], points: 7}]
    every: 1.0e-3
"""

    def probes(self, run):
        return thalweg.Run(self.folder / run).probes

    def parts_of(self, run):
        return {path.name: path.read_bytes() for path in (self.folder / run / "probes").iterdir()}

    def test_what_pictures_show_and_the_same_bits_on_any_ranks(self):
        self.run_well("run", self.case, "--out", "one")
        for ranks in (2, 4):
            self.run_well("run", self.case, "--out", f"on_{ranks}", ranks=ranks)
            self.assertEqual(self.parts_of(f"on_{ranks}"), self.parts_of("one"))
        run, probes = thalweg.Run(self.folder / "one"), self.probes("one")
        numpy.testing.assert_allclose(probes["time"], 1e-3 * numpy.arange(21), atol=1e-12)
        cells = numpy.column_stack([probes[f"cell_{axis}"] for axis in "xyz"])
        numpy.testing.assert_array_equal(cells[:3], [[0, 0, 0], [19, 12, 19], [12, 6, 9]])
        numpy.testing.assert_array_equal(cells[3:, 2], numpy.floor(numpy.linspace(0.001, 0.016, 7) / 0.825e-3))
        numpy.testing.assert_allclose(probes["position"], (cells + 0.5) * 0.825e-3, rtol=1e-12)
        x, y, z = cells.T
        for frame in run.fluid:
            row = int(round(frame.time / 1e-3))
            covered = frame.arrays["grain_id"][z, y, x] >= 0
            numpy.testing.assert_array_equal(numpy.isnan(probes["pressure"][row]), covered)
            # Pictures have single precision.
            numpy.testing.assert_allclose(
                probes["velocity"][row][~covered], frame.arrays["velocity"][z, y, x][~covered], rtol=1e-6, atol=1e-9
            )
            numpy.testing.assert_allclose(
                probes["pressure"][row][~covered], frame.arrays["pressure"][z, y, x][~covered], rtol=1e-6, atol=1e-9
            )
        covered = numpy.isnan(probes["pressure"])
        self.assertTrue(covered[:, 2].any() and not covered[:, :2].any())

    def test_a_restart_has_no_row_twice_and_the_run_does_not_notice(self):
        self.run_well("run", self.case, "--out", "straight")
        self.run_well("run", self.case, "--out", "parts", "--until", "0.015")   # beyond the checkpoint at 10 ms
        self.run_well(
            "run", self.case, "--out", "parts", "--restart", self.folder / "parts/checkpoints/step_100.h5", ranks=2
        )
        for name, values in self.probes("straight").items():
            self.assertEqual(values.tobytes(), self.probes("parts")[name].tobytes(), name)
        self.run_well("run", self.case, "--out", "alone", "--set", "analysis={}")
        self.assertEqual((self.folder / "alone/bed.h5").read_bytes(), (self.folder / "straight/bed.h5").read_bytes())

    def test_other_probes_are_refused_and_nothing_is_touched(self):
        self.run_well("run", self.case, "--until", "0.01")
        fewer = ("--set", "analysis.probes.lines.0.points=6")
        self.assert_refused(
            "run", self.case, "--restart", "run", *fewer, words=["run/probes/part_", "cannot be continued", "--out"]
        )
        self.run_well("run", self.case, "--restart", "run")

    def test_what_is_not_in_the_box_is_refused(self):
        def refused(words, *settings):
            self.assert_refused("check", self.case, *settings, words=words)
        refused(["analysis.probes.points.1", "0.0165"], "--set", "analysis.probes.points.1=[0.1, 0, 0]")
        refused(["analysis.probes.lines.0.to", "0.0165"], "--set", "analysis.probes.lines.0.to=[0, 0, -0.1]")
        refused(["at least 2"], "--set", "analysis.probes.lines.0.points=1")
        refused(["analysis.probes", "no point"], "--set", "analysis.probes={every: 0.001}")


if __name__ == "__main__":
    program.main()
