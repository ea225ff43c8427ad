#!/usr/bin/env python3
"""Grains in a resolved flow, from the case file to the last checkpoint.

Called by ctest: resolved_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import h5py
import numpy
from vtk.util.numpy_support import vtk_to_numpy
from vtk import vtkXMLImageDataReader, vtkXMLPolyDataReader

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest
from thalweg import Run


class ResolvedRun(ProgramTest):
    # A short narrow flume in which everything moves: grains fall, meet each other, the floor and the side walls, and
    # cross the borders between ranks and the periodic faces.
    CASE = """
system: resolved
name: short flume
domain:
  size: [0.0396, 0.010725, 0.0396]   # m
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
  - {count: 70, diameter: 4.95e-3, density: 2550, placement: {pattern: uniform, seed: 1}, velocity: [0.3, 0.0, -0.1]}
contact: {normal_stiffness: 20000, tangential_stiffness: 5714, restitution: 0.93, friction: 0.5, wall_friction: 0.45}
coupling: {grain_steps_per_fluid_step: 20}
initial: {fluid: {uniform: [0.3, 0.0, 0.0]}}
run: {until: 0.06}
output:
  series: {every: 0.01}
  grains: {every: 0.03}
  fluid: {every: 0.03, fields: [velocity, pressure, grain_id]}
  checkpoint: {every: 0.03, keep: 3}
analysis:
  transport_rate: {from: 0.02}
