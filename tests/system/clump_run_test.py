#!/usr/bin/env python3
"""Clumps from the case file to the bed file and back, in pictures, and in what is measured.

Called by ctest: clump_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import h5py
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import program
import thalweg
from program import ProgramTest

# Two unit spheres (in mm) whose centres are a radius apart: the lens they share is 5 pi/12, so together 27 pi/12 mm^3.
TWIN_VOLUME = 27.0 * numpy.pi / 12.0 * 8.0e-9   # m^3, of spheres of 4 mm


class ClumpRun(ProgramTest):
    CASE = """
system: grains
name: pour
domain:
  size: [0.02, 0.02, 0.06]
  spacing: 1.0e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}
gravity: {magnitude: 9.8, slope: 0.05}
grains:
  - shape: {clump: [{position: [0, 0, 0], diameter: 4.0e-3}, {position: [0.002, 0, 0], diameter: 4.0e-3}]}
    density: 2550
    count: 24
    placement: {pattern: random, seed: 3}
  - {count: 10, diameter: 4.0e-3, density: 2000, placement: {pattern: random, seed: 5}}
contact: {restitution: 0.4, tangential_damping: 0.5}
run: {until: 0.1}
output: {grains: {every: 0.1}}
analysis: {transport_rate: {}}
"""
    FILE = "grains=[{placement: {file: run/bed.h5}}]"

    def test_a_bed_of_clumps_is_written_measured_and_taken_up_again(self):
        self.run_well("run", self.case, "--set", "output.series.every=1.0e-5")   # a row every step
        bed = self.bed()
        self.assertEqual(len(bed["id"]), 58)
        self.assertEqual(list(bed["clump"][:6]), [0, 0, 2, 2, 4, 4])
        self.assertTrue(all(bed["clump"][48:] == -1))
        self.assertEqual(self.summary("run")["grains"], 34)
        # Members stay where they are in their clump, through the periodic faces as well.
        apart = bed["position"][1:48:2] - bed["position"][0:48:2]
        apart[:, :2] -= 0.02 * numpy.round(apart[:, :2] / 0.02)
        self.assertLess(abs(numpy.linalg.norm(apart, axis=1) - 0.002).max(), 1e-15)
        # No two alike: the orientations are drawn one by one.
        self.assertEqual(len({tuple(numpy.round(d, 6)) for d in apart}), 24)

        # The density is that of the clump; with its volume once, and its centre between its members, the sums are those
        # of the series: momentum in kg m/s, flux in m^2/s per width over 0.02 m x 0.02 m.
        self.assertLess(abs(bed["density"][:48] / 2550.0 - 1.0).max(), 1e-12)
        sphere = numpy.pi / 6.0 * 0.004 ** 3
        centre_velocity = 0.5 * (bed["velocity"][1:48:2] + bed["velocity"][0:48:2])
        momentum = 2550.0 * TWIN_VOLUME * centre_velocity.sum(axis=0) + 2000.0 * sphere * bed["velocity"][48:].sum(
            axis=0
        )
        flux = (TWIN_VOLUME * centre_velocity[:, 0].sum() + sphere * bed["velocity"][48:, 0].sum()) / 4.0e-4
        last = {name: column[-1] for name, column in self.series().items()}
        for axis, name in enumerate("xyz"):
            self.assertAlmostEqual(last[f"grain_momentum_{name}"], momentum[axis], delta=1e-9 * abs(momentum[2]))
        self.assertAlmostEqual(last["q_s"], flux, delta=1e-9 * abs(flux))

        # Pictures show the members and whose they are.
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(sorted((self.folder / "run/grains").glob("*.vtp"))[-1]))
        reader.Update()
        shown = vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("clump"))
        self.assertTrue((shown == bed["clump"]).all())

        # Taken up again and not moved, the bed is the same, member by member, to the rounding of the clump's frame.
        self.run_well("run", self.case, "--out", "again", "--set", self.FILE, "--set", "run.until=1.0e-9",
                      "--set", "run.time_step=1.0e-9")
        again = self.bed("again")
        for name in ("id", "clump", "radius"):
            self.assertTrue((bed[name] == again[name]).all(), name)
        step = 1.0e-9 * abs(bed["velocity"]).max() * 100.0   # it did move for some steps of a nanosecond
        shift = again["position"] - bed["position"]
        shift[:, :2] -= 0.02 * numpy.round(shift[:, :2] / 0.02)
        self.assertLess(abs(shift).max(), step)
        self.assertLess(abs(again["density"] / bed["density"] - 1.0).max(), 1e-10)
        self.assertLess(abs(again["velocity"] - bed["velocity"]).max(), 1e-4)

        # A part of it, as whole clumps.
        self.run_well("check", self.case, "--set",
                      "grains=[{placement: {file: run/bed.h5, region: {lower: [0, 0, 0], upper: [0.02, 0.02, 0.01]}}}]")

    def test_a_restart_on_two_ranks_has_the_same_bits(self):
        short = ("--set", "run.until=0.02", "--set", "output.checkpoint.every=0.01")
        self.run_well("run", self.case, *short)
        self.run_well("run", self.case, *short, "--out", "two", ranks=2)
        first, second = self.last_checkpoint("run"), self.last_checkpoint("two")
        self.assertEqual(first.read_bytes(), second.read_bytes())

    def test_clumps_of_another_run_go_on(self):
        """From a shape and from a bed file."""
        for name, given in (("shape", ()), ("file", ("--set", self.FILE.replace("run/", "shape_more/")))):
            first, more, begun = (f"{name}_{what}" for what in ("first", "more", "begun"))
            self.run_well("run", self.case, *given, "--until", "0.05", "--out", first)
            self.run_well("run", self.case, *given, "--restart", first, "--until", "0.06", "--out", more)
            self.run_well(
                "run", self.case, *given, "--set", f"initial={{from: {first}, fields: [grains]}}", "--until", "0.01",
                "--out", begun, ranks=2,
            )
            for column in ("position", "velocity", "angular_velocity"):
                numpy.testing.assert_array_equal(self.bed(begun)[column], self.bed(more)[column], f"{name}: {column}")

    def test_an_orientation_is_a_turn_about_an_axis(self):
        self.run_well("run", self.case, "--set", "run.until=1.0e-9", "--set", "run.time_step=1.0e-9", "--set",
                      "gravity={magnitude: 0.0}", "--set", "grains.0.orientation={axis: [0, 0, 2], angle: 0.5}")
        bed = self.bed()
        apart = bed["position"][1:48:2] - bed["position"][0:48:2]
        apart[:, :2] -= 0.02 * numpy.round(apart[:, :2] / 0.02)
        expected = 0.002 * numpy.array([numpy.cos(0.5), numpy.sin(0.5), 0.0])
        self.assertLess(abs(apart - expected).max(), 1e-15)

    def test_disk_clumps_stay_in_their_plane(self):
        self.run_well("run", self.case, "--set", "disks={thickness: 4.0e-3}", "--set", "analysis={}",
                      "--set", "grains.0.count=8", "--set", "run.until=0.08")
        bed = self.bed()
        self.assertTrue((bed["position"][:, 1] == 0.01).all())
        self.assertTrue((bed["velocity"][:, 1] == 0.0).all())
        self.assertTrue((bed["angular_velocity"][:, (0, 2)] == 0.0).all())
        self.assertGreater(abs(bed["angular_velocity"][:16, 1]).max(), 0.1)

    def test_what_cannot_be_is_refused(self):
        for setting, words in (
                ("grains.1.orientation={axis: [0, 0, 1], angle: 1.0}", ("grains.1.orientation", "spheres")),
                ("grains.0.shape.clump=[]", ("grains.0.shape.clump",)),
                ("grains.0.shape.clump.1.position=[0.017, 0, 0]", ("domain.size", "touch itself")),
                ("grains.0.count=400", ("grains",))):
            with self.subTest(setting):
                self.assert_refused("check", self.case, "--set", setting, words=words)


class ClumpInWaterRun(ProgramTest):
    CASE = """
