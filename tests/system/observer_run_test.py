#!/usr/bin/env python3
"""Observers of transport and of the bed's surface in a whole run: same bits on any ranks, same means after a restart,
and a run that does not notice them.

Called by ctest: observer_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import csv
import sys
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest
from thalweg import Run, RunFolderError


class ObserverRun(ProgramTest):
    # Two kinds of grains fall through flowing water onto the floor of a short flume.
    CASE = """
system: resolved
name: watched flume
domain:
  size: [0.0264, 0.010725, 0.0264]   # m
  spacing: 0.825e-3                  # m
  boundaries: {x: periodic, y: no_slip, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, smagorinsky_constant: 0.27, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.1}
grains:
  - {count: 20, diameter: 4.95e-3, density: 2550, placement: {pattern: uniform, seed: 1}, velocity: [0.2, 0.0, -0.1]}
  - {count: 6, diameter: 4.2e-3, density: 2000, placement: {pattern: random, seed: 2}, velocity: [0.2, 0.0, -0.1]}
contact: {normal_stiffness: 20000, tangential_stiffness: 5714, restitution: 0.5, friction: 0.5, wall_friction: 0.45}
coupling: {grain_steps_per_fluid_step: 20}
initial: {fluid: {uniform: [0.2, 0.0, 0.0]}}
run: {until: 0.08}
output:
  series: {every: 0.004}
  checkpoint: {every: 0.04, keep: 3}
analysis:
  transport_rate: {from: 0.01, every: 1.0e-3}
  fractional_transport: {from: 0.01, every: 1.0e-3}
  bed_surface: {every: 3.0e-3, static_time: 0.015}