"""

    def test_the_same_bits_on_any_ranks_and_layout(self):
        self.run_well("run", self.case, "--out", "one")
        for ranks, layout in ((2, "2,1,1"), (2, "1,1,2"), (4, "4,1,1"), (4, "2,2,1")):
            out = "on_" + layout.replace(",", "x")
            self.run_well("run", self.case, "--out", out, "--layout", layout, ranks=ranks)
            self.assert_same_end(out, "one", "series.csv")
        # Most of the work is in the lower half, where the bed will be.
        self.assertIn("load-balanced blocks end along z at cells",
                      (self.folder / "on_1x1x2/run.log").read_text())

    def test_a_restart_on_other_ranks_changes_nothing(self):
        self.run_well("run", self.case, "--out", "straight")
        half_way = self.folder / "straight/checkpoints/step_300.h5"
        self.run_well("run", self.case, "--out", "again", "--restart", half_way, "--layout", "1,1,2", ranks=2)
        self.assert_same_end("again", "straight")

    def test_looking_at_every_field_changes_nothing(self):
        fields = "[velocity, density, grain_id, shear_rate, eddy_viscosity, vorticity, q_criterion]"
        self.run_well("run", self.case, "--out", "unseen", "--until", "0.025", "--set", "output.fluid.every=0")
        self.run_well("run", self.case, "--out", "seen", "--until", "0.025", "--set",
                      f"output.fluid={{every: 1e-3, region: slice_y, fields: {fields}}}", ranks=2)
        self.assert_same_end("seen", "unseen")

    def test_the_stress_balance_has_the_same_bits_on_any_ranks_and_after_a_restart_and_touches_nothing(self):
        measured = ("--until", "0.01", "--set", "analysis.stress_balance={from: 0.002, every: 0.0007}", "--set",
                    "output.checkpoint.every=0.005")
        self.run_well("run", self.case, "--out", "one", *measured)
        self.run_well("run", self.case, "--out", "two", "--layout", "1,1,2", *measured, ranks=2)
        self.run_well("run", self.case, "--out", "again", "--restart", self.folder / "one/checkpoints/step_50.h5",
                      *measured, ranks=2)
        for out in ("two", "again"):
            self.assert_same_end(out, "one", "profiles.h5")
        self.assertEqual(self.summary("again")["stress_balance"], self.summary("one")["stress_balance"])
        self.assertIn("of the total stress from the driving stress", (self.folder / "one/run.log").read_text())
        self.run_well("run", self.case, "--out", "unseen", "--until", "0.01")
        with h5py.File(self.last_checkpoint("one")) as one, h5py.File(self.last_checkpoint("unseen")) as unseen:
            for name in ("grains/position", "grains/angular_velocity", "fluid/populations_07"):
                self.assertEqual(one[name][()].tobytes(), unseen[name][()].tobytes(), name)
        with h5py.File(self.folder / "one/profiles.h5") as profiles:
            group = profiles["stress_balance"]
            self.assertEqual(group["total_stress"].attrs["units"], b"Pa")
            self.assertEqual(group["drag_density"].shape, (len(group["z"]), 3))
            self.assertAlmostEqual(sum(group["thickness"][()]), 0.0396, places=12)
            # All grains are in the box: 70 spheres over its area.
            grains = 70 * numpy.pi / 6 * 4.95e-3 ** 3 / (0.0396 * 0.010725)
            self.assertAlmostEqual(numpy.dot(group["solid_fraction"][()], group["thickness"][()]), grains,
                                   delta=1e-4 * grains)
            # Eq. 25 of Zhang et al. (2022): F over the drag of Stokes, and the Reynolds number of the slip.
            phi = group["solid_fraction"][()]
            slip = group["fluid_velocity"][()] - group["grain_velocity"][()]
            among = phi > 0.01
            self.assertGreater(among.sum(), 20)
            phi, slip, drag = phi[among], slip[among], group["drag_density"][()][among]
            stokes = 18 * phi * (1 - phi) * 1e-3 * slip[:, 0] / 4.95e-3 ** 2
            numpy.testing.assert_allclose(group["drag_function"][()][among] * stokes, drag[:, 0], rtol=1e-9)
            numpy.testing.assert_allclose(group["drag_reynolds_number"][()][among],
                                          (1 - phi) * numpy.linalg.norm(slip, axis=1) * 4.95e-3 / 1e-6, rtol=1e-9)

    def test_a_stress_balance_that_cannot_be_is_refused(self):
        balance = ("--set", "analysis.stress_balance={from: 0}")
        for setting, words in (
                ("domain.boundaries={x: periodic, y: periodic, bottom: periodic, top: periodic}",
                 ("analysis.stress_balance", "bottom and top")),
                ("run.ramp=0.01", ("analysis.stress_balance.from", "at least run.ramp")),
                ("analysis.stress_balance.layer=0", ("analysis.stress_balance.layer",))):
            with self.subTest(setting):
                self.assert_refused("check", self.case, *balance, "--set", setting, words=words)

    def test_double_precision_has_the_same_bits_too(self):
        for out, ranks in (("one", 1), ("two", 2)):
            self.run_well("run", self.case, "--out", out, "--set", "fluid.precision=double", "--until", "0.025",
                          ranks=ranks)
        self.assert_same_end("one", "two")

    def test_options_of_the_coupling_have_the_same_bits_after_a_restart(self):
        options = [
            "--set", "coupling.lubrication={}", "--set", "coupling.links=cli", "--set", "grains.0.density=1200",
            "--set", "fluid.kinematic_viscosity=1e-5", "--set", "output.checkpoint.every=0.01", "--until", "0.02",
        ]
        self.run_well("run", self.case, "--out", "straight", *options)
        half_way = self.folder / "straight/checkpoints/step_100.h5"
        self.run_well("run", self.case, "--out", "again", "--restart", half_way, *options, ranks=2)
        self.assert_same_end("again", "straight")
        # Each of the two moves the grains: without it they end elsewhere.
        places = self.bed("straight")["position"].tobytes()
        for without in ("coupling.lubrication=null", "coupling.links=null"):
            self.run_well("run", self.case, "--out", without, *options, "--set", without)
            self.assertNotEqual(self.bed(without)["position"].tobytes(), places, without)

    def test_what_it_writes_can_be_opened(self):
        self.run_well("run", self.case, ranks=2)
        run = self.folder / "run"
        summary = self.summary("run")
        self.assertTrue(summary["finished"])
        self.assertGreater(summary["transport_rate"]["q_star_mean"], 0)
        # k_n holds the grains apart: an impact at v overlaps by v sqrt(m/2/k_n), below 1 % of a diameter up to 1 m/s.
        self.assertLess(summary["largest"]["largest_overlap"], 0.02)

        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(run / "grains/grains_000000600.vtp"))
        reader.Update()
        grains = reader.GetOutput()
        self.assertEqual(grains.GetNumberOfPoints(), 70)
        points = vtk_to_numpy(grains.GetPoints().GetData())
        self.assertTrue((points >= 0).all() and (points <= [0.0396, 0.010725, 0.0396]).all())
        ids = vtk_to_numpy(grains.GetPointData().GetArray("id"))
        self.assertEqual(ids.tolist(), list(range(70)))
        with h5py.File(self.last_checkpoint("run")) as checkpoint:
            numpy.testing.assert_allclose(points, checkpoint["grains/position"][()], atol=1e-8)

        # The map is that of the step before and lags behind a grain by the way of one step and the link tolerance:
        # below a tenth of a cell at these speeds. All other cells are solid exactly where a centre is inside a grain.
        spacing, length = 0.825e-3, 0.0396
        reader = vtkXMLImageDataReader()
        reader.SetFileName(str(run / "fluid/fluid_000000600.vti"))
        reader.Update()
        image = reader.GetOutput()
        x0, x1, y0, y1, z0, z1 = image.GetExtent()   # of corners
        z, y, x = numpy.meshgrid(numpy.arange(z0, z1), numpy.arange(y0, y1), numpy.arange(x0, x1), indexing="ij")
        centres = (numpy.stack([x.ravel(), y.ravel(), z.ravel()], axis=1) + 0.5) * spacing
        nearest = numpy.full(len(centres), numpy.inf)
        for point in points:
            offset = centres - point
            offset[:, 0] -= length * numpy.round(offset[:, 0] / length)
            nearest = numpy.minimum(nearest, numpy.linalg.norm(offset, axis=1))
        covering = vtk_to_numpy(image.GetCellData().GetArray("grain_id"))
        velocity = vtk_to_numpy(image.GetCellData().GetArray("velocity"))
        self.assertTrue((covering[nearest < 2.475e-3 - 0.1 * spacing] >= 0).all())
        self.assertTrue((covering[nearest > 2.475e-3 + 0.1 * spacing] == -1).all())
        self.assertTrue((velocity[covering >= 0] == 0).all())
        self.assertTrue(numpy.isfinite(velocity).all())
        self.assertEqual(len(covering), 48 * 13 * 48)

    def test_check_says_how_fast_water_seeps_through_a_bed(self):
        bgk = self.run_well("check", self.case, "--set", "fluid.collision=bgk").stdout
        self.assertIn("With bgk, water seeps through a dense bed at about 0.005 times the right speed", bgk)
        self.assertNotIn("seeps", self.run_well("check", self.case).stdout)


class AtRest(ProgramTest):
    """Oil at rest under its own weight, around a sphere that is held: pressures and forces in Pa and N."""
    CASE = """