system: resolved
name: falling twins
domain:
  size: [0.02, 0.02, 0.03]
  spacing: 1.0e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, time_step: 1.0e-4}
gravity: {magnitude: 9.8}
grains:
  - shape: {clump: [{position: [0, 0, 0], diameter: 6.0e-3}, {position: [0.003, 0, 0], diameter: 6.0e-3}]}
    density: 2550
    placement: {positions: [[0.01, 0.01, 0.02]]}
    orientation: {axis: [0, 1, 0], angle: 0.4}
contact: {restitution: 0.9}
run: {until: 0.01}
"""

    def test_it_sinks_the_same_on_one_rank_and_on_two(self):
        self.run_well("run", self.case)
        self.run_well("run", self.case, "--out", "two", ranks=2)
        self.assert_same_end("run", "two")
        bed = self.bed()
        velocity, spin = bed["velocity"].mean(axis=0), bed["angular_velocity"][0]
        # Slower than without drag, (1 - rho_f/rho_s) g t with added mass left out, and on its way; it drifts and turns
        # about y alone, because it lies askew in the plane x-z.
        self.assertLess(velocity[2], -0.01)
        self.assertGreater(velocity[2], -(1.0 - 1.0 / 2.55) * 9.8 * 0.01)
        self.assertLess(abs(velocity[1]), 1e-6)
        self.assertNotEqual(velocity[0], 0.0)
        self.assertNotEqual(spin[1], 0.0)

    ANALYSES = ("--set", "grains.0.placement={pattern: random, seed: 2}", "--set", "grains.0.orientation=null", "--set",
                "grains.0.count=6", "--set", "output.checkpoint.every=0.01", "--set",
                "analysis={grain_profiles: {every: 5.0e-4}, stress_balance: {every: 5.0e-4}, tracks: {every: 5.0e-4}, "
                "entrainment: {every: 5.0e-4, displacement: 0.01, rest_time: 0}}")

    def test_analyses_take_clumps_on_any_ranks_and_after_a_restart(self):
        self.run_well("run", self.case, *self.ANALYSES, "--until", "0.02")
        self.run_well("run", self.case, *self.ANALYSES, "--until", "0.02", "--out", "four", ranks=4)
        self.run_well("run", self.case, *self.ANALYSES, "--until", "0.01", "--out", "parts", ranks=2)
        self.run_well("run", self.case, *self.ANALYSES, "--restart", "parts", "--until", "0.02", "--out", "parts")
        for other in ("four", "parts"):
            self.assert_same_end("run", other)
        with h5py.File(self.folder / "run/profiles.h5") as profiles:
            group = profiles["grain_profiles"]
            self.assertEqual(group["long_axis_alignment"].attrs["units"], b"1")
            self.assertEqual(group["long_axis_alignment"].dims[0][0].name, "/grain_profiles/z")
            some = group["clump_fraction"][:] > 0.0
            for name in ("long_axis_alignment", "short_axis_alignment"):   # of unit vectors the trace is 1
                self.assertLess(abs(group[name][:][some, :3].sum(axis=1) - 1.0).max(), 1e-12)
            self.assertLess(abs(profiles["stress_balance/solid_fraction"][:]).max(), 0.75)
        # In its own frame a clump stays as it is.
        tracks = thalweg.Run(self.folder / "run").tracks
        apart = tracks["position"][:, 1] - tracks["position"][:, 0]
        apart[:, :2] -= 0.02 * numpy.round(apart[:, :2] / 0.02)
        q = tracks["orientation"][:, 0]
        self.assertTrue((q == tracks["orientation"][:, 1]).all())
        back = -q[:, 1:]
        own = apart + 2.0 * numpy.cross(back, numpy.cross(back, apart) + q[:, :1] * apart)
        self.assertLess(abs(own - own[0]).max(), 1e-12)
        self.assertGreater(abs(apart - apart[0]).max(), 1e-6)   # it has turned
        self.assertGreater(self.summary("run")["entrainment"]["watched_grains"], 0)
        self.assert_refused("check", self.case, *self.ANALYSES, "--set", "analysis.entrainment.grains=[3]",
                            words=("analysis.entrainment.grains", "clump 2"))


if __name__ == "__main__":
    program.main()
