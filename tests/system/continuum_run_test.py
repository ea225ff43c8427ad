#!/usr/bin/env python3
"""A column of the continuum: steady by the stated test, its files, the same bits on any ranks and after a restart,
refusals.

Called by ctest: continuum_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import json
import re
import sys
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
import thalweg
from program import ProgramTest


class ContinuumRun(ProgramTest):
    CASE = """
system: continuum
name: column
fluid: {density: 1000, kinematic_viscosity: 1e-6}
grains: {diameter: 5e-3, density: 2550}
gravity: {magnitude: 9.8, slope: 0.016}
column: {shields_number: 0.085, bed: 3, cells_per_diameter: 5}
creep: {}
run: {until: 100, time_step: 5, until_steady: {}}
output: {series: {every: 5}, checkpoint: {every: 5, keep: 30}}
"""

    def unknowns(self, run):
        with h5py.File(self.last_checkpoint(run)) as file:
            return file["column/unknowns"][:]

    def test_the_same_bits_on_any_ranks_and_after_a_restart(self):
        self.run_well("run", self.case, "--out", "one")
        for ranks in (2, 4):
            self.run_well("run", self.case, "--out", f"on_{ranks}", ranks=ranks)
        self.run_well("run", self.case, "--out", "half", "--until", "10")
        self.run_well("run", self.case, "--out", "half", "--restart", "half", ranks=2)
        for other in ("on_2", "on_4", "half"):
            self.assertTrue(numpy.array_equal(self.unknowns(other), self.unknowns("one")), other)
            self.assertEqual((self.folder / other / "series.csv").read_text(),
                             (self.folder / "one" / "series.csv").read_text())

    def test_a_restart_keeps_the_height_of_its_cells(self):
        self.run_well("run", self.case, "--out", "run", "--until", "10")
        # The water is shallower by 0.62 %, in as many cells.
        steeper = ("--restart", "run", "--set", "gravity.slope=0.0161", "--until", "15")
        self.assert_refused(
            "run", self.case, *steeper, words=["step_2.h5", "its cells are 0.001004", "0.000998", "gravity"]
        )
        depth = re.search("column.depth of ([0-9.e-]+) m", self.thalweg("run", self.case, *steeper).stderr).group(1)
        self.run_well(
            "run", self.case, *steeper, "--set", "column.shields_number=null", "--set", f"column.depth={depth}"
        )

    def test_it_ends_when_it_is_steady_and_shows_its_profiles(self):
        self.run_well("run", self.case, "--out", "run")
        self.assertIn("finished, steady,", (self.folder / "run" / "run.log").read_text())
        figures = json.loads((self.folder / "run" / "summary.json").read_text())["figures"]
        self.assertLess(figures["unsteadiness"], 1e-4)
        run = thalweg.Run(self.folder / "run")
        column = run.profiles["continuum"]
        self.assertEqual(column["grain_velocity"].shape, (len(column["z"]), 3))
        q_s = numpy.sum(column["solid_fraction"] * column["grain_velocity"][:, 0] * column["thickness"])
        self.assertAlmostEqual(q_s / figures["q_s"], 1.0, delta=1e-12)
        self.assertEqual(run.series["q_star"][-1], figures["q_star"])
        self.assertAlmostEqual(figures["q_star"] * (1.55 * 9.8 * 5e-3 ** 3) ** 0.5 / q_s, 1.0, delta=1e-12)
        # The weight of the water above the surface along the bed, and the Shields number of that.
        stress = 9800 * numpy.sin(numpy.arctan(0.016)) * (column["thickness"].sum() - figures["surface_height"])
        self.assertAlmostEqual(figures["bed_stress"] / stress, 1.0, delta=1e-12)
        self.assertAlmostEqual(figures["shields_number"] * 1550 * 9.8 * 5e-3 / stress, 1.0, delta=1e-12)
        # Of fig. 11 at this Shields number, to 2 %.
        self.assertAlmostEqual(figures["creep_decade_length"] / 5e-3, 2.22, delta=0.02 * 2.22)

    def column_with(self, *settings):
        self.run_well("run", self.case, "--overwrite", "--until", "5", *[w for s in settings for w in ("--set", s)])
        return thalweg.Run(self.folder / "run").profiles["continuum"]

    def test_the_drag_is_that_of_the_law_chosen(self):
        # Eqs. 25 to 28 of Zhang et al. (2022) by hand, of the state after 5 s. Solid fractions are kept positive by
        # 1e-5 in a root with them, which changes those above a hundredth by less than 1e-6. Streamwise speeds are in a
        # root with 0.036 sqrt(g' d) (docs/theory.md, section 4c).
        slowest = 0.036 * (1.55 * 9.8 * 5e-3) ** 0.5
        def beetstra(phi, reynolds, crowd):
            n = 1 - phi
            return 10 * phi / n ** 2 + n ** 2 * (1 + 1.5 * phi ** 0.5) + 0.413 * reynolds / (24 * n ** 2) * (
                1 / n + 3 * phi * n + 8.4 * reynolds ** -0.343) / (1 + crowd * reynolds ** (-0.5 * (1 + 4 * phi)))

        def schiller(phi, reynolds):
            return numpy.where(reynolds <= 1000, 1 + 0.15 * reynolds ** 0.687, 0.44 / 24 * reynolds) / (1 - phi) ** 3

        for settings, law in (
            ((), lambda phi, r: beetstra(phi, r, 10 ** (3 * phi)) / (1 - phi)),
            (("drag=beetstra",), lambda phi, r: beetstra(phi, r, 10 ** (3 * phi))),
            (("drag=schiller",), schiller),
            (("drag_crowding=printed",), lambda phi, r: beetstra(phi, r, 1000 * phi) / (1 - phi)),
            (("drag_speed=streamwise", "drag=beetstra"), lambda phi, r: beetstra(phi, r, 10 ** (3 * phi))),
        ):
            with self.subTest(settings=settings):
                column = self.column_with(*(f"closures.{setting}" for setting in settings))
                grains = column["solid_fraction"] > 1e-2
                phi, drift = column["solid_fraction"][grains], column["drift_velocity"][grains]
                along = (column["fluid_velocity"] - column["grain_velocity"])[grains, 0]
                self.assertGreater(abs(drift).max(), 0.01 * abs(along).max())   # or the two speeds are one
                speed = numpy.hypot(along, slowest if "drag_speed=streamwise" in settings else drift)
                reynolds = (1 - phi) * speed * 5e-3 / 1e-6
                numpy.testing.assert_allclose(column["drag_reynolds_number"][grains], reynolds, rtol=1e-6)
                numpy.testing.assert_allclose(column["drag_function"][grains], law(phi, reynolds), rtol=1e-6)
                drag = 18 * phi * (1 - phi) * 1e-3 * law(phi, reynolds) * along / 5e-3 ** 2
                numpy.testing.assert_allclose(column["drag_density"][grains, 0], drag, rtol=1e-6)

    def test_pressure_stress_and_drift_are_those_of_the_closures_chosen(self):
        # Eqs. 20 to 24 with numbers of its own for every key, as docs/theory.md, section 4c, has them: pressures in the
        # middle of cells, stresses on the faces between them, of which the profile has the mean of two.
        mu_1, mu_2, densest, b, a, elastic, gap, creeping = 0.4, 0.8, 0.6, 7.0, 0.9, 3.0e5, 0.004, 0.01
        factor, shortest, schmidt = 2.5, 0.3, 0.5
        column = self.column_with(
            f"closures.rheology={{static_friction: {mu_1}, limit_friction: {mu_2}, densest_fraction: {densest}, "
            f"friction_scale: {b}, dilation: {a}, elastic_modulus: {elastic}, smallest_gap: {gap}, "
            f"creeping_rate: {creeping}}}",
            f"closures.turbulence={{mixing_length_factor: {factor}, smallest_mixing_length: {shortest}, "
            f"schmidt_number: {schmidt}, strain_norm: frobenius}}",
        )
        phi, d, eta, dz = column["solid_fraction"], 5e-3, 1e-3, column["thickness"][0]
        grains, fluid = column["grain_velocity"][:, 0], column["fluid_velocity"][:, 0]

        def between(values):
            return 0.5 * (values[1:] + values[:-1])

        def expect(name, expected, of):
            self.assertGreater(of.sum(), 10, name)
            numpy.testing.assert_allclose(column[name][of], expected[of], rtol=1e-5, err_msg=name)

        rate = numpy.diff(grains) / dz
        in_cells = numpy.concatenate([[0.0], abs(between(rate)), [0.0]])
        pressure = elastic * numpy.maximum(0.0, phi - densest) + (a * phi / numpy.maximum(densest - phi, gap)) ** 2 * (
            2 * eta * in_cells + 2550 * (d * in_cells) ** 2)
        inside = numpy.arange(len(phi)) % (len(phi) - 1) > 0
        dense = inside & (phi > 1e-2)
        expect("grain_pressure", pressure, dense)
        self.assertTrue((phi > densest).any() and (in_cells[phi < densest - gap] > 1.0).any())   # both parts of it

        face_phi, face_pressure = between(phi), between(column["grain_pressure"])
        viscous = eta * abs(rate) / face_pressure
        mixed = numpy.sqrt(2 * viscous + rate ** 2 * d ** 2 * 2550 / face_pressure)
        friction = mu_1 + (mu_2 - mu_1) / (1 + b / mixed) + 2.5 * face_phi * viscous * (1 / (a * mixed) + 1)
        stress = friction * face_pressure * rate / numpy.hypot(rate, creeping)
        deep = dense & (numpy.minimum(numpy.roll(phi, -1), phi) > 1e-2)   # and so is the cell above
        expect("grain_shear_stress", numpy.concatenate([[0.0], between(stress), [0.0]]), deep)

        length = d * numpy.maximum(factor * numpy.maximum(0.0, densest - face_phi) ** 3, shortest)
        eddy = (1 - face_phi) * 1000 * length ** 2 * abs(numpy.diff(fluid) / dz) / 2 ** 0.5
        expect("eddy_viscosity", numpy.concatenate([[0.0], between(eddy), [0.0]]), deep)
        drift = -eddy / (1000 * schmidt) * numpy.diff(phi) / dz / (face_phi + 1e-3)
        expect("drift_velocity", numpy.concatenate([[0.0], between(drift), [0.0]]), deep)

    def test_the_creep_is_a_solution_of_its_equation(self):
        # Eq. 29 as docs/theory.md has it, by central differences on the points of the profile, which the program uses,
        # too: to the rounding of a second difference.
        for settings, amplitude, rate, mu_1, mu_2, ends, surface in (
            ((), 0.43, 0.33 / 5, 0.37, 0.7, (2, 10), 0.01),
            (("creep={nonlocal_amplitude: 0.6, rate_coefficient: 0.2, upper: 4, lower: 20, surface_fluidity: 30}",
              "closures.rheology={static_friction: 0.4, limit_friction: 0.8}"), 0.6, 0.2, 0.4, 0.8, (4, 20), 30),
        ):
            with self.subTest(settings=settings):
                column = self.column_with(*settings)
                depth, g, mu = (column[f"creep_{name}"] for name in ("depth", "fluidity", "stress_ratio"))
                numpy.testing.assert_allclose((depth.min() / 5e-3, depth.max() / 5e-3), ends, rtol=1e-9)
                self.assertAlmostEqual(g[numpy.argmin(depth)] / surface, 1.0, 9)
                self.assertEqual(g[numpy.argmax(depth)], 0.0)
                h, down = depth[1] - depth[0], numpy.cos(numpy.arctan(0.016)) * 9.8
                pressure = 0.62 * 1550 * down * depth
                local = (mu_2 - mu_1) * (mu_1 - mu) / (mu_2 - mu) * g
                local += rate * (2550 / pressure) ** 0.5 * 5e-3 * mu * g ** 2
                curved = (amplitude * 5e-3) ** 2 * (g[2:] - 2 * g[1:-1] + g[:-2]) / h ** 2
                numpy.testing.assert_allclose(curved, local[1:-1], atol=1e-6 * abs(local).max())
                # dU/dz = g mu, by trapezoids from nothing below.
                rate_of_shear = g * mu
                steps = numpy.diff(column["creep_velocity"]) / -h
                numpy.testing.assert_allclose(steps, 0.5 * (rate_of_shear[1:] + rate_of_shear[:-1]), rtol=1e-6,
                                              atol=1e-9 * rate_of_shear.max())

    def test_refusals(self):
        for setting, words in (
                ("gravity.slope=0", ["gravity", "a slope above 0"]),
                ("grains.density=900", ["grains.density", "the grains float"]),
                ("column.depth=0.04", ["column.depth", "given twice"]),
                ("column.cells_per_diameter=1", ["cells_per_diameter"]),
                ("column.bed=6e8", ["column.bed", "more than 100000 cells", "thinner bed"]),
                ("closures.drag=stokes", ["closures.drag", "mobile"]),
                ("creep.lower=1", ["creep.lower", "deeper than upper"]),
                ("creep.upper=6.999", ["creep.upper", "at most 6"]),   # nothing is left to fit the decay to
                ("domain.spacing=1e-3", ["domain", "has no box"]),
                ("analysis.transport_rate.from=1", ["analysis", "remove the section"]),
                ("gravity={vector: [0.4, 0.1, -9.7]}", ["gravity", "along y"]),
                ("column.speed=1", ["speed"])):
            with self.subTest(setting=setting):
                self.assert_refused("run", self.case, "--set", setting, words=words)
        self.assert_refused("run", self.case, "--layout", "1,1,1", words=["--layout"])


if __name__ == "__main__":
    program.main()
