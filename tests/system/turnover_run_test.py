#!/usr/bin/env python3
"""Supplies and sinks in whole runs: dry grains and clumps, and grains in a stream between inlet and outlet.

Called by ctest: turnover_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest
import thalweg

DRY = """
system: grains
name: chute
domain: {size: [0.06, 0.03, 0.08], spacing: 5.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}}
gravity: {magnitude: 9.81, slope: 0}
grains:
  - {count: 40, diameter: {sizes: [3.0e-3, 5.0e-3], fractions: [0.5, 0.5]}, density: 2650, placement: {pattern: random}}
  - {count: 5, shape: {clump: [{position: [0, 0, 0], diameter: 3.0e-3}, {position: [2.0e-3, 0, 0], diameter: 3.0e-3}]},
     density: 2650, placement: {pattern: random, region: {lower: [0, 0, 0.05], upper: [0.06, 0.03, 0.08]}}}
contact: {normal_stiffness: 1000, restitution: 0.5, friction: 0.5}
supplies:
  - {population: 0, rate: 300, region: {lower: [0.01, 0.01, 0.06], upper: [0.05, 0.02, 0.07]}, velocity: [0.1, 0, -0.2]}
  - {population: 1, mass_rate: 0.01, from: 0.02, region: {lower: [0.01, 0.01, 0.06], upper: [0.05, 0.02, 0.075]}, seed: 2}
sinks:
  - {region: {lower: [0, 0, 0], upper: [0.02, 0.03, 0.01]}}
  - {region: {lower: [0.04, 0, 0], upper: [0.06, 0.03, 0.01]},
     recirculation: {delay: 0.03, region: {lower: [0, 0, 0.06], upper: [0.06, 0.03, 0.075]}}}
run: {until: 0.2}
output: {series: {every: 0.01}, grains: {every: 0.05}, checkpoint: {every: 0.1, keep: 9}}
analysis: {transport_rate: {from: 0.02}}
"""

STREAM = """
system: resolved
name: open reach
domain:
  size: [0.060, 0.015, 0.020]
  spacing: 1.25e-3
  boundaries: {x_low: {type: velocity_inlet, velocity: [0.2, 0, 0]}, x_high: pressure_outlet, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, time_step: 2.0e-4}
initial: {fluid: {uniform: [0.2, 0, 0]}}
gravity: {magnitude: 9.81, slope: 0}
grains:
  - {diameter: 5.0e-3, density: 1050, placement: {positions: [[0.02, 0.0075, 0.01], [0.03, 0.0075, 0.01]]}}
contact: {restitution: 0.5, friction: 0.5}
coupling: {fewest_cells_per_diameter: 4}
supplies:
  - {population: 0, rate: 20, region: {lower: [0.010, 0.003, 0.004], upper: [0.014, 0.012, 0.016]}}
sinks:
  - {region: {lower: [0.050, 0, 0], upper: [0.060, 0.015, 0.020]}}
run: {until: 0.5}
output: {series: {every: 0.02}, checkpoint: {every: 0.25, keep: 9}}
analysis:
  transport_rate: {from: 0.1}
  entrainment: {from: 0.1}
"""


SHEAR = """
system: resolved
name: shear
domain:
  size: [0.040, 0.020, 0.020]
  spacing: 1.25e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: {type: moving, velocity: [0.4, 0, 0]}}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, time_step: 2.0e-4}
initial: {fluid: {linear_profile: {upper: 0.020, velocity: [0.4, 0, 0]}}}
gravity: {magnitude: 9.81}
grains:
  - {diameter: 5.0e-3, density: 1050, velocity: [0.06, 0, 0], placement: {positions: [[0.02, 0.01, 0.003]]}}
contact: {restitution: 0.5, friction: 0.5}
coupling: {fewest_cells_per_diameter: 4}
supplies:
  - {population: 0, rate: 500, region: {lower: [0.003, 0.003, 0.004], upper: [0.037, 0.017, 0.016]}}
