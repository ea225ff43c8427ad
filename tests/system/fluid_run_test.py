#!/usr/bin/env python3
"""A fluid alone, from the case file to the last checkpoint.

Called by ctest: fluid_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import json
import sys
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from pictures import cell_data
from program import ProgramTest
from stl_box import write_box
from thalweg import Run


class Flume(ProgramTest):
    # Side walls, subgrid eddies and a steered force: whatever a fluid alone can have in its state.
    CASE = """
system: fluid
name: empty flume
domain:
  size: [0.020, 0.0105, 0.013]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: law_of_the_wall, bottom: no_slip, top: free_slip}
fluid:
  density: 1000
  kinematic_viscosity: 1.0e-6
  smagorinsky_constant: 0.27
  time_step: 5.0e-5
  precision: single
  mean_velocity: {velocity: 0.4, response_time: 0.01}
gravity: {magnitude: 9.8, slope: 0.0}
initial: {fluid: {log_profile: {bed_height: 0.0, shear_velocity: 0.03, roughness: 1.0e-5, perturbation: {amplitude: 2, seed: 5}}}}
run: {until: 0.02}
output: {series: {every: 0.005}, checkpoint: {every: 0.01, keep: 3}}
"""

    def test_the_same_bits_on_any_ranks(self):
        self.run_well("run", self.case, "--out", "one")
        for ranks, layout in ((2, "2,1,1"), (2, "1,1,2"), (4, "2,2,1")):
            out = "on_" + layout.replace(",", "x")
            self.run_well("run", self.case, "--out", out, "--layout", layout, ranks=ranks)
            self.assert_same_end(out, "one", "series.csv")

    def test_a_restart_on_other_ranks_changes_nothing(self):
        self.run_well("run", self.case, "--out", "straight", ranks=2)
        half_way = self.folder / "straight/checkpoints/step_200.h5"
        self.run_well("run", self.case, "--out", "again", "--restart", half_way)
        self.assert_same_end("again", "straight")

    def test_any_number_of_fluid_outputs(self):
        parts = (
            "--set", "output.fluid={every: 1e-3, fields: [velocity, pressure]}", "--set",
            "output.fluid_parts=[{name: near_bed, every: 5e-4, fields: [velocity], box: {lower: [0, 0, 0], upper: "
            "[0.02, 0.0105, 0.004]}, stride: 2}, {name: plane, every: 1e-3, fields: [pressure], plane: {axis: x, at: "
            "0.0052}}]", "--set", "output.checkpoint.every=1e-3",
        )
        self.run_well("run", self.case, "--out", "one", "--until", "0.002", *parts)
        self.run_well("run", self.case, "--out", "two", "--until", "0.001", *parts, ranks=2)
        self.run_well("run", self.case, "--out", "two", "--restart", "two", "--until", "0.002", *parts, ranks=4)
        one, two = (sorted(path for kind in ("*.pvd", "*.vti") for path in (self.folder / out).rglob(kind))
                    for out in ("one", "two"))
        self.assertEqual([path.read_bytes() for path in one], [path.read_bytes() for path in two])
        run = Run(self.folder / "one")
        self.assertEqual(len(run.fluid_part("near_bed")), 5)
        self.assertEqual(len(run.fluid_part("plane")), 3)
        whole, bed, plane = run.fluid[2], run.fluid_part("near_bed")[4], run.fluid_part("plane")[2]
        self.assertEqual(whole.time, bed.time)
        numpy.testing.assert_array_equal(bed.arrays["velocity"], whole.arrays["velocity"][:8:2, ::2, ::2])
        numpy.testing.assert_array_equal(plane.arrays["pressure"], whole.arrays["pressure"][:, :, 10:11])
        for axis in range(3):   # every second cell, where it is
            numpy.testing.assert_allclose(
                bed.centres(axis), whole.centres(axis)[: 2 * len(bed.centres(axis)) : 2], rtol=1e-12
            )

    def test_frames_in_double_precision(self):
        frames = (
            "--set", "fluid.precision=double", "--set", "output.fluid={every: 2e-3, fields: [velocity, pressure]}",
            "--set",
            "output.fluid_parts=[{name: precise, every: 2e-3, precision: double, region: slice_y, fields: "
            "[velocity, pressure, grain_id]}]", "--until", "0.002",
        )
        for out, ranks in (("one", 1), ("four", 4)):
            self.run_well("run", self.case, "--out", out, *frames, ranks=ranks)
        file = "fluid_parts/precise/precise_000000040.vti"
        self.assertEqual((self.folder / "one" / file).read_bytes(), (self.folder / "four" / file).read_bytes())
        run = Run(self.folder / "one")
        whole, precise = run.fluid[1].arrays, run.fluid_part("precise")[1].arrays
        self.assertEqual(precise["grain_id"].dtype, numpy.int32)
        for name in ("velocity", "pressure"):
            self.assertEqual((whole[name].dtype, precise[name].dtype), (numpy.float32, numpy.float64))
            numpy.testing.assert_array_equal(precise[name].astype(numpy.float32), whole[name][:, 10:11], name)
            self.assertTrue((precise[name] != whole[name][:, 10:11]).mean() > 0.9)
        self.assert_refused("check", self.case, "--set", "output.fluid.precision=half",
                            words=["output.fluid.precision = \"half\"", "single, double"])

    def test_outputs_that_show_nothing_are_refused(self):
        for part, words in (
            ("{name: a b, every: 1}", ["output.fluid_parts.0.name", "letters, digits and underscores"]),
            ("{name: a}", ["output.fluid_parts.0.every", "above 0"]), ("{every: 1}", ["output.fluid_parts.0.name"]),
            ("{name: a, stride: 0}", ["output.fluid_parts.0.stride", "at least 1"]),
            ("{name: a, every: 1}, {name: a, every: 1}", ["output.fluid_parts", "two of them have the same name"]),
            (
                "{name: a, every: 1, plane: {axis: z, at: 0.1}}",
                ["output.fluid_parts.0.plane.at = 0.1", "between 0 and 0.013"],
            ),
            ("{name: a, every: 1, region: slice_x, plane: {axis: z, at: 0.01}}", ["only one of region, box and plane"]),
            (
                "{name: a, every: 1, box: {lower: [0, 0, 0], upper: [0.02, 0.02, 0.01]}}",
                ["output.fluid_parts.0.box", "out of the domain"],
            ),
            (
                "{name: a, every: 1, box: {lower: [0, 0, 0.005], upper: [0.02, 0.01, 0.005]}}",
                ["no cell has its centre"],
            ),
        ):
            self.assert_refused("check", self.case, "--set", f"output.fluid_parts=[{part}]", words=words)

    ALL_FIELDS = "[velocity, pressure, density, shear_rate, eddy_viscosity, vorticity, q_criterion]"

    def test_all_fields_are_the_same_on_any_ranks_and_looking_changes_nothing(self):
        short = ("--until", "0.005")
        self.run_well("run", self.case, "--out", "unseen", *short)
        for out, ranks, region in (("one", 1, "slice_y"), ("four", 4, "slice_y"), ("whole", 2, "whole")):
            self.run_well("run", self.case, "--out", out, *short, "--set",
                          f"output.fluid={{every: 1e-3, region: {region}, fields: {self.ALL_FIELDS}}}", ranks=ranks)
            self.assert_same_end(out, "unseen")
        one, whole = (cell_data(self.folder / out / "fluid/fluid_000000100.vti") for out in ("one", "whole"))
        self.assertEqual(*((self.folder / out / "fluid/fluid_000000100.vti").read_bytes() for out in ("one", "four")))
        self.assertEqual(set(one), set(self.ALL_FIELDS[1:-1].split(", ")))
        for name, values in one.items():
            middle = whole[name].shape[1] // 2
            numpy.testing.assert_array_equal(values, whole[name][:, middle:middle + 1], name)
        self.assertGreater(one["shear_rate"].max(), 10.0)   # 1/s; the mean alone has 0.4 m/s over 13 mm
        # (C_s dx)^2 times the shear rate, in single precision.
        numpy.testing.assert_allclose(one["eddy_viscosity"], (0.27 * 0.5e-3) ** 2 * one["shear_rate"], rtol=1e-6)
        # rho = rho_0 + p/c_s^2 with c_s^2 = (dx/dt)^2/3, to the last places of a density in single precision.
        numpy.testing.assert_allclose(one["density"], 1000 + one["pressure"] * 3 / 10.0 ** 2, rtol=1e-6)
        # Central differences of the picture's velocities (x y z along the last axis, of which x is the third), in the
        # cells that have neighbours on all sides. Both are rounded in single precision of the lattice velocity unit,
        # 10 m/s, over a spacing.
        velocity = whole["velocity"].astype(float)
        inside = (slice(1, -1),) * 3
        gradient = numpy.stack(numpy.gradient(velocity, 0.5e-3, axis=(2, 1, 0)), axis=-1)[inside]   # du_a/dx_b
        spin = numpy.stack([gradient[..., (a + 2) % 3, (a + 1) % 3] - gradient[..., (a + 1) % 3, (a + 2) % 3]
                            for a in range(3)], axis=-1)
        rounding = 10.0 * 2.0 ** -22 / 0.5e-3
        self.assertGreater(abs(spin).max(), 100 * rounding)
        numpy.testing.assert_allclose(whole["vorticity"][inside], spin, atol=rounding)
        # Q = (W:W - S:S)/2 is -tr(G G)/2 of a gradient G whatever its trace.
        q = -0.5 * numpy.einsum("...ab,...ba", gradient, gradient)
        numpy.testing.assert_allclose(whole["q_criterion"][inside], q, atol=9 * abs(gradient).max() * rounding)
        self.assertGreater(abs(q).max(), 100 * abs(gradient).max() * rounding)

    def test_means_have_the_same_bits_on_any_ranks_and_after_a_restart(self):
        means = ("--set", "analysis.fluid_statistics={from: 0.002, every: 0.001}")
        self.run_well("run", self.case, "--out", "straight", *means)
        half_way = self.folder / "straight/checkpoints/step_200.h5"
        self.run_well("run", self.case, "--out", "again", "--restart", half_way, *means, ranks=4)
        self.assert_same_end("again", "straight", "profiles.h5")
        with h5py.File(self.folder / "straight/profiles.h5") as profiles:
            group = profiles["fluid_statistics"]
            self.assertEqual(group["velocity"].attrs["units"], b"m/s")
            self.assertEqual(group["reynolds_stress"].attrs["components"], b"xx yy zz xy xz yz")
            self.assertEqual(group["section_velocity"].shape, (26, 21, 3))
            numpy.testing.assert_allclose(group["section_velocity"][()].mean(axis=1), group["velocity"][()], atol=1e-11)
            self.assertAlmostEqual(self.summary("again")["fluid_statistics"]["mean_velocity_x"],
                                   group["velocity"][:, 0].mean(), delta=1e-11)
        self.assertEqual(self.summary("again")["fluid_statistics"]["measurements"], 19)

    def test_means_are_those_of_the_pictures(self):
        # Six moments, of which the pictures show every cell and every digit.
        self.run_well("run", self.case, "--out", "run", "--until", "1e-3", "--set", "fluid.precision=double", "--set",
                      "analysis.fluid_statistics={every: 2e-4}", "--set",
                      "output.fluid={every: 2e-4, region: whole, precision: double, fields: [velocity]}")
        u = numpy.stack([frame.arrays["velocity"] for frame in Run(self.folder / "run").fluid])   # [time, z, y, x, axis]
        self.assertEqual(u.shape, (6, 26, 21, 40, 3))
        means = Run(self.folder / "run").profiles["fluid_statistics"]
        # Every velocity counts to 2^-40 of the lattice velocity unit, 10 m/s; nothing is faster than 0.6 m/s.
        step = 10.0 * 2.0 ** -40
        for name, over in (("", (0, 2, 3)), ("section_", (0, 3))):
            mean = u.mean(axis=over)
            numpy.testing.assert_allclose(means[f"{name}velocity"], mean, atol=step)
            stress = numpy.stack([(u[..., a] * u[..., b]).mean(axis=over) - mean[..., a] * mean[..., b]
                                  for a, b in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))], axis=-1)
            self.assertGreater(abs(stress).max(axis=tuple(range(stress.ndim - 1))).min(), 1e-6)
            numpy.testing.assert_allclose(means[f"{name}reynolds_stress"], stress, atol=4 * 0.6 * step)

    def test_the_start_is_a_log_profile_with_eddies_on_top(self):
        calm = "initial.fluid={log_profile: {bed_height: 0.0, shear_velocity: 0.03, roughness: 1.0e-5}}"
        pictures = ("--until", "1e-4", "--set", "output.fluid={every: 1e-4, fields: [velocity, pressure]}", "--set",
                    "fluid.mean_velocity=null")
        self.run_well("run", self.case, "--out", "calm", *pictures, "--set", calm)
        self.run_well("run", self.case, "--out", "lively", *pictures)
        before, after = (cell_data(self.folder / out / "fluid/fluid_000000000.vti")["velocity"].astype(float)
                         for out in ("calm", "lively"))
        eddies = after - before
        # Single precision of the populations: 1e-7 of the lattice velocity unit, 10 m/s.
        numpy.testing.assert_allclose(eddies.mean(axis=2), 0, atol=2e-6)
        middle = eddies[8:18, 6:15]
        # Asked for are 0.06 m/s in a box of infinitely many eddies; here are a few dozen.
        self.assertGreater(numpy.sqrt((middle ** 2).mean()), 0.03)
        self.assertLess(numpy.sqrt((middle ** 2).mean()), 0.12)
        numpy.testing.assert_allclose(before[:, 3, 5, 0], 0.03 / 0.41 * numpy.log((numpy.arange(26) + 0.5) * 50),
                                      atol=2e-6)

    def test_begins_from_the_field_of_another_run(self):
        free = (
            "--set", "fluid.mean_velocity=null", "--set", "output.fluid={every: 0.01, fields: [velocity, pressure]}",
        )
        self.run_well("run", self.case, "--out", "first", *free)
        last = cell_data(self.folder / "first/fluid/fluid_000000400.vti")
        begin = ("--set", "initial={from: first}", "--set", "gravity.slope=0.1")
        for out, ranks in (("one", 0), ("four", 4)):
            self.run_well("run", self.case, "--out", out, *free[2:], "--set", "output.fluid.region=slice_y", *begin,
                          "--set", "fluid.mean_velocity=null", "--until", "0.001", ranks=ranks)
        self.assert_same_end("one", "four")
        start = cell_data(self.folder / "one/fluid/fluid_000000000.vti")
        numpy.testing.assert_array_equal(start["pressure"][:, 0], last["pressure"][:, 10])
        # The driving force of the new case acts from the start: half a step of 1 m/s^2, and single precision.
        numpy.testing.assert_allclose(start["velocity"][:, 0], last["velocity"][:, 10], atol=2.5e-5 + 1e-6)

        def refused(words, *settings):
            self.assert_refused("run", self.case, "--out", "never", *begin, *settings, words=["initial.from"] + words)
        refused(["0.013 m", "along z", "0.014 m", "domain.size"], "--set", "domain.size=[0.020, 0.0105, 0.014]")
        refused(["float32", "float64"], "--set", "fluid.precision=double")
        refused(["nowhere", "give a checkpoint"], "--set", "initial.from=nowhere")
        refused(["given twice"], "--set", "initial.fluid={uniform: [0.1, 0, 0]}")

    def test_a_held_flow_goes_on_with_the_force_that_held_it(self):
        self.run_well("run", self.case, "--out", "first", "--until", "0.01")
        self.run_well("run", self.case, "--out", "next", "--set", "initial={from: first}", "--until", "1e-4")
        before, after = self.series("first"), self.series("next")
        self.assertEqual(after["time"][0], 0.0)
        self.assertGreater(abs(before["body_force_x"][-1]), 1.0)   # N/m^3; a flow that begins has none
        for name in ("body_force_x", "mean_velocity_x"):
            self.assertEqual(after[name][0], before[name][-1], name)

    def test_grains_have_no_place_in_it(self):
        self.assert_refused("run", self.case, "--set", "grains=[{count: 1, diameter: 5e-3, density: 2550}]",
                            words=["grains", "system: fluid has no grains", "system: resolved"])
        self.assert_refused("run", self.case, "--set", "analysis.transport_rate={}",
                            words=["analysis.transport_rate", "system: fluid has no grains"])

    def test_the_check_tells_what_it_costs(self):
        report = self.run_well("check", self.case).stdout
        self.assertIn("system: fluid", report)
        self.assertIn("cell updates", report)
        self.assertNotIn("grain-steps", report)


class Solids(ProgramTest):
    # A sphere across the periodic ends and a sill of STL, in millimetres, on the floor.
    CASE = """
