#!/usr/bin/env python3
"""Tracks of single grains in a whole run: the same files on any ranks, no row twice after a restart, and a run that
does not notice them.

Called by ctest: tracks_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import shutil
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
import thalweg
from program import ProgramTest


class TracksRun(ProgramTest):
    # Grains fly with the water through a short periodic box, fast enough to go round.
    CASE = """
system: resolved
name: round and round
domain:
  size: [0.0165, 0.010725, 0.0165]   # m
  spacing: 0.825e-3                  # m
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, smagorinsky_constant: 0.27, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.1}
grains:
  - {count: 8, diameter: 4.95e-3, density: 2550, placement: {pattern: uniform, seed: 1}, velocity: [0.8, 0.0, 0.0]}
contact: {normal_stiffness: 20000, tangential_stiffness: 5714, restitution: 0.5, friction: 0.5, wall_friction: 0.45}
coupling: {grain_steps_per_fluid_step: 20}
initial: {fluid: {uniform: [0.8, 0.0, 0.0]}}
run: {until: 0.04}
output:
  series: {every: 0.004}
  grains: {every: 0.01}
  checkpoint: {every: 0.02, keep: 3}
analysis:
  tracks: {grains: [6, 1], every: 3.0e-4}
"""

    def tracks(self, run):
        return thalweg.Run(self.folder / run).tracks

    def files_of(self, run):
        """Bytes of the parts of the tracks and of the series, by name."""
        return {
            path.name: path.read_bytes()
            for pattern in ("tracks/*", "series.csv")
            for path in (self.folder / run).glob(pattern)
        }

    def assert_same_tracks(self, a, b):
        for name, values in self.tracks(a).items():
            self.assertEqual(values.tobytes(), self.tracks(b)[name].tobytes(), name)

    def test_the_same_bits_on_any_ranks_and_what_pictures_show(self):
        self.run_well("run", self.case, "--out", "one")
        for ranks in (2, 4):
            self.run_well("run", self.case, "--out", f"on_{ranks}", ranks=ranks)
            self.assertEqual(self.files_of(f"on_{ranks}"), self.files_of("one"))
            self.assert_same_end(f"on_{ranks}", "one")
        tracks, run = self.tracks("one"), thalweg.Run(self.folder / "one")
        numpy.testing.assert_array_equal(tracks["id"], (1, 6))
        numpy.testing.assert_allclose(tracks["time"], 3e-4 * numpy.arange(134), atol=1e-12)   # up to 39.9 ms
        self.assertGreater(tracks["position"][-1, :, 0].min(), run.size[0])   # round the box
        steps = numpy.diff(tracks["position"], axis=0)
        self.assertLess(abs(steps).max(), 1.6 * 3e-4)   # no jump: nothing is faster than twice the flow
        compared = []   # ms; a measurement each 0.3 ms and a frame each 10 ms meet each 30 ms
        for frame in run.grains:
            row = numpy.flatnonzero(abs(tracks["time"] - frame.time) < 1e-9)
            if not len(row):
                continue
            compared.append(round(1e3 * frame.time))
            places = tracks["position"][row[0]] - frame.position[tracks["id"]]
            places[:, :2] -= numpy.round(places[:, :2] / run.size[:2]) * run.size[:2]
            numpy.testing.assert_allclose(places, 0.0, atol=1e-12)
            for name in ("velocity", "angular_velocity", "fluid_force", "contact_force"):
                numpy.testing.assert_array_equal(tracks[name][row[0]], frame.arrays[name][tracks["id"]], name)
        self.assertEqual(compared, [0, 30])

    def test_a_restart_has_no_row_twice(self):
        self.run_well("run", self.case, "--out", "straight")
        self.run_well("run", self.case, "--out", "parts", "--until", "0.035")   # beyond the checkpoint at 20 ms
        half_way = self.folder / "parts/checkpoints/step_200.h5"
        self.run_well("run", self.case, "--out", "parts", "--restart", half_way, ranks=2)
        self.assert_same_tracks("parts", "straight")
        self.assertEqual(self.summary("parts")["tracks"], self.summary("straight")["tracks"])
        self.run_well("run", self.case, "--out", "rest", "--restart", half_way)   # a folder of its own
        late = self.tracks("straight")["time"] > 0.02
        numpy.testing.assert_array_equal(self.tracks("rest")["position"], self.tracks("straight")["position"][late])
        others = self.thalweg("run", self.case, "--out", "parts", "--restart", half_way, "--set",
                              "analysis.tracks.grains=[1, 5]")
        self.assertEqual(others.returncode, 2, others.stderr)
        self.assertIn("its id is not that of this run", others.stderr)

    def test_a_restart_needs_no_part_after_its_checkpoint(self):
        """As a kill or a loss of power leaves them: gone, empty, unfinished."""
        self.run_well("run", self.case, "--out", "straight", "--set", "output.checkpoint.every=0.01")
        self.assertEqual(
            sorted(self.files_of("straight")),
            [f"part_{step:09d}.h5" for step in (0, 100, 200, 300, 400)] + ["series.csv"],
        )
        shutil.copytree(self.folder / "straight", self.folder / "run")
        parts = self.folder / "run/tracks"
        (parts / "part_000000300.h5").write_bytes(b"")
        (parts / "part_000000400.h5").rename(parts / "part_000000400.h5.partial")
        self.run_well("run", self.case, "--restart", self.folder / "run/checkpoints/step_200.h5", "--set",
                      "output.checkpoint.every=0.01", ranks=2)
        self.assertEqual(self.files_of("run"), self.files_of("straight"))

    def test_records_that_are_no_longer_wanted_do_not_outlive_their_course(self):
        """A restart that goes back without the tracks, the frames and the series: none of the course that was left."""
        self.run_well("run", self.case, "--out", "run", "--until", "0.03", "--set", "analysis.grain_profiles={}")
        self.assertTrue((self.folder / "run/profiles.h5").exists())
        self.run_well(
            "run", self.case, "--restart", self.folder / "run/checkpoints/step_200.h5", "--out", "run", "--set",
            "analysis={}", "--set", "output.grains.every=0", "--set", "output.series.every=0", "--until", "0.022",
        )
        self.assertLessEqual(self.tracks("run")["time"].max(), 0.02)
        numpy.testing.assert_allclose(self.series("run")["time"], 0.004 * numpy.arange(6), atol=1e-12)
        self.assertEqual(list(thalweg.Run(self.folder / "run").grains.times), [0.0, 0.01, 0.02])
        self.assertEqual(len(list((self.folder / "run/grains").iterdir())), 3)
        self.assertFalse((self.folder / "run/profiles.h5").exists())

    def test_overwrite_begins_anew(self):
        self.run_well("run", self.case, "--out", "straight", "--until", "0.01")
        self.run_well("run", self.case, "--out", "run", "--until", "0.02")
        (self.folder / "run/tracks.h5").write_text("of an older version")
        self.run_well("run", self.case, "--out", "run", "--until", "0.01", "--overwrite")
        self.assertEqual(self.files_of("run"), self.files_of("straight"))
        self.assertFalse((self.folder / "run/tracks.h5").exists())

    def test_the_run_does_not_notice(self):
        self.run_well("run", self.case, "--out", "watched", "--until", "0.01", "--set", "analysis.tracks.every=1.0e-4")
        self.run_well("run", self.case, "--out", "alone", "--until", "0.01", "--set", "analysis={}")
        self.assert_same_state("watched", "alone")

    def test_every_nth_grain(self):
        self.run_well("run", self.case, "--until", "0.001", "--set", "analysis.tracks={one_in: 3}")
        numpy.testing.assert_array_equal(self.tracks("run")["id"], (0, 3, 6))

    def test_grains_that_are_not_there_are_refused(self):
        self.assert_refused("run", self.case, "--set", "analysis.tracks.grains=[1, 8]",
                            words=["analysis.tracks.grains.1", "ids from 0 to 7"])
        self.assert_refused("run", self.case, "--set", "analysis.tracks.grains=[1, 1]", words=["named twice"])
        self.assert_refused("run", self.case, "--set", "analysis.tracks.grains=[-1]", words=["at least 0"])
        self.assert_refused("run", self.case, "--set", "analysis.tracks.one_in=2", words=["give one of the two"])
        self.assert_refused("run", self.case, "--set", "grains=[]", words=["analysis.tracks", "no grains to watch"])


if __name__ == "__main__":
    program.main()
