#!/usr/bin/env python3
"""Sediment along x in whole runs: grains that roll down a chute from a supply to a sink, balanced to the grain.

Called by ctest: reach_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
import thalweg
from program import ProgramTest

CHUTE = """
system: grains
name: chute
domain: {size: [0.20, 0.02, 0.05], spacing: 5.0e-3, boundaries: {x: no_slip, y: periodic, bottom: no_slip, top: no_slip}}
gravity: {magnitude: 9.81, slope: 0.2}
grains:
  - {count: 40, diameter: 5.0e-3, density: 2650,
     placement: {pattern: random, region: {lower: [0.04, 0, 0], upper: [0.16, 0.02, 0.03]}}}
contact: {normal_stiffness: 1000, restitution: 0.5, friction: 0.5}
supplies:
  - {population: 0, rate: 60, region: {lower: [0.005, 0.003, 0.02], upper: [0.02, 0.017, 0.04]}}
sinks:
  - {region: {lower: [0.185, 0, 0], upper: [0.20, 0.02, 0.05]}}
run: {until: 1.0}
output: {series: {every: 0.01}, grains: {every: 0.01}, checkpoint: {every: 0.45, keep: 9}}
analysis: {reach: {from: 0.2, every: 0.01, record_every: 0.1, sections: 20}}
"""
D, WIDTH, SPACING = 5e-3, 0.02, 0.01   # m
VOLUME = numpy.pi / 6 * D ** 3


class ReachRun(ProgramTest):
    CASE = CHUTE

    def records(self, run):
        return thalweg.Run(self.folder / run).reach

    def assert_same(self, one, other):
        for name, values in self.records(one).items():
            self.assertEqual(values.tobytes(), self.records(other)[name].tobytes(), name)
        self.assertEqual(self.summary(one)["reach"], self.summary(other)["reach"])

    def crossings(self, run, until):
        """Net number of grains through each section, from the frames of the grains."""
        frames = [frame for frame in thalweg.Run(self.folder / run).grains if frame.time <= until + 1e-9]
        sections, net = self.records(run)["section"], 0
        for before, now in zip(frames, frames[1:]):
            ids, first, second = numpy.intersect1d(before.arrays["id"], now.arrays["id"], return_indices=True)
            x, y = (bins[:, None] >= sections for bins in (before.position[first, 0], now.position[second, 0]))
            net = net + y.sum(0) - x.sum(0)
        return net

    def test_a_chute_from_supply_to_sink(self):
        self.run_well("run", self.case, "--out", self.folder / "one")
        found, known, reach = self.summary("one")["reach"], self.series("one"), self.records("one")
        self.assertGreater(known["left_grains"][-1], 30)
        self.assertEqual(found["arrived_grains"], known["supplied_grains"][-1])
        self.assertGreater(found["arrived_grains"], 50)
        self.assertEqual(found["left_grains"], known["left_grains"][-1])
        self.assertEqual(found["balance_residual"], 0)
        self.assertAlmostEqual(found["stored_change"] / VOLUME, known["grains"][-1] - known["grains"][0], places=6)
        self.assertEqual(found["records"], 8)   # of ten
        numpy.testing.assert_allclose(reach["time"], 0.1 * numpy.arange(1, 11), atol=1e-3)   # to a step
        # Of each bin and record, what is stored changes by what passes its two sections, comes in and leaves.
        q_s = numpy.pad(reach["q_s"], ((0, 0), (1, 1)))
        gain = -numpy.diff(q_s, axis=1) / SPACING + reach["arrived"] - reach["left"]
        change = gain * reach["interval"][:, None]
        numpy.testing.assert_allclose(numpy.diff(reach["stored"], axis=0), change[1:], atol=1e-12)
        # The counts are those of the frames.
        passed = (reach["q_s"] * reach["interval"][:, None]).sum(0) * WIDTH / VOLUME
        numpy.testing.assert_allclose(passed, self.crossings("one", reach["time"][-1]), atol=1e-6)
        means = thalweg.Run(self.folder / "one").profiles["reach"]
        numpy.testing.assert_allclose(means["q_s"], reach["q_s"][2:].mean(0), rtol=1e-9)
        self.assertGreater(found["residence_times"], 5)
        # Grains roll from 0.0125 m to 0.185 m; a frictionless way down takes sqrt(2 L/(g sin)) = 0.42 s.
        self.assertGreater(found["residence_time_mean"], 0.42)
        self.assertLess(found["residence_time_mean"], 1.0)

        without_frames = ["--set", "output.grains.every=0"]
        self.run_well("run", self.case, "--out", self.folder / "again", "--until", "0.75", *without_frames)
        self.run_well("run", self.case, "--out", self.folder / "again", "--resume", *without_frames, ranks=2)
        self.assert_same("one", "again")

    def test_records_that_are_no_longer_wanted_do_not_outlive_their_course(self):
        self.run_well("run", self.case, "--out", self.folder / "one", "--until", "0.6")
        first = min((self.folder / "one/checkpoints").glob("step_*"), key=lambda path: int(path.stem[5:]))
        self.run_well("run", self.case, "--out", self.folder / "one", "--restart", first, "--until", "0.46", "--set",
                      "analysis={}")
        self.assertLessEqual(self.records("one")["time"].max(), 0.45)

    def test_grains_that_recirculate(self):
        back = "sinks.0.recirculation={region: {lower: [0.005, 0.003, 0.02], upper: [0.02, 0.017, 0.04]}}"
        settings = ["--set", back, "--set", "supplies=[]"]
        self.run_well("run", self.case, "--out", self.folder / "one", *settings)
        found, known = self.summary("one")["reach"], self.series("one")
        self.assertGreater(known["recirculated_grains"][-1], 30)
        self.assertEqual(found["left_grains"], known["recirculated_grains"][-1])
        self.assertEqual(found["arrived_grains"], found["left_grains"] - known["returning_grains"][-1])
        self.assertEqual(found["balance_residual"], 0)
        self.assertGreaterEqual(self.records("one")["q_s"][:, 12:].min(), 0.0)   # no jump back counts
        self.run_well("run", self.case, "--out", self.folder / "alone", *settings, "--set", "analysis={}")
        self.assert_same_bed("one", "alone")

    def test_what_cannot_be_measured_is_refused(self):
        for setting, words in (
            ("analysis.reach.sections=1", ["analysis.reach.sections", "at least 2"]),
            ("analysis.reach.sections=1001", ["analysis.reach.sections", "at most 1000"]),
            ("analysis.reach.record_every=0.001", ["analysis.reach.record_every", "at least one observation"]),
        ):
            self.assert_refused("run", self.case, "--set", setting, words=words)
        self.run_well("run", self.case, "--out", self.folder / "one", "--until", "0.2")
        self.assert_refused("run", self.case, "--out", self.folder / "one", "--resume", "--set",
                            "analysis.reach.sections=10", words=["section", "not that of this run"])


program.main()