system: resolved
name: at rest
domain:
  size: [0.010, 0.010, 0.020]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}
fluid: {density: 1200, kinematic_viscosity: 1.0e-5, collision: trt, subgrid_model: none, time_step: 5.0e-5,
        precision: double}
gravity: {magnitude: 9.8, mode: full}
coupling: {links: cli}
grains: [{diameter: 5.0e-3, density: 2500, fixed: true, placement: {positions: [[0.005, 0.005, 0.0081]]}}]
contact: {restitution: 0.5}
run: {until: 0.005}
output: {series: {every: 0.005}, fluid: {every: 0.005, fields: [velocity, pressure, grain_id], precision: double}}
analysis: {wall_forces: {}, population_loads: {}}
"""

    def test_pressure_and_buoyancy_are_those_of_its_weight(self):
        self.run_well("run", self.case)
        last = Run(self.folder / "run").fluid[-1]
        free = last.arrays["grain_id"] < 0
        # With the links of cli the fluid stays at rest exactly (full_gravity_test.cpp): what is left is round-off, of a
        # velocity unit of 10 m/s and a pressure of rho c_s^2 = 40 kPa. The pressure is nought in the middle.
        self.assertLess(abs(last.arrays["velocity"]).max(), 1e-12)
        weight = 1200 * 9.8 * (0.010 - last.centres("z"))[:, None, None] + 0 * last.arrays["pressure"]
        numpy.testing.assert_allclose(last.arrays["pressure"][free], weight[free], atol=1e-8)
        # Floor and lid have half of the weight of the full box each, the grain that of the cells it covers, which the
        # fluid lacks: of the same volume as the sphere but for what lies between cell centres, to 2 % here.
        series, plan = self.series(), 0.010 ** 2
        for face in ("bottom", "top"):
            force = series[f"fluid_wall_force_{face}_z"][-1]
            self.assertAlmostEqual(force / (1200 * 9.8 * 0.010 * plan), -1, delta=1e-6)
        lift = series["grains_0_fluid_force_z"][-1]
        self.assertAlmostEqual(lift / (1200 * 9.8 * (~free).sum() * 0.5e-3 ** 3), 1, delta=1e-6)
        self.assertAlmostEqual(lift / (1200 * 9.8 * numpy.pi / 6 * 5e-3 ** 3), 1, delta=0.02)


class Film(ProgramTest):
    """A sphere that is moved along a floor and towards it, turns, and leaves a film of oil."""
    CASE = """