system: fluid
name: sphere and sill
domain: {size: [0.024, 0.016, 0.012], spacing: 0.5e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, time_step: 1.0e-3, collision: trt, precision: double}
gravity: {vector: [0.02, 0.0, -9.8]}
solids:
  - {sphere: {centre: [0.0236, 0.008, 0.0065], radius: 2.2e-3}}
  - {stl: sill.stl, scale: 1.0e-3, translate: [0.0102, 0.0, 0.0]}
run: {until: 0.4}
output:
  series: {every: 0.05}
  fluid: {every: 0.4, fields: [velocity, grain_id, shear_rate]}
  checkpoint: {every: 0.2, keep: 3}
"""

    def setUp(self):
        super().setUp()
        write_box(self.folder / "sill.stl", (0, -1, -1), (2.3, 17, 2.6))

    def test_the_same_bits_on_any_ranks_and_after_a_restart(self):
        self.run_well("run", self.case, "--out", "one")
        for ranks, layout in ((2, "2,1,1"), (4, "2,1,2")):
            out = "on_" + layout.replace(",", "x")
            self.run_well("run", self.case, "--out", out, "--layout", layout, ranks=ranks)
            self.assert_same_end(out, "one", "series.csv")
        self.run_well("run", self.case, "--out", "again", "--restart", self.folder / "one/checkpoints/step_200.h5",
                      ranks=2)
        self.assert_same_end("again", "one")
        rows = [(self.folder / out / "series.csv").read_text().splitlines() for out in ("one", "again")]
        self.assertEqual(rows[0][5:], rows[1][1:])   # the force of the step before is part of the state

        header, last = rows[0][0].split(","), [float(v) for v in rows[0][-1].split(",")]
        force = dict(zip(header, last))
        # With all the push of gravity the flow is still speeding up; on the solids acts a part of it only.
        push = 1000 * 0.02 * force["fluid_cells [1]"] * 0.5e-3 ** 3
        self.assertGreater(force["solid_0_force_x [N]"], 0.01 * push)
        self.assertGreater(force["solid_1_force_x [N]"], 0.01 * push)
        self.assertLess(force["solid_0_force_x [N]"] + force["solid_1_force_x [N]"], push)

        picture = cell_data(self.folder / "one/fluid/fluid_000000400.vti")
        z, y, x = numpy.meshgrid(*((numpy.arange(n) + 0.5) * 0.5 for n in (24, 32, 48)), indexing="ij")   # mm
        across = (x - 23.6 + 12) % 24 - 12
        sphere = across ** 2 + (y - 8) ** 2 + (z - 6.5) ** 2 < 2.2 ** 2
        sill = (x > 10.2) & (x < 12.5) & (z < 2.6)
        numpy.testing.assert_array_equal(picture["grain_id"], numpy.where(sphere, -2, numpy.where(sill, -3, -1)))
        self.assertTrue((picture["velocity"][sphere | sill] == 0).all())
        self.assertTrue((picture["shear_rate"][~(sphere | sill)] > 0).all())

    def test_the_check_says_where_the_solids_are(self):
        report = self.run_well("check", self.case).stdout
        self.assertIn("solid 0    sphere from [0.0214, 0.0058, 0.0043]", report)
        self.assertIn(
            "solid 1    12 triangles from [0.0102, -0.001, -0.001] to [0.0125, 0.017, 0.0026] m: 4.6 x 36 x 7.2", report
        )

    def test_a_bad_geometry_is_refused(self):
        write_box(self.folder / "open.stl", (0, -1, -1), (2.3, 17, 2.6), leave_out=1)
        (self.folder / "text.stl").write_text("no geometry at all\n")
        good = (self.folder / "sill.stl").read_text()
        (self.folder / "line.stl").write_text(good.replace("vertex 0 -1 -1", "vertex 1,5 -1 -1", 1))
        for file, words in (
            ("open.stl", ["solids.1.stl", "open.stl", "3 edges belong to one triangle only"]),
            ("line.stl", ["solids.1.stl", 'line.stl:4: "1,5" stands where an STL file has a finite coordinate']),
            ("text.stl", ["solids.1.stl", "text.stl:1: this is not an STL file"]),
            ("none.stl", ["solids.1.stl", "no such file"]),
        ):
            for command in ("run", "check"):
                self.assert_refused(command, self.case, "--set", f"solids.1.stl={file}", words=words)
        line = self.CASE.splitlines().index("  - {stl: sill.stl, scale: 1.0e-3, translate: [0.0102, 0.0, 0.0]}") + 1
        self.case.write_text(self.CASE.replace("sill.stl", "line.stl"))
        self.assert_refused(
            "check", self.case, words=[f'case.yaml:{line}: solids.1.stl = "line.stl": ', "line.stl:4: "]
        )
        self.case.write_text(self.CASE)
        self.assert_refused("run", self.case, "--set", "solids.1.translate=[0, 0, 1]", ranks=2,
                            words=["solids.1 covers no cell"])
        self.assert_refused("check", self.case, "--set", "solids.0.sphere.radius=1e-4",
                            words=["solids.0.sphere.radius = 1e-4", "at least 0.000435 m"])
        self.assert_refused("check", self.case, "--set", "solids.0={stl: sill.stl, sphere: {centre: [0, 0, 0], "
                            "radius: 1}}", words=["solids.0", "two shapes"])
        self.assert_refused("check", self.case, "--set", "solids.0={scale: 2}", words=["solids.0", "no shape"])
        self.assert_refused("check", self.case, "--set", "solids.0.motion={velocity: [0.1, 0, 0]}",
                            words=["solids.0.motion", "0.2 cells per step", "fluid.time_step"])
        self.assert_refused(
            "check", self.case, "--set", "solids.1.friction=0.3", words=["solids.1.friction", "no grains"]
        )

    def test_dialects_of_stl_are_the_same_surface(self):
        plain = (self.folder / "sill.stl").read_text()
        report = self.run_well("check", self.case).stdout
        where = [line for line in report.splitlines() if line.startswith("solid 1")]
        for text in ("\ufeff" + plain, plain.replace("endloop", "end loop"), plain.replace(" 2.6", " 0.26D+01"),
                     plain.replace("\n", "\r\n"), plain.upper()):
            (self.folder / "sill.stl").write_text(text, encoding="utf-8", newline="")
            self.assertEqual(
                [line for line in self.run_well("check", self.case).stdout.splitlines() if line.startswith("solid 1")],
                where,
            )

    def test_a_surface_in_millimetres_is_noticed(self):
        self.assert_refused("check", self.case, "--set", "solids.1.scale=1", words=[
            "solids.1.stl", "the solid is 18 m long along y, 1125 times the periodic box of 0.016 m; if the file is in "
            "millimetres, give scale: 0.001"])
        self.assert_refused("check", self.case, "--set", "solids.1.translate=[1e12, 0, 0]",
                            words=["the solid extends from 1e+12 to 1e+12 m along x, and the box from 0 to 0.024 m"])
        warning = (
            "warning    The surface solids.1 is 0.162 m long along y, 10.1 times the box: if its file is in millimetres,"
            " consider solids.1.scale: 9e-06."
        )
        self.assertIn(warning, self.run_well("check", self.case, "--set", "solids.1.scale=0.009").stdout)
        self.assert_refused("check", self.case, "--set", "solids.1.scale=0.02",
                            words=["solids.1.stl", "the solids fill the box", "give scale: 2e-05"])
        self.assertNotIn("millimetres", self.run_well("check", self.case).stdout)


class Poiseuille(ProgramTest):
    # Between two plates, H = 16 cells, until 30 e-folding times nu pi^2/H^2 of the start are over.
    CASE = """