run: {until: 0.01}
output: {grains: {every: 2.0e-4}}
"""

# Spheres that fall one by one onto a rough floor, at most 45 mm deep: each is still 0.2 s after it has come in.
POUR = """
system: grains
name: pour
domain: {size: [0.02, 0.02, 0.06], spacing: 2.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}}
gravity: {magnitude: 9.8}
grains:
  - {diameter: 4.0e-3, density: 2500, placement: {positions: [[0.01, 0.01, 0.01]]}}
contact: {normal_stiffness: 10000, restitution: 0.3, friction: 0.5, rolling_friction: 0.2, wall_rolling_friction: 0.2}
run: {until: 3, until_at_rest: {largest_speed: 2.0e-3, largest_acceleration: 0.1}}
output: {series: {every: 0.1}}
"""


class TurnoverRun(ProgramTest):
    CASE = DRY

    def checkpoints(self, run):
        return [path.read_bytes() for path in sorted((self.folder / run / "checkpoints").glob("step_*.h5"))]

    def balance(self, run, at_start):
        known = self.series(run)
        there = known["grains"] + known["left_grains"] + known.get("returning_grains", 0.0)
        numpy.testing.assert_array_equal(at_start + known["supplied_grains"], there)
        return known

    def test_dry_grains_and_clumps(self):
        self.run_well("run", self.case, "--out", self.folder / "one")
        known = self.balance("one", 45)
        # 300 spheres/s, the 60th of which is due at the end and would come in with the next step; clumps of 0.01 kg/s
        # in 0.18 s; none waits for a place for long.
        two_spheres = 2 * numpy.pi / 6 * 3e-3 ** 3
        lens = numpy.pi / 12 * (4 * 1.5e-3 + 2e-3) * (2 * 1.5e-3 - 2e-3) ** 2
        clumps = 0.01 * 0.18 / (2650 * (two_spheres - lens))
        self.assertEqual(known["supplied_grains"][-1], 59 + int(clumps))
        self.assertGreater(known["left_grains"][-1], 10)
        self.assertLess(known["supply_lag"].max(), 0.01)
        # The first 40 spheres are as many small as large ones; of the 19 that follow, drawn from as many again, 9.5 with
        # a deviation of 1.6.
        small, large = (2650 * numpy.pi / 6 * d ** 3 for d in (3e-3, 5e-3))
        clump_mass = 0.01 * 0.18 / clumps
        self.assertAlmostEqual(known["supplied_mass"][-1], 29.5 * (small + large) + int(clumps) * clump_mass,
                               delta=3 * 1.6 * (large - small))
        reference = self.checkpoints("one")
        self.run_well("run", self.case, "--out", self.folder / "three", ranks=3)
        self.assertEqual(self.checkpoints("three"), reference)
        self.run_well("run", self.case, "--out", self.folder / "again", "--restart",
                      sorted((self.folder / "one/checkpoints").glob("step_*.h5"))[0], ranks=2)
        self.assertEqual(self.checkpoints("again")[-1], reference[-1])

    def test_a_feed_onto_the_bed(self):
        # Spheres and clumps within 6 mm of the bed, whose level rises meanwhile; slowly, so that they land softly.
        above = ["supplies.0.above_bed={lower: 0.0025, upper: 0.0055}", "supplies.1.above_bed={upper: 0.006}"]
        settings = ["--set", "sinks=[]"]
        for n in (0, 1):
            settings += ["--set", f"supplies.{n}.region={{lower: [0.01, 0.01, 0], upper: [0.05, 0.02, 0.075]}}",
                         "--set", f"supplies.{n}.velocity=[0, 0, -0.2]", "--set", above[n]]
        self.run_well("run", self.case, "--out", self.folder / "one", *settings)
        known = self.balance("one", 45)
        self.assertGreaterEqual(known["supplied_grains"][-1], 59)
        self.assertLess(known["supply_lag"].max(), 0.02)
        # Nothing that is fed falls by more than 6 mm and a diameter, to (0.2^2 + 2 g h)^(1/2) = 0.51 m/s.
        self.assertLess(known["largest_grain_speed"][-5:].max(), 0.55)
        self.run_well("run", self.case, "--out", self.folder / "three", *settings, ranks=3)
        self.assertEqual(self.checkpoints("three"), self.checkpoints("one"))
        self.run_well("run", self.case, "--out", self.folder / "again", *settings, "--restart",
                      sorted((self.folder / "one/checkpoints").glob("step_*.h5"))[0], ranks=2)
        self.assertEqual(self.checkpoints("again")[-1], self.checkpoints("one")[-1])
        self.assert_refused("run", self.case, "--out", self.folder / "other", *settings, "--set",
                            "supplies.0.above_bed.upper=0.006", "--restart", self.folder / "one",
                            words=["supplies.0.above_bed.upper = 0.006: the run to be continued has 0.0055"])

    def test_a_stream_is_fed_onto_its_bed(self):
        # A bare floor, and water that carries off what is fed.
        case = self.folder / "stream.yaml"
        case.write_text(STREAM)
        settings = ["--set", "supplies.0.region.lower=[0.008, 0.003, 0]",
                    "--set", "supplies.0.above_bed={lower: 0.0026, upper: 0.004}",
                    "--set", "supplies.0.region.upper=[0.016, 0.012, 0.018]", "--set", "supplies.0.rate=40",
                    "--set", "run.until=0.6", "--set", "output.checkpoint.every=0.3"]
        self.run_well("run", case, "--out", self.folder / "one", *settings)
        self.assertGreaterEqual(self.balance("one", 2)["supplied_grains"][-1], 20)
        self.run_well("run", case, "--out", self.folder / "two", *settings, ranks=2)
        self.assertEqual(self.checkpoints("two"), self.checkpoints("one"))
        self.run_well("run", case, "--out", self.folder / "again", *settings, "--restart",
                      sorted((self.folder / "one/checkpoints").glob("step_*.h5"))[0])
        self.assertEqual(self.checkpoints("again")[-1], self.checkpoints("one")[-1])

    def test_a_stream_carries_grains_from_supply_to_sink(self):
        case = self.folder / "stream.yaml"
        case.write_text(STREAM)
        self.run_well("run", case, "--out", self.folder / "one")
        known = self.balance("one", 2)
        self.assertEqual(known["supplied_grains"][-1], 9)   # the tenth is due at the end
        # At 0.2 m/s the water takes the first ones through the 36 mm to the sink in 0.18 s.
        self.assertGreaterEqual(known["left_grains"][-1], 5)
        reference = self.checkpoints("one")
        self.run_well("run", case, "--out", self.folder / "two", ranks=2)
        self.assertEqual(self.checkpoints("two"), reference)
        self.run_well("run", case, "--out", self.folder / "again", "--restart",
                      sorted((self.folder / "one/checkpoints").glob("step_*.h5"))[0])
        self.assertEqual(self.checkpoints("again")[-1], reference[-1])

    def test_grains_come_in_with_the_velocity_of_the_fluid_there(self):
        # A shear of 20/s, in which grains nearly as light as the fluid appear every 2 ms at random heights.
        (self.folder / "shear.yaml").write_text(SHEAR)
        for ranks in (0, 4):
            self.run_well("run", "shear.yaml", "--out", f"on_{ranks}", ranks=ranks)
            known, heights = {0}, []
            for frame in thalweg.Run(self.folder / f"on_{ranks}").grains:
                for n in numpy.flatnonzero(~numpy.isin(frame.arrays["id"], list(known))):
                    known.add(frame.arrays["id"][n])
                    heights.append(frame.position[n, 2])
                    # The velocity is that in the middle of the cell, off by half a cell of shear at most; the step until
                    # the frame brings the grain nearer to that of the fluid around it, by no more than this again.
                    numpy.testing.assert_allclose(frame.velocity[n], [20 * heights[-1], 0, 0], atol=20 * 1.25e-3)
            self.assertEqual(len(heights), 4)
            self.assertGreater(numpy.ptp(heights), 5e-3)   # 0.1 m/s from one another

    def test_a_transport_rate_is_a_volume_of_the_grains_that_come_in(self):
        # A small and a large sphere in turn; q* is scaled with the large one, which has more than half of the volume.
        (self.folder / "shear.yaml").write_text(SHEAR)
        q_star, until, sizes = 6.0, 0.03, (4.0e-3, 5.0e-3)
        settings = ["--set", f"run.until={until}", "--set", "supplies.0.rate=null", "--set",
                    f"supplies.0.transport_rate={q_star}", "--set", "output.series.every=0.01", "--set",
                    "grains=[{count: 2, diameter: {sizes: [4.0e-3, 5.0e-3], fractions: [0.5, 0.5]}, density: 1050, "
                    "velocity: [0.06, 0, 0], placement: {pattern: random, region: {lower: [0, 0, 0], "
                    "upper: [0.04, 0.02, 0.006]}}}]"]
        self.run_well("run", "shear.yaml", "--out", "run", *settings)
        unit = (0.05 * 9.81 * sizes[1] ** 3) ** 0.5   # m^2/s
        small, large = (numpy.pi / 6 * d ** 3 for d in sizes)
        due = q_star * unit * 0.020 * until   # m^3, over the width of the box
        known = self.series("run")
        self.assertLess(known["supply_lag"].max(), 2.0e-4)   # each comes in with the step after it is due
        mean = 0.5 * (small + large)
        self.assertGreater(due / mean, 10)
        # The next grain is due within a mean volume and what is due in a step; of an odd number one has no partner.
        self.assertAlmostEqual(known["supplied_mass"][-1] / 1050, due,
                               delta=mean + due * 2.0e-4 / until + 0.5 * (large - small))

    def test_a_stream_that_recirculates_its_grains(self):
        case = self.folder / "stream.yaml"
        case.write_text(STREAM)
        settings = ["--set", "supplies=[]", "--set", "run.until=1.0", "--set", "output.checkpoint.every=0.5", "--set",
                    "sinks.0.recirculation={region: {lower: [0.010, 0.003, 0.004], upper: [0.014, 0.012, 0.016]}}"]
        self.run_well("run", case, "--out", self.folder / "one", *settings)
        known = self.balance("one", 2)
        # Both come in again as soon as they have left, about every 0.2 s.
        self.assertGreaterEqual(known["recirculated_grains"][-1], 6)
        self.assertLessEqual(known["returning_grains"].max(), 1)
        self.assertLess(known["largest_grain_speed"].max(), 0.4)   # twice the water's
        self.run_well("run", case, "--out", self.folder / "two", *settings, ranks=2)
        self.assertEqual(self.checkpoints("two"), self.checkpoints("one"))

    def test_a_stream_whose_inlet_recycles(self):
        # From rest, so that the inlet brings the water to its speed; grains pass through the plane.
        case = self.folder / "stream.yaml"
        case.write_text(STREAM)
        settings = ["--set", "domain.boundaries.x_low.recycling_plane=0.04", "--set", "initial={fluid: {uniform: [0, 0, 0]}}",
                    "--set", "domain.boundaries.bottom=law_of_the_wall"]
        self.run_well("run", case, "--out", self.folder / "one", *settings)
        known = self.balance("one", 2)
        self.assertGreaterEqual(known["left_grains"][-1], 5)
        # The discharge passes every section; a grain, of 0.4 % of the box, takes its share of it along.
        momentum = 1000 * 0.2 * 0.060 * 0.015 * 0.020
        share = 0.004 * known["grains"][-1]
        self.assertAlmostEqual(known["fluid_momentum_x"][-1] / momentum, 1.0 - share, delta=0.01)
        self.run_well("run", case, "--out", self.folder / "two", *settings, ranks=2)
        self.assertEqual(self.checkpoints("two"), self.checkpoints("one"))
        self.run_well("run", case, "--out", self.folder / "again", *settings, "--restart",
                      sorted((self.folder / "one/checkpoints").glob("step_*.h5"))[0])
        self.assertEqual(self.checkpoints("again")[-1], self.checkpoints("one")[-1])

    def test_grains_that_come_in_after_a_restart_without_any_are_shown(self):
        # The two of the start are in the sink at once; the supply begins after the checkpoint at 0.1 s.
        settings = []
        for setting in ("grains=[{count: 2, diameter: 3.0e-3, density: 2650, placement: {pattern: random, region: "
                        "{lower: [0, 0, 0], upper: [0.06, 0.03, 0.02]}}}]", "supplies=[{population: 0, rate: 300, from: 0.12, region: "
                        "{lower: [0.01, 0.01, 0.06], upper: [0.05, 0.02, 0.07]}}]",
                        "sinks=[{region: {lower: [0, 0, 0], upper: [0.06, 0.03, 0.03]}}]"):
            settings += ["--set", setting]
        self.run_well("run", self.case, "--out", self.folder / "one", *settings)
        self.run_well("run", self.case, "--out", self.folder / "again", *settings, "--restart",
                      sorted((self.folder / "one/checkpoints").glob("step_*.h5"))[0])
        known = self.series("one")
        self.assertEqual(known["grains"][numpy.searchsorted(known["time"], 0.1)], 0)
        for run in ("one", "again"):
            frames = thalweg.Run(self.folder / run).grains
            self.assertEqual(len(frames[-1]), known["grains"][-1])
        self.assertGreater(known["grains"][-1], 5)

    def test_a_restart_keeps_supplies_and_sinks(self):
        self.run_well("run", self.case, "--out", self.folder / "one", "--set", "run.until=0.01")
        self.assert_refused("run", self.case, "--out", self.folder / "two", "--restart", self.folder / "one", "--set",
                            "supplies.0.rate=200", words=["supplies.0.rate = 200: the run to be continued has 300"])

    def test_a_restart_keeps_what_the_rate_of_a_supply_depends_on(self):
        # A reference grain of twice the diameter makes the unit of q* 2^(3/2) times as large.
        self.case.write_text(STREAM)
        settings = ["--set", "run.until=0.02", "--set", "supplies.0.rate=null", "--set", "supplies.0.transport_rate=0.1"]
        self.run_well("run", self.case, "--out", self.folder / "one", *settings)
        self.assert_refused("run", self.case, "--out", self.folder / "two", "--restart", self.folder / "one", *settings,
                            "--until", "0.03", "--set", "analysis.reference_diameter=0.01",
                            words=["Supply 0 brings", "set these back"])


class PourRun(ProgramTest):
    CASE = POUR

    def end(self, *settings):
        self.run_well("run", self.case, "--out", self.folder / "run", "--overwrite", *settings)
        self.assertIn("finished, all grains at rest", (self.folder / "run/run.log").read_text())
        return self.summary("run")

    def test_rest_waits_for_the_last_grain_of_a_supply(self):
        summary = self.end("--set", "supplies=[{population: 0, rate: 4, until: 2, "
                                    "region: {lower: [0.005, 0.005, 0.02], upper: [0.015, 0.015, 0.05]}}]")
        self.assertEqual(summary["figures"]["supplied_grains"], 8)
        self.assertGreater(summary["simulated_time"], 2.0)
        self.assertLess(summary["simulated_time"], 2.7)

    def test_rest_waits_for_a_grain_on_its_way_back(self):
        summary = self.end("--set", "grains.0.placement.positions=[[0.017, 0.01, 0.01]]", "--set",
                           "sinks=[{region: {lower: [0.014, 0, 0], upper: [0.02, 0.02, 0.02]}, recirculation: "
                           "{delay: 1, region: {lower: [0.006, 0.008, 0.03], upper: [0.007, 0.012, 0.04]}}}]")
        self.assertEqual(summary["figures"]["recirculated_grains"], 1)
        self.assertEqual(summary["figures"]["grains"], 1)
        self.assertGreater(summary["simulated_time"], 1.0)
        self.assertLess(summary["simulated_time"], 1.7)


program.main()