system: resolved
name: film
domain:
  size: [0.012, 0.012, 0.012]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-4, time_step: 2.0e-4, subgrid_model: none, collision: trt}
gravity: {magnitude: 9.8}
grains:
  - diameter: 5.0e-3
    density: 2500
    prescribed_velocity: [0.01, 0, -0.02]
    prescribed_angular_velocity: [0, 3, 0]
    placement: {positions: [[0.006, 0.006, 0.0028]]}
contact: {restitution: 0.5}
coupling: {lubrication: {normal_cut_off: 1.0, tangential_cut_off: 0.8, minimum_gap: 0.08}, links: cli}
run: {until: 0.008}
output: {series: {every: 0.002}}
analysis: {wall_forces: {}, population_loads: {}}
"""

    def test_lubrication_has_the_cut_offs_of_the_case(self):
        # docs/theory.md, section 3, "Lubrication", at a wall: r = R and q = 0. Cut-offs of 0.5 and 0.4 mm; the gap
        # falls from 0.3 to 0.14 mm, and counts as 0.2 mm, 0.08 R, where it is less.
        self.run_well("run", self.case)
        series, radius, viscosity = self.series(), 2.5e-3, 0.1
        gap = 0.3e-3 - 0.02 * series["time"]
        film = numpy.maximum(gap, 0.2e-3)
        normal = 6 * numpy.pi * viscosity * radius ** 2 * 0.02 * (1 / film - 1 / 0.5e-3)
        sliding = 0.01 - 3 * (radius + gap)   # of the surfaces, at the floor
        along = numpy.pi * viscosity * numpy.log(0.4e-3 / film) * (
            -16 / 5 * radius * sliding - 12 / 5 * radius ** 2 * 3)
        for name, expected in (("z", normal), ("x", along)):
            self.assertGreater(abs(expected).min(), 1e-7)
            numpy.testing.assert_allclose(series[f"grains_0_contact_force_{name}"], expected, rtol=1e-6)
            numpy.testing.assert_allclose(series[f"wall_force_bottom_{name}"], -expected, rtol=1e-6)


if __name__ == "__main__":
    program.main()
