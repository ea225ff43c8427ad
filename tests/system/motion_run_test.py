#!/usr/bin/env python3
"""Walls and rigid populations that move, from the case file to the forces on them.

Called by ctest: motion_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest

WEIGHT = 9.8 * 2550 * numpy.pi / 6 * 5e-3 ** 3


class MotionRun(ProgramTest):
    # A lift: a plate of nine glued grains rises at 0.02 m/s with a grain in the dimple at its middle; beside it a floor
    # that swings and a slanted plane.
    CASE = """
system: grains
name: lift
domain:
  size: [0.04, 0.03, 0.04]
  spacing: 1.0e-3
  boundaries:
    x: no_slip
    y: no_slip
    bottom: {type: moving, velocity: [0, 0, 0], oscillation: {amplitude: [0, 0, 1.0e-3], frequency: 20}}
    top: no_slip
walls:
  - {point: [0.025, 0, 0], normal: [-1, 0, 1], friction: 0.1}
gravity: {magnitude: 9.8}
grains:
  - diameter: 5.0e-3
    density: 2550
    placement:
      positions: [[0.006, 0.011, 0.01], [0.010, 0.011, 0.01], [0.014, 0.011, 0.01],
                  [0.006, 0.015, 0.01], [0.010, 0.015, 0.01], [0.014, 0.015, 0.01],
                  [0.006, 0.019, 0.01], [0.010, 0.019, 0.01], [0.014, 0.019, 0.01]]
    motion: {velocity: [0, 0, 0.02]}
  - {diameter: 5.0e-3, density: 2550, placement: {positions: [[0.012, 0.013, 0.0146]]}}
