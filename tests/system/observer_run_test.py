#!/usr/bin/python3
"""Observers of transport and of the bed's surface in a whole run: same bits on any ranks, same means after a restart, and
a run that does not notice them.

Called by ctest: observer_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest


class ObserverRun(ProgramTest):
    # Two kinds of grains fall through flowing water onto the floor of a short flume.
    CASE = """
system: resolved
name: watched flume
domain:
  size: [0.0264, 0.010725, 0.0264]   # m
  spacing: 0.825e-3                  # m
  boundaries: {x: periodic, y: no_slip, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, smagorinsky_constant: 0.27, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.1}
grains:
  - {count: 20, diameter: 4.95e-3, density: 2550, placement: {pattern: uniform, seed: 1}, velocity: [0.2, 0.0, -0.1]}
  - {count: 6, diameter: 4.2e-3, density: 2000, placement: {pattern: random, seed: 2}, velocity: [0.2, 0.0, -0.1]}
contact: {normal_stiffness: 20000, tangential_stiffness: 5714, restitution: 0.5, friction: 0.5, wall_friction: 0.45}
coupling: {grain_steps_per_fluid_step: 20}
initial: {fluid: {uniform: [0.2, 0.0, 0.0]}}
run: {until: 0.08}
output:
  series: {every: 0.004}
  checkpoint: {every: 0.04, keep: 3}
analysis:
  transport_rate: {from: 0.01, every: 1.0e-3}
  bed_surface: {every: 3.0e-3, static_time: 0.015}
"""

    def test_the_same_bits_on_any_ranks(self):
        self.run_well("run", self.case, "--out", "one")
        for ranks in (2, 4):
            out = f"on_{ranks}"
            self.run_well("run", self.case, "--out", out, ranks=ranks)
            self.assertEqual(self.last_checkpoint(out).read_bytes(), self.last_checkpoint("one").read_bytes(), out)
            for name in ("series.csv", "profiles.h5"):
                self.assertEqual((self.folder / out / name).read_bytes(), (self.folder / "one" / name).read_bytes(), out)
            for observer in ("transport_rate", "bed_surface"):
                self.assertEqual(self.summary(out)[observer], self.summary("one")[observer])

    def test_a_restart_half_way_has_the_same_means(self):
        self.run_well("run", self.case, "--out", "straight")
        half_way = self.folder / "straight/checkpoints/step_400.h5"
        self.run_well("run", self.case, "--out", "again", "--restart", half_way, ranks=2)
        self.assertEqual(self.last_checkpoint("again").read_bytes(), self.last_checkpoint("straight").read_bytes())
        for observer in ("transport_rate", "bed_surface"):
            self.assertEqual(self.summary("again")[observer], self.summary("straight")[observer])
        self.assertGreater(self.summary("again")["bed_surface"]["static_pictures"], 2)
        rows = (self.folder / "straight/series.csv").read_text().splitlines()
        self.assertEqual((self.folder / "again/series.csv").read_text().splitlines()[1:], rows[-len(rows) // 2:])

    def test_the_run_does_not_notice(self):
        self.run_well("run", self.case, "--out", "watched", "--until", "0.02")
        self.run_well("run", self.case, "--out", "alone", "--until", "0.02", "--set", "analysis={}")
        self.assert_same_state("watched", "alone")

    def test_the_numbers_belong_together(self):
        self.run_well("run", self.case)
        transport, surface, series = self.summary("run")["transport_rate"], self.summary("run")["bed_surface"], self.series()
        # 20 of 4.95 mm have 0.897 of the volume of all; density of them all: mass over volume.
        self.assertEqual(transport["reference_diameter"], 4.95e-3)
        large, small = 20 * 4.95 ** 3, 6 * 4.2 ** 3
        self.assertAlmostEqual(transport["reference_density"], (2550 * large + 2000 * small) / (large + small), delta=1e-9)
        self.assertEqual(transport["measurements"], 71)   # every millisecond from 10 to 80
        self.assertGreaterEqual(transport["hops"], 0)
        # R_h and the stress of the last row from its height.
        depth = 0.0264 - series["bed_height"][-1]
        radius = depth * 0.010725 / (2 * depth + 0.010725)
        self.assertAlmostEqual(series["hydraulic_radius"][-1], radius, delta=1e-9)
        self.assertAlmostEqual(series["bed_stress"][-1], 1000 * 9.8 * 0.1 * radius, delta=1e-4)
        excess = (transport["reference_density"] - 1000) * 9.8 * 4.95e-3
        self.assertAlmostEqual(series["shields_number"][-1], 980 * radius / excess, delta=1e-6)
        log = (self.folder / "run/run.log").read_text()
        self.assertIn("reference grain: diameter 0.00495 m", log)
        self.assertIn("transport: q* = ", log)
        with h5py.File(self.folder / "run/profiles.h5") as profiles:
            outline = profiles["bed_surface/static_surface"][()]
            self.assertEqual(len(outline), round(0.0264 / (4.95e-3 / 25)))
            self.assertAlmostEqual(outline.mean(), surface["static_bed_height_mean"], delta=1e-12)
            edges, density = profiles["transport_rate/velocity_edges"][()], profiles["transport_rate/velocity_density"][()]
            numpy.testing.assert_allclose((density * numpy.diff(edges)[:, None]).sum(axis=0), 1.0, atol=1e-9)

    def test_what_cannot_be_measured_is_refused(self):
        self.assert_refused("run", self.case, "--set", "domain.boundaries.bottom=periodic", "--set",
                            "domain.boundaries.top=periodic", "--set", "analysis.transport_rate.from=0",
                            words=["analysis.bed_surface", "periodic"])
        self.assert_refused("run", self.case, "--set", "grains=[]", "--set", "analysis.transport_rate=",
                            words=["analysis.bed_surface", "no grains"])
        self.assert_refused("run", self.case, "--set", "analysis.reference_diameter=0",
                            words=["analysis.reference_diameter = 0", "a number in m above 0"])


if __name__ == "__main__":
    program.main()
