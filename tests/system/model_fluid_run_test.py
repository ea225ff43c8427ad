#!/usr/bin/env python3
"""Grains under the prescribed force of a model fluid: the same bits on any ranks and after a restart, motion that stops
or goes on, refusals.

Called by ctest: model_fluid_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import json
import re
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest


class ModelFluidRun(ProgramTest):
    CASE = """
system: model_fluid
name: model fluid
domain:
  size: [6, 4, 16]
  spacing: 1
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
gravity: {magnitude: 1}
model_fluid: {units: grain, shields_number: 0.5, reynolds_number: 100, drag: quadratic, lift_ratio: 1}
grains:
  - {count: 40, diameter: 1.0909090909090908, density: 1.8636530433018714, placement: {pattern: random, seed: 1}}
  - {count: 40, diameter: 0.9090909090909091, density: 1.8636530433018714, placement: {pattern: random, seed: 2}}
contact: {normal_stiffness: 5000, tangential_stiffness: 1667, restitution: 0.5, friction: 0, wall_friction: 0}
run: {until: 4, time_step: 7.8e-4}
output: {series: {every: 0.1}, checkpoint: {every: 2, keep: 3}}
"""

    def test_the_same_bits_on_any_ranks_and_after_a_restart(self):
        self.check_bits()

    def test_the_same_bits_with_friction(self):
        self.check_bits("--set", "contact.friction=0.6", "--set", "run.time_step=6e-4")

    def check_bits(self, *settings):
        self.run_well("run", self.case, *settings, "--out", "one")
        for ranks in (2, 4):
            self.run_well("run", self.case, *settings, "--out", f"on_{ranks}", ranks=ranks)
        self.run_well("run", self.case, *settings, "--out", "half", "--until", "2")
        self.run_well("run", self.case, *settings, "--out", "half", "--restart", "half", ranks=2)
        for other in ("on_2", "on_4", "half"):
            self.assert_same_bed("one", other)

    def test_a_grain_that_leaves_its_block_knows_one_that_comes_nearer(self):
        # They meet across the cut at x = 8 without a new list: a spacing of 2 + 0.276 at first, 1.84 at the end; a
        # grain counts for another, whose solid fraction is that of 1.5 around it, from 2 on.
        grain = "{count: 1, diameter: 1, density: 1.909859317102744, "
        (self.folder / "two.yaml").write_text(self.CASE[:self.CASE.index("grains:")].replace("[6, 4, 16]", "[16, 4, 16]").replace(
            "shields_number: 0.5", "shields_number: 0.002").replace("lift_ratio: 1", "lift_ratio: 0") + f"""grains:
  - {grain}velocity: [1, 0, 0], placement: {{positions: [[7.999, 2, 9]]}}}}
  - {grain}velocity: [-1, 0, 0], placement: {{positions: [[10.275, 2, 9]]}}}}
