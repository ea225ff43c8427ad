#!/usr/bin/env python3
"""Grains and solids in one case, with water and without.

Called by ctest: solids_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest
from stl_box import write_box
from thalweg import Run

GLASS = "contact: {restitution: 0.5, friction: 0.5, wall_friction: 0.4, duration: 1.0e-3}"
IN_WATER = f"""{GLASS}
run: {{until: 0.12}}
output:
  series: {{every: 0.01}}
  grains: {{every: 0.04}}
  checkpoint: {{every: 0.06, keep: 3}}
"""


class InWater(ProgramTest):
    def series_of_the_same_bits_anywhere(self):
        self.run_well("run", self.case, "--out", "one")
        self.run_well("run", self.case, "--out", "two", ranks=2)
        self.run_well(
            "run", self.case, "--out", "again", "--restart", self.folder / "one/checkpoints/step_600.h5", ranks=2
        )
        for out in ("two", "again"):
            self.assert_same_end(out, "one")
        return Run(self.folder / "one").series


class SolidsInWater(InWater):
    # A sill across the channel and a ball across the periodic ends; grains fall on both.
    CASE = f"""
system: resolved
name: sill and ball
domain: {{size: [0.030, 0.015, 0.030], spacing: 0.75e-3, boundaries: {{x: periodic, y: no_slip, bottom: no_slip, top: free_slip}}}}
fluid: {{density: 1000, kinematic_viscosity: 1.0e-6, time_step: 1.0e-4, precision: single}}
gravity: {{magnitude: 9.8, slope: 0.05}}
grains:
  - {{count: 24, diameter: 4.5e-3, density: 2550, placement: {{pattern: random, seed: 3}}}}
solids:
  - {{stl: sill.stl, scale: 1.0e-3, translate: [0.012, 0, 0], friction: 0.3}}
  - {{sphere: {{centre: [0.0005, 0.0075, 0.0035], radius: 3.5e-3}}}}
{IN_WATER}"""

    def setUp(self):
        super().setUp()
        write_box(self.folder / "sill.stl", (0, -1, -1), (5, 16, 6))

    def test_the_same_bits_on_any_ranks_and_after_a_restart(self):
        series = self.series_of_the_same_bits_anywhere()
        for solid in (0, 1):
            self.assertLess(series[f"solid_{solid}_grain_force_z"].min(), 0.0)
            self.assertTrue(numpy.isfinite(series[f"solid_{solid}_force_x"]).all())
        # No grain is in the sill.
        for frame in Run(self.folder / "one").grains:
            x, y, z = frame.position.T
            inside = (x > 0.012) & (x < 0.017) & (z < 0.006)
            self.assertFalse(inside.any(), frame.time)
        # For ParaView once, because they stand still: the sill, and a sphere of triangles.
        (surfaces,) = Run(self.folder / "one").solids
        sill, ball = (surfaces.points[numpy.unique(surfaces.triangles[surfaces.solid == n])] for n in (0, 1))
        numpy.testing.assert_allclose(
            [sill.min(axis=0), sill.max(axis=0)], [[0.012, -0.001, -0.001], [0.017, 0.016, 0.006]]
        )
        numpy.testing.assert_allclose(numpy.linalg.norm(ball - [0.0005, 0.0075, 0.0035], axis=1), 3.5e-3)

    def test_a_restart_that_is_the_first_to_have_frames_shows_the_solids(self):
        none = ("--set", "output.grains.every=0")
        self.run_well("run", self.case, "--out", "run", "--until", "0.06", *none)
        self.assertFalse((self.folder / "run/solids.pvd").exists())
        self.run_well("run", self.case, "--restart", "run", "--until", "0.08", ranks=2)
        (surfaces,) = Run(self.folder / "run").solids
        self.assertEqual(sorted(numpy.unique(surfaces.solid)), [0, 1])
        self.run_well("run", self.case, "--restart", "run", "--until", "0.09")   # one is enough
        self.assertEqual(len(Run(self.folder / "run").solids), 1)

    def test_what_cannot_be_is_refused(self):
        self.assert_refused("check", self.case, "--set", "solids.0.motion={velocity: [3, 0, 0]}",
                            words=["solids.0.motion", "0.4 cells per step", "fluid.time_step"])
        self.assert_refused("check", self.case, "--set",
                            "solids.1.motion={rotation: {point: [0, 0.0075, 0.02], angular_velocity: 1}}",
                            words=["solids.1.motion.rotation", "would meet its own image along x"])
        self.assert_refused(
            "check", self.case, "--set", "grains.0.count=1", "--set",
            "grains.0.placement={positions: [[0.014, 0.007, 0.003]]}", words=["Grain 0", "is inside solid 0"],
        )


class SolidsThatMoveInWater(InWater):
    # A plate ploughs along the channel and across its periodic end, a wheel turns in the water; grains lie before the
    # plate.
    CASE = f"""
system: resolved
name: plough
domain: {{size: [0.036, 0.015, 0.030], spacing: 0.75e-3, boundaries: {{x: periodic, y: no_slip, bottom: no_slip, top: free_slip}}}}
fluid: {{density: 1000, kinematic_viscosity: 1.0e-6, time_step: 1.0e-4, precision: single}}
gravity: {{magnitude: 9.8, slope: 0.0}}
grains:
  - {{count: 12, diameter: 4.5e-3, density: 2550, placement: {{pattern: random, seed: 3, region: {{lower: [0.011, 0, 0], upper: [0.034, 0.015, 0.012]}}}}}}