"""

    def test_the_same_bits_on_any_ranks(self):
        self.run_well("run", self.case, "--out", "one")
        for ranks in (2, 4):
            out = f"on_{ranks}"
            self.run_well("run", self.case, "--out", out, ranks=ranks)
            self.assert_same_end(out, "one", "series.csv", "profiles.h5")
            for observer in ("transport_rate", "fractional_transport", "bed_surface"):
                self.assertEqual(self.summary(out)[observer], self.summary("one")[observer])

    def test_the_bed_at_the_end(self):
        # Two layers of a cubic lattice that has hardly begun to fall: a solid fraction of 0.45.
        places = [[(i + 0.5) * 5.28e-3, (j + 0.5) * 5.3625e-3, 2.476e-3 + k * 4.952e-3]
                  for k in range(2) for j in range(2) for i in range(5)]
        self.run_well("run", self.case, "--until", "0.002", "--set", "analysis={}", "--set",
                      f"grains=[{{diameter: 4.95e-3, density: 2550, placement: {{positions: {places}}}}}]")
        bed = self.summary("run")["bed"]
        self.assertLess(bed["porosity"], 0.6)   # above, it would be no bed
        depth = 0.0264 - bed["bed_height"]
        along = 9.8 * 0.1 / (1 + 0.1 ** 2) ** 0.5   # the sine of the slope
        self.assertAlmostEqual(bed["bed_stress"], 1000 * along * depth * 0.010725 / (2 * depth + 0.010725), delta=1e-9)
        self.assertAlmostEqual(bed["shields_number"], bed["bed_stress"] / (1550 * 9.8 * 4.95e-3), delta=1e-9)
        self.assertIn("bed: ", (self.folder / "run/run.log").read_text())

    def test_a_restart_half_way_has_the_same_means(self):
        self.run_well("run", self.case, "--out", "straight")
        half_way = self.folder / "straight/checkpoints/step_400.h5"
        self.run_well("run", self.case, "--out", "again", "--restart", half_way, ranks=2)
        self.assert_same_end("again", "straight")
        for observer in ("transport_rate", "fractional_transport", "bed_surface"):
            self.assertEqual(self.summary("again")[observer], self.summary("straight")[observer])
        self.assertGreater(self.summary("again")["bed_surface"]["static_pictures"], 2)
        rows = (self.folder / "straight/series.csv").read_text().splitlines()
        self.assertEqual((self.folder / "again/series.csv").read_text().splitlines()[1:], rows[-len(rows) // 2:])

    def test_a_run_that_ends_before_its_means_begin_has_none(self):
        """Zero would look like a result."""
        self.run_well("run", self.case, "--until", "0.002", "--set", "analysis.bed_surface.from=0.01", "--set",
                      "analysis.stress_balance={from: 0.01, every: 1.0e-3}")
        summary = self.summary("run")
        for observer, name in (
            ("transport_rate", "q_star_mean"), ("transport_rate", "moving_grains_mean"),
            ("fractional_transport", "class_0_q_s_mean"), ("fractional_transport", "armouring_ratio_mean"),
            ("bed_surface", "bed_height_mean"), ("bed_surface", "shields_number_mean"),
            ("stress_balance", "largest_difference"),
        ):
            self.assertIsNone(summary[observer][name], name)
            self.assertEqual(summary[observer]["measurements"], 0)
        self.assertGreater(summary["transport_rate"]["reference_diameter"], 0.0)
        header, row = csv.reader(self.run_well("info", "--csv", "run").stdout.splitlines())
        self.assertEqual(row[header.index("transport_rate.q_star_mean")], "")
        with self.assertRaisesRegex(RunFolderError, "nothing has been measured"):
            Run(self.folder / "run").result("transport_rate", "q_star_mean")

    def test_the_run_does_not_notice(self):
        self.run_well("run", self.case, "--out", "watched", "--until", "0.02")
        self.run_well("run", self.case, "--out", "alone", "--until", "0.02", "--set", "analysis={}")
        self.assert_same_state("watched", "alone")

    def test_the_numbers_belong_together(self):
        self.run_well("run", self.case)
        transport, surface, series = (
            self.summary("run")["transport_rate"], self.summary("run")["bed_surface"], self.series(),
        )
        # 20 of 4.95 mm have 0.897 of the volume of all; density of them all: mass over volume.
        self.assertEqual(transport["reference_diameter"], 4.95e-3)
        large, small = 20 * 4.95 ** 3, 6 * 4.2 ** 3
        self.assertAlmostEqual(
            transport["reference_density"], (2550 * large + 2000 * small) / (large + small), delta=1e-9
        )
        self.assertEqual(transport["measurements"], 71)   # every millisecond from 10 to 80
        # q* = q_s/sqrt((s - 1) g d^3), g the magnitude of gravity on any slope.
        unit = ((transport["reference_density"] / 1000 - 1) * 9.8 * 4.95e-3 ** 3) ** 0.5
        self.assertGreater(abs(series["q_star"]).min(), 0.0)
        numpy.testing.assert_allclose(series["q_star"] * unit, series["q_s"], rtol=1e-12)
        for name in ("mean", "error", "deviation"):
            self.assertAlmostEqual(transport[f"q_star_{name}"] * unit / transport[f"q_s_{name}"], 1.0, 12)
        # Classes of the two sizes, which add up to all.
        sizes = Run(self.folder / "run").fractional_transport
        numpy.testing.assert_allclose(sizes["diameter"], [4.2e-3, 4.95e-3], rtol=1e-12)
        numpy.testing.assert_allclose(sizes["density"], [2000, 2550], rtol=1e-12)
        numpy.testing.assert_allclose(sizes["bed_share"][1], large / (large + small), rtol=1e-12)
        numpy.testing.assert_allclose(sizes["q_s"].sum(), transport["q_s_mean"], rtol=1e-12)
        numpy.testing.assert_allclose(
            series["class_0_q_s"] + series["class_1_q_s"], series["q_s"], rtol=1e-9, atol=1e-18
        )
        numpy.testing.assert_array_equal(
            series["class_0_moving_grains"] + series["class_1_moving_grains"], series["moving_grains"]
        )
        numpy.testing.assert_allclose(
            series["class_0_surface_share"] + series["class_1_surface_share"], 1.0, rtol=1e-12
        )
        self.assertIn("sizes: d50 of the bed 0.00495 m", (self.folder / "run/run.log").read_text())
        # R_h and the stress of the last row from its height.
        depth = 0.0264 - series["bed_height"][-1]
        radius = depth * 0.010725 / (2 * depth + 0.010725)
        self.assertAlmostEqual(series["hydraulic_radius"][-1], radius, delta=1e-9)
        along = 9.8 * 0.1 / (1 + 0.1 ** 2) ** 0.5   # the sine of the slope
        self.assertAlmostEqual(series["bed_stress"][-1], 1000 * along * radius, delta=1e-9)
        excess = (transport["reference_density"] - 1000) * 9.8 * 4.95e-3
        self.assertAlmostEqual(series["shields_number"][-1], 1000 * along * radius / excess, delta=1e-9)
        # At the very end, two steps of the series later at most, the grains still fall: they have a height, but are no
        # bed.
        bed = self.summary("run")["bed"]
        self.assertAlmostEqual(bed["bed_height"], series["bed_height"][-1], delta=0.1 * 4.95e-3)
        self.assertGreater(bed["porosity"], 0.6)
        self.assertEqual(sorted(bed), ["bed_height", "porosity"])
        self.assertIn("no bed at the end", (self.folder / "run/run.log").read_text())
        # The grain that all of it refers to in every place.
        for name in ("reference_diameter", "reference_density"):
            self.assertEqual(self.summary("run")[name], transport[name])
            self.assertTrue((series[name] == transport[name]).all())
        checked = self.run_well("check", self.case).stdout
        self.assertIn("reference  diameter 0.00495 m", checked)
        log = (self.folder / "run/run.log").read_text()
        self.assertIn("reference grain: diameter 0.00495 m", log)
        self.assertIn("transport: q* = ", log)
        with h5py.File(self.folder / "run/profiles.h5") as profiles:
            outline = profiles["bed_surface/static_surface"][()]
            self.assertEqual(len(outline), round(0.0264 / (4.95e-3 / 25)))
            self.assertAlmostEqual(outline.mean(), surface["static_bed_height_mean"], delta=1e-12)
            edges, density = (
                profiles["transport_rate/velocity_edges"][()], profiles["transport_rate/velocity_density"][()],
            )
            numpy.testing.assert_allclose((density * numpy.diff(edges)[:, None]).sum(axis=0), 1.0, atol=1e-9)

    def test_what_cannot_be_measured_is_refused(self):
        self.assert_refused("run", self.case, "--set", "domain.boundaries.bottom=periodic", "--set",
                            "domain.boundaries.top=periodic", "--set", "analysis.fractional_transport=null",
                            words=["analysis.bed_surface", "periodic"])
        self.assert_refused("run", self.case, "--set", "grains=[]", "--set", "analysis.transport_rate=null",
                            "--set", "analysis.fractional_transport=null", words=["analysis.bed_surface", "no grains"])
        self.assert_refused(
            "run", self.case, "--set", "analysis.fractional_transport.edges=[4.5e-3, 5e-3]",
            words=["analysis.fractional_transport.edges", "cover all free grains, from 0.0042 to 0.00495 m"],
        )
        self.assert_refused("run", self.case, "--set", "domain.boundaries.bottom=periodic", "--set",
                            "domain.boundaries.top=periodic", words=["analysis.fractional_transport", "from above"])
        self.assert_refused("run", self.case, "--set", "analysis.fractional_transport.edges=[5e-3, 4e-3]",
                            words=["analysis.fractional_transport.edges", "must rise"])
        self.assert_refused("run", self.case, "--set", "analysis.reference_diameter=0",
                            words=["analysis.reference_diameter = 0", "a number in m above 0"])


class OrderOfPopulations(ProgramTest):
    """A fixed layer of large heavy spheres and two kinds of free ones, in three orders: the same figures."""
    HEAD = """