""" + self.CASE[self.CASE.index("contact:"):].replace("until: 4", "until: 0.234"))
        self.run_well("run", "two.yaml", "--out", "one")
        self.run_well("run", "two.yaml", "--out", "on_2", ranks=2)
        self.assert_same_bed("one", "on_2")

    def test_clumps_on_any_ranks_and_after_a_restart(self):
        members = [{"position": [0.33 * numpy.cos(a), 0, 0.33 * numpy.sin(a)], "diameter": 0.55}
                   for a in 2 * numpy.pi * numpy.arange(5) / 5]
        text = json.dumps({"clump": [{"position": [float(x) for x in m["position"]], "diameter": m["diameter"]}
                                     for m in members]})
        case = self.CASE.replace("units: grain", "units: si").replace("time_step: 7.8e-4", "time_step: 2e-4").replace(
            "count: 40, diameter: 1.0909090909090908,", f"count: 20, shape: {text},")
        (self.folder / "clumps.yaml").write_text(case)
        self.run_well("run", "clumps.yaml", "--out", "one")
        self.assertGreater(self.summary("one")["figures"]["largest_grain_speed"], 0.5)
        for ranks in (2, 4):
            self.run_well("run", "clumps.yaml", "--out", f"on_{ranks}", ranks=ranks)
        self.run_well("run", "clumps.yaml", "--out", "half", "--until", "2")
        self.run_well("run", "clumps.yaml", "--out", "half", "--restart", "half", ranks=2)
        for other in ("on_2", "on_4", "half"):
            self.assert_same_bed("one", other)

    def test_a_bed_of_another_run_and_a_restart_soon_after(self):
        # Nearly at rest, grains are within the tolerance of where their solid fractions were taken, but not there. The
        # start takes them anew, and a checkpoint before the first new list of neighbours has them as they are.
        self.run_well("run", self.case, "--out", "source", "--set", "model_fluid.shields_number=0.03", "--until", "12")
        start = ("--set", "initial={from: source, fields: [grains]}")
        self.run_well("run", self.case, *start, "--out", "one", "--until", "1")
        self.run_well("run", self.case, *start, "--out", "half", "--until", "0.04", ranks=2)
        self.run_well("run", self.case, "--out", "half", "--restart", "half", "--until", "1")
        self.assert_same_bed("one", "half")

    def test_grain_units_and_si_are_the_same_motion(self):
        diameter, density, fluid, gravity = 5e-3, 2550.0, 1000.0, 9.81
        reduced = gravity * (1.0 - fluid / density)
        mass = density * numpy.pi / 6.0 * diameter**3 * 0.5 * ((12 / 11)**3 + (10 / 11)**3)
        second, stiffness = numpy.sqrt(diameter / reduced), mass * reduced / diameter
        in_si = (
            self.CASE.replace("units: grain", f"units: si, fluid_density: {fluid}")
            .replace("size: [6, 4, 16]", f"size: [{6 * diameter}, {4 * diameter}, {16 * diameter}]")
            .replace("spacing: 1\n", f"spacing: {diameter}\n")
            .replace("{magnitude: 1}", f"{{magnitude: {gravity}}}")
            .replace("1.0909090909090908", repr(12 / 11 * diameter))
            .replace("0.9090909090909091", repr(10 / 11 * diameter))
            .replace("1.8636530433018714", repr(density))
            .replace(
                "normal_stiffness: 5000, tangential_stiffness: 1667",
                f"normal_stiffness: {5000 * stiffness!r}, tangential_stiffness: {1667 * stiffness!r}",
            )
            .replace("until: 4, time_step: 7.8e-4", f"until: {4 * second!r}, time_step: {7.8e-4 * second!r}")
            .replace("every: 0.1}", f"every: {0.1 * second!r}}}")
            .replace("every: 2,", f"every: {2 * second!r},")
        )
        (self.folder / "si.yaml").write_text(in_si)
        self.run_well("run", self.case, "--out", "grain")
        self.run_well("run", self.folder / "si.yaml", "--out", "si")
        for name, there in (("grain", True), ("si", False)):
            self.assertEqual("grain units: m stands for" in (self.folder / name / "run.log").read_text(), there)
        grain, si = self.bed("grain"), self.bed("si")
        self.assertGreater(abs(grain["velocity"]).max(), 1.0)
        # They differ by rounding, which collisions enlarge.
        self.assertLess(abs(si["position"] / diameter - grain["position"]).max(), 1e-8)
        self.assertLess(abs(si["velocity"] * second / diameter - grain["velocity"]).max(), 1e-7)

    def test_grains_that_touch_the_floor_do_not_move_along_it(self):
        self.run_well("run", self.case, "--until", "15", "--out", "run")
        bed = self.bed()
        low = bed["position"][:, 2] < bed["radius"]
        self.assertGreater(low.sum(), 5)
        self.assertEqual(abs(bed["velocity"][low, :2]).max(), 0.0)
        self.assertGreater(abs(bed["velocity"][~low, 0]).max(), 0.1)
        # The floor has no friction here: without the roughness it holds none.
        self.run_well("run", self.case, "--until", "15", "--out", "smooth", "--set", "model_fluid.rough_floor=false")
        bed = self.bed("smooth")
        low = bed["position"][:, 2] < bed["radius"]
        self.assertGreater(low.sum(), 5)
        self.assertTrue((abs(bed["velocity"][low, :2]).max(axis=1) > 0.0).all())

    def test_a_bed_comes_to_rest_well_below_the_threshold_and_not_well_above(self):
        # Clark et al. (2017): at high Re_* quadratic drag needs a Shields number of 0.11.
        rest = ["--set", "run.until_at_rest={largest_speed: 1e-2, largest_acceleration: 0.1}", "--until", "100"]
        for shields, stops in ((0.02, True), (0.6, False)):
            out = f"at_{shields}"
            self.run_well("run", self.case, "--set", f"model_fluid.shields_number={shields}",
                          "--set", "model_fluid.lift_ratio=0", "--out", out, *rest)
            self.assertEqual(self.summary(out)["simulated_time"] < 99.0, stops, shields)

    RAMP = ["--set", "model_fluid.shields_number=0.05", "--set", "model_fluid.lift_ratio=0",
            "--set", "model_fluid.ramp={every: 2, hold: 20, step: 0.2, largest_speed: 0.02}"]

    def test_a_rising_shields_number_ends_with_motion_without_end(self):
        self.run_well("run", self.case, *self.RAMP, "--until", "400", "--out", "run")
        summary, series = self.summary("run"), self.series()
        self.assertTrue(summary["finished"])
        self.assertLess(summary["simulated_time"], 399.0)
        self.assertIn("motion without end", (self.folder / "run/run.log").read_text())
        # Clark et al. (2017) find 0.11 for large beds, and more for small ones; steps are of 20 %.
        self.assertGreater(summary["figures"]["shields_number"], 0.09)
        self.assertLess(summary["figures"]["shields_number"], 0.5)
        shields = series["shields_number"]
        rises = numpy.flatnonzero(numpy.diff(shields) > 0.0)
        self.assertTrue((numpy.diff(shields) >= 0.0).all())
        numpy.testing.assert_allclose(shields, 0.05 * 1.2 ** numpy.round(numpy.log(shields / 0.05) / numpy.log(1.2)),
                                      rtol=1e-12)
        # Two steps are at least `every` apart; the series has a row each 0.1.
        self.assertGreaterEqual(numpy.diff(series["time"][rises]).min(), 2.0 - 0.11)

    def test_a_bed_of_which_most_grains_fly_is_not_watched_for_longer(self):
        # With linear drag and elastic collisions a bed that has begun to move takes off (Clark et al. 2017, section III
        # B).
        self.run_well("run", self.case, *self.RAMP[:4], "--set", "model_fluid.drag=linear", "--set",
                      "model_fluid.reynolds_number=10", "--set", "contact.restitution=0.8", "--set",
                      "model_fluid.ramp={every: 2, hold: 1000, step: 0.2, largest_speed: 0.02, mobile_share: 0.5}",
                      "--until", "400", "--out", "run")
        summary, series = self.summary("run"), self.series()
        self.assertLess(summary["simulated_time"], 399.0)   # long before `hold` is over
        self.assertEqual(summary["figures"]["hold_left"], 0.0)
        self.assertIn("motion without end", (self.folder / "run/run.log").read_text())
        self.assertGreater(series["largest_grain_speed"][-1], 1.0)
        # Grains that fall at the start move as fast, and the bed is not taken for a mobile one.
        self.assertGreater(series["largest_grain_speed"][:50].max(), 1.0)
        self.assertGreater(series["shields_number"][-1], 0.05)

    def test_a_rising_shields_number_on_any_ranks_and_after_a_restart(self):
        self.run_well("run", self.case, *self.RAMP, "--out", "one", "--until", "40")
        self.assertGreater(self.summary("one")["figures"]["shields_number"], 0.055)   # it has risen
        self.run_well("run", self.case, *self.RAMP, "--out", "half", "--until", "34", ranks=2)
        self.run_well("run", self.case, *self.RAMP, "--out", "half", "--restart", "half", "--until", "40")
        self.assert_same_bed("one", "half")

    def test_a_restart_with_larger_steps_goes_on_from_the_shields_number_reached(self):
        self.run_well("run", self.case, *self.RAMP, "--out", "run", "--until", "36")
        reached = self.summary("run")["figures"]["shields_number"]
        self.assertGreater(reached, 0.055)
        self.run_well(
            "run", self.case, *self.RAMP, "--set", "model_fluid.ramp.step=0.5", "--out", "run", "--restart", "run",
            "--until", "60",
        )
        figures = self.summary("run")["figures"]
        steps = numpy.log(figures["shields_number"] / reached) / numpy.log(1.5)
        self.assertGreater(steps, 0.9)
        self.assertAlmostEqual(steps, round(steps), 9)
        # B_1 is that of the fluid: Re_* grows with the root.
        self.assertAlmostEqual(figures["reynolds_number"] / (100 * (figures["shields_number"] / 0.05) ** 0.5), 1.0, 12)

    def test_what_check_says(self):
        said = self.run_well("check", self.case).stdout
        self.assertIn("Shields number 0.5; Re_* 100 as printed, u_* D/nu 600", said)
        self.assertIn("mean grain 1 m, 1 kg; reduced gravity 1 m/s^2", said)
        self.assertIn("grain units: m stands for the mean diameter D", said)

    def test_the_coefficients_of_the_force_follow_from_the_numbers_of_the_case(self):
        # docs/theory.md, section 4b, in units in which D, m and g' are 1: B_1 from Re_*, or from a sixth of u_* D/nu,
        # B_2 as given, and the velocity at which Theta is 2/3 (B_1 v_0 + B_2 v_0^2).
        for settings, theta, reynolds, b2 in (
            ((), 0.5, 100, 0.5),
            (("reynolds_number=null", "shear_reynolds_number=240", "inertial_coefficient=0.8", "shields_number=0.3"),
             0.3, 40, 0.8),
            (("drag=linear", "reynolds_number=10"), 0.5, 10, 0.0),
        ):
            with self.subTest(settings=settings):
                words = [word for s in settings for word in ("--set", f"model_fluid.{s}")]
                said = self.run_well("check", self.case, *words).stdout
                numbers = re.search(r"fluid at (\S+) m/s at the top of the bed; B_1 (\S+) kg/s, B_2 (\S+) kg/m", said)
                velocity, *found = map(float, numbers.groups())
                b1 = (3 * theta) ** 0.5 / reynolds
                numpy.testing.assert_allclose(found, (b1, b2), rtol=5.1e-4)   # four digits
                self.assertAlmostEqual((b1 * velocity + b2 * velocity ** 2) / (1.5 * theta), 1, delta=1.1e-3)

    def test_refusals(self):
        for settings, words in (
            (["grains.0.density=2550"], ["model_fluid.units", "mean mass", "are 1"]),
            (["model_fluid={shields_number: 0.1, reynolds_number: 1}"], ["drag law is missing"]),
            (["model_fluid.densest_fraction=0.3"], ["densest_fraction", "larger than top_fraction"]),
            (["model_fluid.shear_reynolds_number=6"], ["Reynolds number is given twice"]),
            (["model_fluid.ramp={every: 5}"], ["ramp.hold", "missing"]),
            (["model_fluid.ramp={every: 5, hold: 9}", "run.until_at_rest={}"], ["until_at_rest", "model_fluid.ramp"]),
            (["gravity.slope=0.1"], ["gravity", "downwards"]), (["model_fluid.fluid_density=3"], ["float"]),
            (["domain.boundaries.y=no_slip"], ["domain.boundaries", "x and y periodic"]),
            (["walls=[{point: [1, 1, 1], normal: [1, 0, 0]}]"], ["walls", "remove the section"]),
            (["system=grains"], ["model_fluid", "only system: model_fluid has it"]),
        ):
            with self.subTest(settings=settings):
                self.assert_refused("run", self.case, *[word for s in settings for word in ("--set", s)], words=words)


if __name__ == "__main__":
    program.main()
