#!/usr/bin/env python3
"""Grains that settle in a periodic box, their weight carried by a mean pressure gradient, and how many of them a solid
fraction makes.

Called by ctest: suspension_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest
from thalweg import Run


class SuspensionRun(ProgramTest):
    # Relaxation time 1; a single sphere would settle at a Reynolds number of 0.1.
    CASE = """
system: resolved
name: suspension
domain:
  size: [0.008, 0.008, 0.008]
  spacing: 2.5e-4
  boundaries: {x: periodic, y: periodic, bottom: periodic, top: periodic}
fluid: {density: 1000, kinematic_viscosity: 1.476e-4, time_step: 7.056e-5, collision: trt, subgrid_model: none}
gravity: {vector: [3, 0, -9], mode: balanced}
grains:
  - {solid_fraction: 0.2, diameter: 2.0e-3, density: 1500, placement: {pattern: dense, seed: 1}}
contact: {normal_stiffness: 20, tangential_stiffness: 5, restitution: 0.5, friction: 0.3}
coupling: {links: cli, grain_steps_per_fluid_step: 10}
run: {until: 0.04}
output: {series: {every: 0.01}, grains: {every: 0.01}, fluid: {every: 0.01, fields: [velocity]}, checkpoint: {every: 0.02}}
"""

    def test_the_weight_of_the_grains_moves_nothing_as_a_whole(self):
        self.run_well("run", self.case, "--out", "run")
        run = Run(self.folder / "run")
        count, volume = run.summary["grains"], numpy.pi / 6.0 * 2e-3**3
        self.assertEqual(count, round(0.2 * 0.008**3 / volume))
        time = run.series["time"][-1]
        fluid = (
            1000.0 * run.fluid.nearest(time).arrays["velocity"].reshape(-1, 3).sum(axis=0) * 2.5e-4**3
        )  # zero in grains
        grains = 1500.0 * volume * run.grains.nearest(time).velocity.sum(axis=0)
        of_series = numpy.array(
            [[run.series[f"{phase}_momentum_{axis}"][-1] for axis in "xyz"] for phase in ("fluid", "grain")]
        )
        # The frame has velocities in single precision.
        self.assertLess(numpy.linalg.norm(of_series - [fluid, grains]), 1e-4 * numpy.linalg.norm(grains))
        # They settle along gravity, far slower than they would fall.
        weight = 500.0 * volume * count * numpy.array([3.0, 0.0, -9.0])
        self.assertGreater(-grains[2], 0.0)
        self.assertLess(abs(grains[0] / grains[2] + 1.0 / 3.0), 0.1)
        self.assertLess(numpy.linalg.norm(grains), 0.1 * numpy.linalg.norm(weight) * time)
        # The fluid has what they have, the other way. The force on the fluid acts on whole cells, whose number differs
        # from the fluid's volume by a per cent of the grains' or so, for a fifth of the weight.
        self.assertLess(numpy.linalg.norm(fluid + grains), 0.01 * 0.2 * numpy.linalg.norm(weight) * time)

    def test_what_drives_a_suspension_between_plates_adds_up_to_nothing(self):
        self.run_well("run", self.case, "--out", "run", "--until", "0.01", *[word for setting in (
            "domain.boundaries.bottom=no_slip", "domain.boundaries.top=no_slip", "gravity.vector=[9, 0, 0]",
            "analysis.stress_balance={from: 0.005}") for word in ("--set", setting)])
        driving = Run(self.folder / "run").profiles["stress_balance"]["driving_stress"]
        # Between the middles of the lowest and the highest layer the weight of the grains, per area, and the force of
        # the pressure gradient cancel but for what is beyond these: of either a sixteenth.
        weight = 500.0 * 9.0 * 0.2 * 0.008
        self.assertLess(abs(driving[0] - driving[-1]), weight / 10)
        self.assertGreater(numpy.ptp(driving), weight / 50)

    def test_the_same_bits_on_any_ranks_and_after_a_restart(self):
        self.run_well("run", self.case, "--out", "one", "--until", "0.01")
        self.run_well("run", self.case, "--out", "two", "--until", "0.01", ranks=2)
        self.run_well("run", self.case, "--out", "half", "--until", "0.005")
        self.run_well("run", self.case, "--out", "half", "--restart", "half", "--until", "0.01", ranks=2)
        for other in ("two", "half"):
            self.assert_same_bed("one", other)

    def test_refusals(self):
        for settings, words in (
                (["domain.boundaries.bottom=no_slip", "domain.boundaries.top=no_slip"],
                 ["gravity.mode", "walls across z", "mode: reduced"]),
                (["grains.0.fixed=true"], ["gravity.mode", "no weight of free grains"]),
                (["grains.0.count=5"], ["solid_fraction", "remove one of the two"]),
                (["grains.0.diameter=1e-9"], ["grains.0.solid_fraction", "larger diameter"]),
                (["grains.0.solid_fraction=0.7"], ["do not fit"])):
            self.assert_refused("check", self.case, *[part for s in settings for part in ("--set", s)], words=words)


if __name__ == "__main__":
    program.main()