system: fluid
name: between plates
domain: {size: [0.004, 0.004, 0.016], spacing: 1.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}}
fluid:
  density: 1000
  kinematic_viscosity: 1.0e-4
  time_step: 1.6e-3
  collision: trt
  subgrid_model: none   # the default sees the lattice's normal stresses, 4e-7 of the velocity
  precision: double
gravity: {vector: [0.01, 0.0, 0.0]}
run: {until: 8.0}
output: {fluid: {every: 8.0, region: slice_y}}
"""

    def test_has_the_exact_parabola(self):
        self.run_well("run", self.case, ranks=2)
        arrays = cell_data(self.folder / "run/fluid/fluid_000005000.vti")
        self.assertEqual(sorted(arrays), ["grain_id", "pressure", "velocity"])
        z = (numpy.arange(16) + 0.5) * 1e-3
        exact = 0.01 / (2 * 1e-4) * z * (0.016 - z)
        # TRT with 3/16 has no error at half-link walls; what is left is the single precision of the picture.
        for x in range(4):
            numpy.testing.assert_allclose(arrays["velocity"][:, 0, x, 0], exact, rtol=0, atol=2e-7 * exact.max())
        self.assertLess(abs(arrays["velocity"][..., 1:]).max(), 1e-9 * exact.max())


class SlowFlow(ProgramTest):
    """What check expects of laminar flow is what the run gives, to the 1 or 2 % of twelve cells."""
    CASE = """
