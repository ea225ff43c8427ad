#!/usr/bin/env python3
"""Clumps made of a surface: `thalweg clump`, `shape: {stl: ...}` in a case, what is kept of it, and restarts.

Called by ctest: shape_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import re
import shutil
import sys
from pathlib import Path

import h5py
import numpy

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import program
from program import ProgramTest

DIAMETER, DENSITY = 4.0e-3, 2550.0   # m, kg/m^3; the surfaces of cases/shapes have the volume of a sphere of diameter 1


class ShapeRun(ProgramTest):
    CASE = """
system: grains
name: pour
domain:
  size: [0.024, 0.024, 0.06]
  spacing: 1.0e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}
gravity: {magnitude: 9.8}
grains:
  - shape: {stl: triaxial.stl, spheres: 6, scale: 4.0e-3}
    density: 2550
    count: 8
    placement: {pattern: random, seed: 3}
contact: {restitution: 0.4}
run: {until: 0.02}
output: {checkpoint: {every: 0.01}}
"""

    def setUp(self):
        super().setUp()
        for name in ("triaxial", "prolate", "pebble"):
            shutil.copy(ROOT / f"cases/shapes/{name}.stl", self.folder)

    def test_a_case_has_the_mass_and_moments_of_the_surface_and_keeps_them(self):
        self.run_well("run", self.case)
        volume = numpy.pi / 6.0 * DIAMETER**3
        with h5py.File(self.last_checkpoint("run")) as saved:
            grains = saved["grains"]
            self.assertLess(abs(grains["clump_mass"][:] / (DENSITY * volume) - 1.0).max(), 1e-6)   # single precision
            # The surface inscribed in an ellipsoid of half axes 1.5 : 1 : 0.65, of 1280 triangles.
            squares = numpy.array([1.5, 1.0, 0.65]) ** 2 * (DIAMETER / 2.0) ** 2 / (1.5 * 0.65) ** (2.0 / 3.0)
            moments = DENSITY * volume / 5.0 * numpy.sort(squares.sum() - squares)
            self.assertLess(abs(grains["clump_moments"][:] / moments - 1.0).max(), 5e-3)
        # The case that is kept needs no surface any more, and makes the same run; the surface is in the provenance.
        kept = self.folder / "run/case.yaml"
        self.assertNotIn("stl", kept.read_text())
        source = self.summary("run")["provenance"]["inputs"][0]
        self.assertEqual((source["key"], source["path"]), ("grains.0.shape.stl", "../triaxial.stl"))
        (self.folder / "triaxial.stl").unlink()
        self.run_well("run", kept, "--out", "again")
        self.assert_same_end("run", "again")

    def test_restarts_and_two_ranks_have_the_same_bits(self):
        self.run_well("run", self.case)
        self.run_well("run", self.case, "--until", "0.01", "--out", "parts")
        self.run_well("run", self.case, "--restart", "parts", "--out", "parts", "--until", "0.02", ranks=2)
        self.assert_same_end("run", "parts")

    SIZES = ("--set", "grains.0.shape={stl: triaxial.stl, spheres: 6}", "--set",
             "grains.0.diameter={sieve: {sizes: [2.5e-3, 5.0e-3], finer: [0, 1]}}")

    def test_sizes_are_those_of_spheres_of_the_same_volume(self):
        """Masses of clumps are those of spheres with the same sieve curve and seed; moments grow with d^5."""
        self.run_well("run", self.case, *self.SIZES)
        self.run_well("run", self.case, "--set", "grains.0.shape=null", *self.SIZES[2:], "--out", "spheres")
        with h5py.File(self.last_checkpoint("run")) as saved, h5py.File(self.last_checkpoint("spheres")) as spheres:
            mass, moments = saved["grains/clump_mass"][:, 0], saved["grains/clump_moments"][:]
            self.assertLess(abs(mass / spheres["grains/mass"][:] - 1.0).max(), 1e-12)
            self.assertGreater(mass.max() / mass.min(), 2.0)
            self.assertLess(abs(moments / moments[0] / (mass / mass[0])[:, None] ** (5.0 / 3.0) - 1.0).max(), 1e-12)
        self.assertIn("by volume as large as spheres of 0.00", self.thalweg("check", self.case, *self.SIZES).stdout)
        # The case that is kept, two ranks and a restart make the same run.
        self.run_well("run", self.folder / "run/case.yaml", "--out", "again")
        self.run_well("run", self.case, *self.SIZES, "--until", "0.01", "--out", "parts", ranks=2)
        self.run_well("run", self.case, *self.SIZES, "--restart", "parts", "--out", "parts", "--until", "0.02", ranks=4)
        for other in ("again", "parts"):
            self.assert_same_end("run", other)

    def test_check_says_how_wide_a_sieve_lets_clumps_of_a_size_through(self):
        """Of ellipsoids with half axes a >= b >= c: b over (a b c)^(1/3)."""
        shutil.copy(ROOT / "cases/shapes/oblate.stl", self.folder)
        for name, axes in (("prolate", (2.0, 1.0, 1.0)), ("oblate", (2.0, 2.0, 1.0)), ("triaxial", (1.5, 1.0, 0.65))):
            said = self.run_well("check", self.case, "--set", f"grains.0.shape={{stl: {name}.stl, spheres: 6}}", "--set",
                                 "grains.0.diameter=3.0e-3").stdout
            (found,) = re.findall(r"intermediate axis ([0-9.]+) of the size", said)
            # Printed with three digits, and the surfaces have flat facets.
            self.assertAlmostEqual(float(found), axes[1] / numpy.prod(axes) ** (1.0 / 3.0), delta=6e-3, msg=name)

    def test_size_classes_and_supplies_take_clumps_by_their_size(self):
        """Eight clumps of 3 and 4 mm and those that come in: a class has the share of its number times d^3, at the end."""
        mixed = ("--set", "grains.0.shape={stl: triaxial.stl, spheres: 4}", "--set",
                 "grains.0.diameter={sizes: [3.0e-3, 4.0e-3], fractions: [0.5, 0.5]}", "--set", "run.until=0.03", "--set",
                 "supplies=[{population: 0, rate: 400, region: {lower: [0, 0, 0.045], upper: [0.024, 0.024, 0.055]}}]",
                 "--set", "analysis={fractional_transport: {from: 0.0299}}", "--set", "output.series={every: 0.01}")
        self.run_well("run", self.case, *mixed)
        with h5py.File(self.last_checkpoint("run")) as saved:
            mass = saved["grains/clump_mass"][:, 0]
        sphere = DENSITY * numpy.pi / 6.0 * numpy.array([3.0e-3, 4.0e-3]) ** 3
        fine, coarse = ((abs(mass / one - 1.0) < 1e-9).sum() for one in sphere)
        self.assertEqual(fine + coarse, len(mass))
        self.assertGreaterEqual(len(mass), 16)
        share = self.summary("run")["fractional_transport"]["class_0_bed_share"]
        self.assertAlmostEqual(share, 27.0 * fine / (27.0 * fine + 64.0 * coarse), delta=1e-9)
        self.run_well("run", self.case, *mixed, "--out", "two", ranks=2)
        self.assert_same_end("run", "two")

    def test_a_bed_keeps_mass_and_moments_of_the_surfaces(self):
        self.run_well("run", self.case, *self.SIZES)
        with h5py.File(self.folder / "run/bed.h5") as bed:
            self.assertEqual(bed["clumps/moments"].attrs["units"], b"m^5")
            volumes = bed["clumps/volume"][:]
        bed = "grains=[{placement: {file: run/bed.h5}}]"
        self.run_well("run", self.case, "--set", bed, "--out", "more")
        with h5py.File(self.last_checkpoint("run")) as saved, h5py.File(self.last_checkpoint("more")) as more:
            self.assertLess(abs(saved["grains/clump_mass"][:, 0] / DENSITY / volumes - 1.0).max(), 1e-12)
            for name in ("mass", "moments", "volume"):
                ratio = more[f"grains/clump_{name}"][:] / saved[f"grains/clump_{name}"][:]
                self.assertLess(abs(ratio - 1.0).max(), 1e-12, name)
        # On several ranks, and from a checkpoint without the bed, the same run.
        self.run_well("run", self.case, "--set", bed, "--out", "two", ranks=4)
        self.run_well("run", self.case, "--set", bed, "--until", "0.01", "--out", "parts")
        (self.folder / "run/bed.h5").unlink()
        self.run_well("run", self.case, "--set", bed, "--restart", "parts", "--out", "parts", "--until", "0.02", ranks=2)
        for other in ("two", "parts"):
            self.assert_same_end("more", other)

    def test_a_clump_is_described_and_written(self):
        done = self.thalweg("clump", "prolate.stl", "--spheres", "5", "--scale", str(DIAMETER))
        figures = dict(re.findall(r"^  (sphericity|Corey shape factor|axes) +([\d., e+-]+)", done.stdout, re.M))
        # 2:1: the area is 2 pi (1 + 2 asin(e)/e) with e^2 = 3/4, the volume 8 pi/3.
        e = numpy.sqrt(0.75)
        sphericity = 4.0 * numpy.pi * 2.0 ** (2.0 / 3.0) / (2.0 * numpy.pi * (1.0 + 2.0 / e * numpy.arcsin(e)))
        self.assertAlmostEqual(float(figures["sphericity"]), sphericity, delta=3e-3)
        self.assertAlmostEqual(float(figures["Corey shape factor"]), numpy.sqrt(0.5), delta=3e-3)
        axes = numpy.array([float(axis) for axis in figures["axes"].strip(" ,").split(", ")])
        self.assertLess(abs(axes / (DIAMETER * 2.0 ** (-1.0 / 3.0) * numpy.array([2.0, 1.0, 1.0])) - 1.0).max(), 5e-3)
        self.assertEqual((self.folder / "prolate_clump.yaml").read_text().count("diameter"), 5)
        self.thalweg("clump", "prolate.stl", "--spheres", "4", "--scale", str(DIAMETER))   # replaces its own
        self.assertEqual((self.folder / "prolate_clump.yaml").read_text().count("diameter"), 4)
        self.assert_refused("clump", "prolate.stl", "--spheres", "4", "--scale", str(DIAMETER), "--out", "case",
                            words=["case.yaml exists and is not the shape"])

    def test_what_cannot_be_is_refused(self):
        (self.folder / "cut.stl").write_bytes((self.folder / "pebble.stl").read_bytes()[:-100])
        for shape, words in (
                ("{stl: none.stl, spheres: 5}", ("grains.0.shape.stl", "no such file")),
                ("{stl: cut.stl, spheres: 5}", ("grains.0.shape.stl", "cut off")),
                ("{stl: pebble.stl, spheres: 5, scale: 4.0}", ("grains.0.shape.stl", "scale")),
                ("{stl: pebble.stl}", ("grains.0.shape.spheres",)),
                ("{stl: pebble.stl, spheres: 3, clump: [{position: [0, 0, 0], diameter: 0.004}]}", ("clump",)),
                ("{clump: [{position: [0, 0, 0], diameter: 0.004}], spheres: 3}", ("spheres", "STL"))):
            self.assert_refused("check", self.case, "--set", f"grains.0.shape={shape}", words=words)
        self.assert_refused("check", self.case, "--set", "grains.0.diameter=0.004", words=("grains.0.shape.scale", "one"))


if __name__ == "__main__":
    program.main(side_by_side=True)