system: resolved
name: three populations
domain:
  size: [0.030, 0.018, 0.030]   # m
  spacing: 1.0e-3               # m
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, smagorinsky_constant: 0.27, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.1}
contact: {normal_stiffness: 20000, tangential_stiffness: 5714, restitution: 0.5, friction: 0.5}
coupling: {grain_steps_per_fluid_step: 20}
initial: {fluid: {uniform: [0.2, 0.0, 0.0]}}
run: {until: 0.02}
output: {series: {every: 0.002}, checkpoint: {every: 0.02}}
analysis: {transport_rate: {every: 1.0e-3}, bed_surface: {every: 2.0e-3, static_time: 0.01}}
grains:
"""
    POPULATIONS = {
        "fixed": "  - {diameter: 9.0e-3, density: 5000, fixed: true, placement: {positions: "
                 "[[0.005, 0.009, 0.005], [0.015, 0.009, 0.005], [0.025, 0.009, 0.005]]}}\n",
        "small": "  - {diameter: 5.0e-3, density: 2000, velocity: [0.2, 0, 0], placement: {positions: "
                 "[[0.004, 0.009, 0.013], [0.010, 0.004, 0.013], [0.016, 0.009, 0.013]]}}\n",
        "large": "  - {diameter: 6.0e-3, density: 2550, velocity: [0.1, 0, 0], placement: {positions: "
                 "[[0.005, 0.009, 0.021], [0.018, 0.009, 0.021]]}}\n"}

    def test_changes_no_result(self):
        orders = (("fixed", "small", "large"), ("large", "fixed", "small"), ("small", "large", "fixed"))
        runs = []
        for number, order in enumerate(orders):
            self.case.write_text(self.HEAD + "".join(self.POPULATIONS[name] for name in order))
            self.run_well("run", self.case, "--out", f"run_{number}")
            runs.append((self.series(f"run_{number}"), self.summary(f"run_{number}")))
        # Of 3 grains of 5 mm and 2 of 6 mm: 375 and 432 in volume, so the half is finer than 6 mm.
        self.assertEqual(runs[0][1]["reference_diameter"], 6.0e-3)
        self.assertAlmostEqual(runs[0][1]["reference_density"], (375 * 2000 + 432 * 2550) / 807, delta=1e-9)
        self.assertGreater(runs[0][0]["q_star"][-1], 1e-3)
        for series, summary in runs[1:]:
            for name, column in runs[0][0].items():
                if name in ("q_s", "q_star", "shields_number", "bed_height", "moving_grains", "reference_diameter"):
                    numpy.testing.assert_allclose(series[name], column, rtol=1e-9, atol=1e-12, err_msg=name)
            for group in ("transport_rate", "bed"):
                for name, value in runs[0][1][group].items():
                    if value is not None:
                        self.assertAlmostEqual(summary[group][name], value, delta=1e-9 * max(1.0, abs(value)), msg=name)


class BedStress(ProgramTest):
    """Slow flow over four fixed spheres, driven otherwise than by a slope."""
    CASE = """
