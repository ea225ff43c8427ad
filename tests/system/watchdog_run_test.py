#!/usr/bin/env python3
"""Runs that go wrong, and what the program says of them.

Called by ctest: watchdog_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest


class TooFast(ProgramTest):
    # Nothing holds this fluid back: u = g t. In cells a step, with dx/dt = 10 m/s, it is 5.2 t/s: 0.15 after 577 steps,
    # 0.2 after 769 and 0.3 after 1154. It is looked at every 100 steps.
    CASE = """
system: fluid
name: free fall
domain:
  size: [0.008, 0.004, 0.004]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: periodic, bottom: free_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-4, time_step: 5.0e-5, precision: double}
gravity: {vector: [52, 0, 0]}
run: {until: 0.07}
output: {series: {every: 0}, checkpoint: {every: 0.02, keep: 3}}
"""

    def test_it_is_warned_of_then_stopped_and_the_last_good_checkpoint_survives(self):
        for ranks in (1, 2):
            run = self.folder / f"run_{ranks}"
            result = self.thalweg("run", self.case, "--out", run, ranks=ranks)
            self.assertEqual(result.returncode, 1, result.stderr + result.stdout)
            message = [line for line in result.stderr.splitlines() if line.startswith("thalweg: ")][0]
            for word in (
                "0.06 s (step 1200)", "is 0.312, beyond the limit of 0.3",
                "in the cell at (0.00025, 0.00025, 0.00025) m", "shorten fluid.time_step", "step_800.h5",
            ):
                self.assertIn(word, message)
            self.assertEqual((run / "checkpoints/latest").read_text().strip(), "step_800.h5")
            self.assertTrue((run / "checkpoints/step_400.h5").is_file())
            log = [line for line in (run / "run.log").read_text().splitlines()
                   if line.startswith("warning: At ")]   # others are of the case before it starts
            self.assertEqual(len(log), 2)
            self.assertIn("(step 600) the share of fluid cells that move at more than 0.15 cells per step is 1,", log[0])
            self.assertIn("(step 800) the largest velocity of the fluid in cells per step is 0.208, beyond 0.2 "
                          "(the run stops at 0.3)", log[1])
            summary = self.summary(f"run_{ranks}")
            self.assertFalse(summary["finished"])
            self.assertIn("step_800.h5", summary["reason"])
            self.assertEqual(summary["warnings"], 2)
            # From the good checkpoint, with what the message advises against: the same end.
            again = self.thalweg("run", self.case, "--restart", run, ranks=ranks)
            self.assertEqual(again.returncode, 1)
            self.assertIn("step 1200", again.stderr)

    def test_who_wants_to_see_it_break_may(self):
        self.run_well("run", self.case, "--set", "run.watchdog=warn", "--until", "0.065")
        # 0.208, then half as much again: 0.312 at step 1200. And the fraction, once.
        self.assertEqual(self.summary("run")["warnings"], 3)
        self.assert_refused(
            "run", self.case, "--set", "run.watchdog=bite", words=["run.watchdog", "bite", "stop", "warn"]
        )

    def test_without_a_checkpoint_it_says_so(self):
        result = self.thalweg("run", self.case, "--set", "output.checkpoint.every=0")
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"There is no checkpoint to restart from in {self.folder / 'run'}; set output.checkpoint.every", result.stderr)


class Unstable(ProgramTest):
    # Water without a subgrid model between rough plates at 0.1 cells a step: docs/stability.md has it unstable.
    CASE = """
system: fluid
name: unstable
domain:
  size: [0.020, 0.010, 0.012]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, subgrid_model: none, time_step: 5.0e-5}
gravity: {magnitude: 9.8, slope: 0.3}
initial: {fluid: {log_profile: {bed_height: 0.0, shear_velocity: 0.05, roughness: 1.0e-5, perturbation: {seed: 5}}}}
run: {until: 1.0}
output: {series: {every: 0.005}, checkpoint: {every: 0.01, keep: 3}}
"""

    def test_it_ends_with_a_place_and_a_good_checkpoint(self):
        result = self.thalweg("run", self.case)
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertRegex(result.stderr, r"\(step \d+\).* in the cell at \(")
        self.assertIn(str(self.last_checkpoint("run")), result.stderr)
        velocities = self.series()["largest_lattice_velocity"]
        self.assertLess(velocities.max(), 0.3)


class Healthy(ProgramTest):
    # Four grains settle in water that begins at rest, over the first tenth of the fall.
    CASE = """
system: resolved
name: four grains settle
domain:
  size: [0.016, 0.016, 0.024]
  spacing: 0.8e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, smagorinsky_constant: 0.27, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.05}
grains:
  - {count: 4, diameter: 5.0e-3, density: 2550, placement: {pattern: uniform}}
contact: {restitution: 0.9}
coupling: {grain_steps_per_fluid_step: 20}
run: {until: 0.03}
output: {series: {every: 0.005}}
analysis: {transport_rate: {}}
"""

    def test_nothing_is_said_and_the_figures_are_there(self):
        result = self.run_well("run", self.case)
        self.assertNotIn("warning: At", result.stdout)
        self.assertEqual(self.summary("run")["warnings"], 0)
        header = (self.folder / "run/series.csv").read_text().splitlines()[0].split(",")
        self.assertEqual(len(header), len(set(header)))
        for column in ("largest_lattice_velocity [1]", "mean_density_deviation [1]", "largest_overlap [diameter]",
                       "smallest_density_deviation [1]", "largest_density_deviation [1]", "fast_cell_fraction [1]",
                       "largest_grain_speed [m/s]", "moving_grains [1]"):
            self.assertIn(column, header)
        series = self.series()
        self.assertTrue((series["smallest_density_deviation"] <= series["mean_density_deviation"]).all())
        self.assertTrue((series["largest_density_deviation"] >= series["mean_density_deviation"]).all())
        # Submerged grains fall at less than g (1 - 1/2.55), and the flow is just beginning.
        self.assertGreater(series["largest_grain_speed"][-1], 0.05)
        self.assertLess(series["largest_grain_speed"][-1], 9.8 * 0.61 * 0.03)


if __name__ == "__main__":
    program.main()