system: fluid
name: slow flow in a duct
domain: {size: [0.002, 0.006, 0.006], spacing: 0.5e-3, boundaries: {x: periodic, y: no_slip, bottom: no_slip, top: no_slip}}
fluid: {density: 1000, kinematic_viscosity: 1.0e-4, subgrid_model: none, time_step: 2.0e-4, collision: trt, precision: double}
gravity: {vector: [0.5, 0, -9.8]}
run: {until: 0.3}
output: {series: {every: 0.3}}
"""

    def test_is_as_fast_as_check_says(self):
        for walls in ("{x: periodic, y: no_slip, bottom: no_slip, top: no_slip}",
                      "{x: periodic, y: no_slip, bottom: no_slip, top: free_slip}",
                      "{x: periodic, y: periodic, bottom: no_slip, top: no_slip}",
                      "{x: periodic, y: no_slip, bottom: free_slip, top: free_slip}"):
            with self.subTest(walls):
                setting = ("--set", f"domain.boundaries={walls}")
                report = json.loads(self.run_well("check", "--json", self.case, *setting).stdout)
                expected = report["figures"]["largest_velocity"]
                self.assertIn("(laminar)", "\n".join(report["report"]))
                self.run_well("run", self.case, "--out", "run", "--overwrite", *setting)
                self.assertAlmostEqual(self.series()["largest_fluid_speed"][-1] / expected, 1.0, delta=0.03)


if __name__ == "__main__":
    program.main()