system: resolved
name: oil over spheres
domain:
  size: [0.012, 0.012, 0.024]   # m
  spacing: 1.0e-3               # m
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: {type: moving, velocity: [0.05, 0, 0]}}
fluid: {density: 900, kinematic_viscosity: 1.0e-4, subgrid_model: none, time_step: 1.0e-3, collision: trt, precision: double}
gravity: {magnitude: 9.8, slope: 0}
grains:
  - {diameter: 5.0e-3, density: 2500, fixed: true,
     placement: {positions: [[0.003, 0.003, 0.0025], [0.009, 0.003, 0.0025], [0.003, 0.009, 0.0025], [0.009, 0.009, 0.0025]]}}
contact: {restitution: 0.5, normal_stiffness: 2000, tangential_stiffness: 571}
coupling: {grain_steps_per_fluid_step: auto}
run: {until: 6.0}
output: {series: {every: 0.1}}
analysis: {bed_surface: {every: 0.1}, wall_forces: {}, population_loads: {}}
"""
    AREA = 0.012 * 0.012
    SHIELDS = 1600 * 9.8 * 5e-3   # Pa a unit of the Shields number

    def resistance(self, series):
        """Force (N) of the steady water on floor and spheres along x."""
        return series["fluid_wall_force_bottom_x"][-1] + series["grains_0_fluid_force_x"][-1]

    def test_under_a_moving_lid_it_is_the_stress_at_the_lid(self):
        self.run_well("run", self.case)
        series = self.series()
        stress = self.resistance(series) / self.AREA   # what the lid gives, floor and spheres take
        self.assertAlmostEqual(series["bed_stress"][-1] / stress, 1.0, delta=0.01)
        self.assertAlmostEqual(
            self.summary("run")["bed"]["shields_number"], series["bed_stress"][-1] / self.SHIELDS, delta=1e-12
        )
        # Couette flow from somewhere between the floor and the tops of the spheres.
        self.assertGreater(stress, 900 * 1e-4 * 0.05 / 0.024)
        self.assertLess(stress, 900 * 1e-4 * 0.05 / 0.019)

    def test_of_a_held_mean_velocity_it_is_that_of_the_force(self):
        self.run_well("run", self.case, "--set", "domain.boundaries.top=free_slip",
                      "--set", "fluid.mean_velocity={velocity: 0.02, response_time: 0.5}")
        series = self.series()
        # The force acts on the water; its share above the bed is the stress there.
        water = self.AREA * 0.024 - 4 * numpy.pi / 6 * 5e-3 ** 3
        force = self.resistance(series) / water
        self.assertAlmostEqual(series["bed_stress"][-1] / (force * series["flow_depth"][-1]), 1.0, delta=0.03)
        self.assertAlmostEqual(series["body_force_x"][-1] / force, 1.0, delta=0.03)
        self.assertAlmostEqual(series["mean_velocity_x"][-1], 0.02, delta=0.03 * 0.02)

    def test_a_lid_at_rest_takes_its_share(self):
        self.run_well("run", self.case, "--set", "domain.boundaries.top=no_slip", "--set", "gravity.slope=0.01")
        series = self.series()
        # Between two plates at rest the upper one takes about half of the force; the spheres only shift it.
        force = 900 * 9.8 * 0.01 * series["flow_depth"][-1]
        self.assertGreater(series["bed_stress"][-1], 0.4 * force)
        self.assertLess(series["bed_stress"][-1], 0.6 * force)


if __name__ == "__main__":
    program.main()