solids:
  - {{stl: plate.stl, scale: 1.0e-3, motion: {{velocity: [0.15, 0, 0]}}}}
  - {{stl: wheel.stl, scale: 1.0e-3, motion: {{rotation: {{point: [0.024, 0.0075, 0.022], angular_velocity: 15}}}}}}
{IN_WATER}"""

    def setUp(self):
        super().setUp()
        write_box(self.folder / "plate.stl", (7, -1, -1), (10, 16, 9))
        write_box(self.folder / "wheel.stl", (18, 3, 20.5), (30, 12, 23.5))

    def test_the_same_bits_on_any_ranks_and_after_a_restart(self):
        series = self.series_of_the_same_bits_anywhere()
        self.assertLess(series["solid_0_grain_force_x"].min(), 0.0)   # grains stand in its way
        self.assertGreater(numpy.abs(series["solid_1_torque_y"]).max(), 0.0)
        self.assertNotIn("solid_0_torque_y", series)                  # it does not turn
        # The plate has come from 7 to 25 mm, through where grains lay, and none is in it.
        for frame in Run(self.folder / "one").grains:
            x, _, z = frame.position.T
            behind = (x - 0.007 - 0.15 * frame.time) % 0.036
            self.assertFalse(((behind < 0.003) & (z < 0.009)).any(), frame.time)
        self.check_surfaces()

    # One for each frame of the grains, of the plate and then of the wheel, about the y axis through its middle.
    def check_surfaces(self):
        run = Run(self.folder / "one")
        numpy.testing.assert_array_equal(run.solids.times, run.grains.times)
        first = run.solids[0].points
        for frame in run.solids:
            plate, wheel = (frame.points[numpy.unique(frame.triangles[frame.solid == n])] for n in (0, 1))
            numpy.testing.assert_allclose(plate, first[:8] + [0.15 * frame.time, 0.0, 0.0], atol=1e-12)
            turned = 15.0 * frame.time
            x, z = (first[8:] - [0.024, 0.0, 0.022]).T[[0, 2]]
            place = numpy.stack([0.024 + x * numpy.cos(turned) + z * numpy.sin(turned), first[8:, 1],
                                 0.022 - x * numpy.sin(turned) + z * numpy.cos(turned)], axis=1)
            numpy.testing.assert_allclose(wheel, place, atol=1e-12)
        for out in ("two", "again"):
            for path in (self.folder / out / "solids").iterdir():
                self.assertEqual(path.read_bytes(), (self.folder / "one/solids" / path.name).read_bytes(), path)

    def test_another_motion_does_not_go_on(self):
        self.run_well("run", self.case, "--out", "one", "--until", "0.005")
        self.assert_refused("run", self.case, "--out", "other", "--restart", self.folder / "one", "--set",
                            "solids.0.motion.velocity=[0.1, 0, 0]", words=["solids.0.motion.velocity", "would jump"])


class SolidsAmongDryGrains(ProgramTest):
    # A gate that sinks out of the way lets grains down.
    CASE = f"""
system: grains
name: gate
domain: {{size: [0.03, 0.03, 0.06], spacing: 3.0e-3, boundaries: {{x: no_slip, y: no_slip, bottom: no_slip, top: no_slip}}}}
gravity: {{magnitude: 9.8, slope: 0.0}}
grains:
  - {{count: 60, diameter: 3.0e-3, density: 2550, placement: {{pattern: random, seed: 1, region: {{lower: [0.001, 0.001, 0.032],
      upper: [0.029, 0.029, 0.058]}}}}}}
solids:
  - {{stl: shelf.stl, scale: 1.0e-3}}
  - {{stl: gate.stl, scale: 1.0e-3, motion: {{velocity: [0.1, 0, 0]}}}}
{GLASS}
run: {{until: 0.3}}
output: {{series: {{every: 0.01}}, grains: {{every: 0.1}}, checkpoint: {{every: 0.1, keep: 4}}}}
"""

    def setUp(self):
        super().setUp()
        write_box(self.folder / "shelf.stl", (-1, -1, 27), (15, 31, 30))
        write_box(self.folder / "gate.stl", (15.1, -1, 27), (32, 31, 30))

    def test_a_gate_that_moves_lets_grains_down(self):
        self.run_well("run", self.case, "--out", "one")
        self.run_well("run", self.case, "--out", "two", ranks=2)
        earlier = min((self.folder / "one/checkpoints").glob("step_*.h5"), key=lambda path: int(path.stem[5:]))
        self.run_well("run", self.case, "--out", "again", "--restart", earlier)
        for out in ("two", "again"):
            self.assert_same_end(out, "one")
        first, *_, last = Run(self.folder / "one").grains
        self.assertEqual((first.position[:, 2] < 0.027).sum(), 0)
        self.assertGreater((last.position[:, 2] < 0.027).sum(), 10)   # through where the gate was
        self.assertGreater((last.position[:, 2] > 0.030).sum(), 5)    # on the shelf


if __name__ == "__main__":
    program.main()