contact: {restitution: 0.3, friction: 0.5, rolling_friction: 0.1}
run: {until: 0.4}
output: {series: {every: 0.02}}
analysis: {population_loads: {}, wall_forces: {}}
"""

    def test_a_lift_carries_its_grain_and_feels_its_weight(self):
        self.run_well("run", self.case, "--set", "walls=[]")
        bed = self.bed()
        position, velocity = bed["position"], bed["velocity"]
        time = self.summary("run")["simulated_time"]
        numpy.testing.assert_allclose(position[:9, 2], 0.01 + 0.02 * time, atol=1e-15)
        # In the dimple: diagonal of the 4 mm square over 2 beside it, up to the overlaps of a weight over 20 kN/m.
        self.assertAlmostEqual(position[9, 2] - position[0, 2], numpy.sqrt(25 - 8) * 1e-3, delta=1e-6)
        self.assertAlmostEqual(velocity[9, 2], 0.02, delta=1e-5)
        series = self.series()
        self.assertAlmostEqual(series["grains_0_contact_force_z"][-1], -WEIGHT, delta=1e-2 * WEIGHT)
        self.assertAlmostEqual(series["grains_1_contact_force_z"][-1], WEIGHT, delta=1e-2 * WEIGHT)
        # About the middle of the box, 20 and 15 mm along x and y: the weight at 12 and 13 mm.
        self.assertAlmostEqual(series["grains_0_contact_torque_x"][-1], 0.002 * WEIGHT, delta=1e-2 * 0.002 * WEIGHT)
        self.assertAlmostEqual(series["grains_0_contact_torque_y"][-1], -0.008 * WEIGHT, delta=1e-2 * 0.008 * WEIGHT)

    def test_a_restart_finds_walls_and_plate_where_they_were(self):
        loose = "grains.1.placement.positions=[[0.012, 0.013, 0.0146], [0.03, 0.015, 0.01], [0.02, 0.015, 0.03]]"
        swinging = ("walls=[{point: [0.025, 0, 0], normal: [-1, 0, 1], friction: 0.1}, {point: [0.02, 0.015, 0.027], "
                    "normal: [0, 0, 1], velocity: [-0.1, 0, 0], oscillation: {amplitude: [0, 0, 1.0e-3], "
                    "frequency: 30}, plate: {length: 0.01, width: 0.02}}]")
        whole = ["--set", loose, "--set", swinging, "--set", "run.until=0.05"]
        self.run_well("run", self.case, *whole)
        half = [a.replace("0.05", "0.023") if a.startswith("run.until") else a for a in whole]
        self.run_well("run", self.case, *half, "--out", "half")
        self.run_well("run", self.case, *whole, "--restart", "half", "--out", "rest", ranks=2)
        self.assertEqual((self.folder / "run/bed.h5").read_bytes(), (self.folder / "rest/bed.h5").read_bytes())
        # What lay on the swinging floor has been thrown about, and has not passed the slanted plane.
        position = self.bed()["position"]
        height = (position[10, 2] - (position[10, 0] - 0.025)) / numpy.sqrt(2)
        self.assertGreater(height, 2.4e-3)

    def test_a_plate_bears_a_grain_and_another_falls_past_its_edge(self):
        plate = (
            "walls=[{point: [0.03, 0.015, 0.02], normal: [0, 0, 1], plate: {along: [0, 1, 0], length: 0.012, width:"
            " 0.008}}]"
        )
        # Past the edge by more than a radius, on the side where the plate reaches 4 mm.
        places = "grains.1.placement.positions=[[0.03, 0.015, 0.0226], [0.0231, 0.015, 0.0226]]"
        still = "domain.boundaries.bottom=no_slip"
        self.run_well("run", self.case, "--set", plate, "--set", places, "--set", still)
        position = self.bed()["position"]
        self.assertAlmostEqual(position[9, 2], 0.0225 - WEIGHT / 20000.0, delta=1e-8)
        self.assertLess(position[10, 2], 0.0175)  # below the plate's edge by more than its radius
        self.assertAlmostEqual(self.series()["wall_force_wall_0_z"][-1], -WEIGHT, delta=1e-3 * WEIGHT)

    def test_a_grain_faster_than_ten_sub_steps_of_its_list_flies_on(self):
        # 40 m/s over 10 sub-steps of 4.1 us are more than half the skin of 2.5 mm: the list is made anew more often.
        flying = ("grains=[{diameter: 5.0e-3, density: 2550, velocity: [40, 0, 0], placement: {positions: "
                  "[[0.01, 0.015, 0.03]]}}]")
        periodic = "domain.boundaries.x=periodic"
        self.run_well("run", self.case, "--set", flying, "--set", periodic, "--set", "walls=[]",
                      "--set", "analysis={}", "--set", "run.until=0.03", ranks=2)
        time = self.summary("run")["simulated_time"]
        position = self.bed()["position"]
        self.assertAlmostEqual(position[0, 0], (0.01 + 40 * time) % 0.04, delta=1e-12)
        self.assertAlmostEqual(position[0, 2], 0.03 - 4.9 * time ** 2, delta=1e-12)

    def test_what_cannot_be_is_refused(self):
        self.assert_refused(
            "check", self.case, "--set", "walls.0.normal=[0, 0, 0]", words=["walls.0.normal", "[0, 0, 1]"]
        )
        self.assert_refused(
            "check", self.case, "--set", "walls.0.plate={length: 0.01}", words=["walls.0.plate", "width"]
        )
        self.assert_refused("check", self.case, "--set", "walls.0.plate={length: 0.01, width: 0.01}",
                            words=["walls.0.plate.along", "right angles to normal"])
        self.assert_refused(
            "check", self.case, "--set", "grains.0.fixed=true", words=["grains.0.motion", "remove fixed"]
        )
        self.assert_refused("check", self.case, "--set", "grains.0.motion.oscillation={amplitude: [0, 0, 1]}",
                            words=["frequency"])
        self.assert_refused("run", self.case, "--set", "grains.0.motion.velocity=[0, 0, 40]",
                            words=["40 m/s", "half the skin"])


if __name__ == "__main__":
    program.main()
