#!/usr/bin/env python3
"""Materials and sizes of populations, from the case file to what becomes of the grains.

Called by ctest: material_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest


class MaterialRun(ProgramTest):
    # No gravity: what flies on the straight line between two impacts needs no theory. 400 steps a contact, at which the
    # error of the restitution is below 1e-3 (2.6e-3 at 50 steps and e = 0.93, falling as 1/N; larger at low e).
    CASE = """
system: grains
name: impact
domain: {size: [0.04, 0.02, 0.02], spacing: 1.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}}
gravity: {magnitude: 0.0}
grains:
  - {diameter: 5.0e-3, density: 2550, placement: {positions: [[0.010, 0.01, 0.01]]}, velocity: [0.5, 0, 0]}
  - {diameter: 5.0e-3, density: 2550, placement: {positions: [[0.016, 0.01, 0.01]]}, velocity: [-0.5, 0, 0]}
contact: {restitution: 0.9, attraction: none, friction: 0.0}
run: {until: 3.0e-3, time_step: 5.0e-7}
"""

    def velocities(self, *settings, ranks=0):
        arguments = [a for setting in settings for a in ("--set", setting)]
        self.run_well("run", self.case, "--overwrite", *arguments, ranks=ranks)
        return self.bed()["velocity"]

    def test_two_materials_meet_with_the_geometric_mean_of_their_restitutions(self):
        for first, second, mixed in ((None, None, 0.9), (0.4, None, 0.6), (0.4, 0.9, 0.6), (0.64, 0.25, 0.4)):
            settings = [f"grains.{n}.contact.restitution={e}" for n, e in enumerate((first, second)) if e]
            v = self.velocities(*settings)
            self.assertAlmostEqual(v[1, 0] - v[0, 0], mixed, delta=2e-3)

    def test_friction_of_two_materials_is_the_geometric_mean(self):
        # The first grain comes in at 45 degrees in a sliding impact: mu (1 + e) v_n m/2 of tangential momentum, half
        # the relative speed after (Coulomb all the way: v_t/v_n = 1 > 7/2 mu (1 + e) = 0.665 for mu = 0.1).
        v = self.velocities("grains.0.velocity=[0.5, 0.0, 0.0]", "grains.1.velocity=[-0.5, 1.0, 0.0]",
                            "grains.1.placement.positions=[[0.0150001, 0.01, 0.01]]", "run.until=1.0e-3",
                            "grains.0.contact.friction=0.4", "grains.1.contact.friction=0.025")
        # Turning of the line of centres during the contact (1 m/s for 2e-4 s over 5 mm): 0.04 of either component.
        # The arithmetic mean would give 0.20 in place of 0.095, the harmonic one 0.045, the smaller friction 0.024.
        self.assertAlmostEqual(v[0, 1], 0.1 * (1 + 0.9) * 1.0 / 2, delta=0.04)

    def test_a_liquid_bridge_takes_its_work_from_grains_that_part(self):
        # docs/theory.md, section 4: the pull of Willett et al. (2000) from the touch to where the bridge breaks, and a
        # contact without a loss. The bridge forms in the first sub-step of a contact, in which they move by 3e-8 m of
        # the 2.8e-4 m.
        tension, angle, volume, radius = 0.06, 0.6, 1.0e-11, 2.5e-3
        gap = numpy.linspace(0.0, (1 + angle / 2) * volume ** (1 / 3), 10001)
        s = gap * (radius / volume) ** 0.5
        pull = 2 * numpy.pi * radius * tension * numpy.cos(angle) / (1 + 1.05 * s + 2.5 * s ** 2)
        work = (0.5 * (pull[1:] + pull[:-1]) * numpy.diff(gap)).sum()
        mass = 2550 * numpy.pi / 6 * (2 * radius) ** 3
        before = 1.5 * (4 * work / mass) ** 0.5   # relative; at 1.0 they would stick
        v = self.velocities(
            f"grains.0.velocity=[{before / 2}, 0, 0]", f"grains.1.velocity=[{-before / 2}, 0, 0]",
            "grains.1.placement.positions=[[0.0150001, 0.01, 0.01]]", "run.until=0.03", "contact={restitution: 1.0, "
            f"friction: 0.0, liquid_bridge: {{surface_tension: {tension}, contact_angle: {angle}, volume: {volume}}}}}",
        )
        self.assertAlmostEqual((v[1, 0] - v[0, 0]) / (before ** 2 - 4 * work / mass) ** 0.5, 1.0, delta=2e-3)

    def test_walls_have_their_own_restitution_and_stiffness(self):
        falling = "grains=[{diameter: 5.0e-3, density: 2550, placement: {positions: [[0.01, 0.01, 0.003]]}, " \
                  "velocity: [0, 0, -0.5]}]"
        for walls, restitution in (("{restitution: 0.5}", 0.5), ("{normal_stiffness: 80000}", 0.9), ("{}", 0.9)):
            v = self.velocities(falling, f"contact.walls={walls}")
            self.assertAlmostEqual(v[0, 2], 0.5 * restitution, delta=1e-3)
        # Half way through the contact with a wall four times as stiff the grain has been stopped in half the time:
        # t_c/2 = pi/2 sqrt(m/k) = 1.13e-4 s; it touches after 5e-4 m / 0.5 m/s = 1e-3 s.
        v = self.velocities(falling, "contact={restitution: 1.0}", "contact.walls={normal_stiffness: 80000}",
                            "run.until=1.0720e-3")
        mass = 2550 * numpy.pi / 6 * 5e-3 ** 3
        steps = round(self.summary("run")["steps"]) * 50
        phase = numpy.sqrt(80000 / mass) * (steps * 5e-7 - 1e-3)
        self.assertAlmostEqual(v[0, 2], -0.5 * numpy.cos(phase), delta=1e-3)

    def test_a_mixture_lies_in_the_box_as_asked_for(self):
        mixture = "grains=[{count: 40, diameter: {sizes: [2.0e-3, 3.0e-3], fractions: [0.75, 0.25]}, density: 2550, " \
                  "placement: {pattern: random}}, {count: 20, diameter: {distribution: lognormal, median: 2.0e-3, " \
                  "geometric_deviation: 1.3, minimum: 1.5e-3, maximum: 3.0e-3}, density: 1000}]"
        self.velocities(mixture, "run={until: 1.0e-4}")
        first = (self.folder / "run/bed.h5").read_bytes()
        bed = self.bed()
        radius, density = bed["radius"], bed["density"]
        self.assertEqual(sorted(set(radius[:40])), [1.0e-3, 1.5e-3])
        self.assertEqual((radius[:40] == 1.0e-3).sum(), 30)
        self.assertEqual(len(set(radius[40:])), 20)
        self.assertTrue((radius[40:] >= 0.75e-3).all() and (radius[40:] <= 1.5e-3).all())
        numpy.testing.assert_allclose(density, [2550] * 40 + [1000] * 20, rtol=1e-14)
        self.velocities(mixture, "run={until: 1.0e-4}", ranks=4)
        self.assertEqual((self.folder / "run/bed.h5").read_bytes(), first)

    def test_disks_move_in_their_plane(self):
        disks = ("disks={thickness: 4.0e-3}", "gravity={magnitude: 9.8}", "run={until: 0.02}",
                 "domain.size=[0.04, 0.008, 0.04]",
                 "grains=[{count: 12, diameter: 5.0e-3, density: 2550, placement: {pattern: random}, "
                 "velocity: [0.5, 0, -0.5]}]")
        self.velocities(*disks, ranks=2)
        first = (self.folder / "run/bed.h5").read_bytes()
        with h5py.File(self.folder / "run/bed.h5") as file:
            self.assertTrue((file["grains/position"][:, 1] == 0.004).all())
            self.assertTrue((file["grains/velocity"][:, 1] == 0).all())
            numpy.testing.assert_allclose(file["grains/density"], 2550, rtol=1e-14)
            self.assertEqual(file["bed"].attrs["disk_thickness"], 4e-3)
        self.velocities(*disks)
        self.assertEqual((self.folder / "run/bed.h5").read_bytes(), first)
        # Evenly spread as well; and the transport rate is that of the volume of disks over their thickness: 12 disks of
        # pi d^2/4 at 0.5 m/s over 40 mm.
        self.velocities(*disks[:-1], disks[-1].replace("random", "uniform").replace(", -0.5", ", 0"),
                        "analysis.transport_rate={}", "gravity={magnitude: 0}", "run={until: 1.0e-4}")
        with h5py.File(self.folder / "run/bed.h5") as file:
            self.assertTrue((file["grains/position"][:, 1] == 0.004).all())
        self.assertAlmostEqual(
            self.summary("run")["transport_rate"]["q_s_mean"], 12 * numpy.pi / 4 * 25e-6 * 0.5 / 0.04, delta=1e-12
        )
        (self.folder / "bed.h5").write_bytes(first)
        self.velocities(*disks[:-1], "grains=[{placement: {file: bed.h5}}]", "run={until: 1.0e-4}")
        all_of = [a for setting in disks for a in ("--set", setting)]
        for words, change in (
            (["disks 0.004 m thick", "spheres"], "disks=null"), (["give y: periodic"], "domain.boundaries.y=no_slip"),
            (["gravity.vector", "0 along y"], "gravity={vector: [0, 1, -9.8]}"),
            (["grains.0.velocity", "0 along y"], "grains.0.velocity=[0, 1, 0]"),
            (["grains.0.angular_velocity", "0 along x and z"], "grains.0.angular_velocity=[1, 0, 0]"),
        ):
            start = ["--set", "grains=[{placement: {file: bed.h5}}]"] if change == "disks=null" else []
            self.assert_refused("check", self.case, *all_of, *start, "--set", change, words=words)

    def test_a_moving_floor_rubs_grains_along(self):
        # About the line of contact the angular momentum of a sphere at rest stays zero: it ends rolling at 2/7 of the
        # speed of the floor, after 2 U/(7 mu g) = 13 ms. The friction spring leaves a swing below 1 % (2e-3 as it sets
        # in).
        v = self.velocities(
            "grains=[{diameter: 5.0e-3, density: 2550, placement: {positions: [[0.01, 0.01, 2.5e-3]]}}]",
            "contact={restitution: 0.5, tangential_damping: 0.5}", "gravity={magnitude: 9.8}",
            "domain.boundaries.bottom={type: moving, velocity: [0.2, 0, 0]}", "analysis={wall_forces: {}}",
            "run={until: 0.05, time_step: 4.0e-6}",
        )
        self.assertAlmostEqual(v[0, 0], 0.2 * 2 / 7, delta=0.01 * 0.2)
        # The floor has carried its weight since the bump of the start is damped out; the lid carries nothing.
        weight = 2550 * numpy.pi / 6 * 5e-3 ** 3 * 9.8
        with open(self.folder / "run/series.csv") as series:
            names, *_, last = [line.strip().split(",") for line in series]
        row = dict(zip(names, map(float, last)))
        self.assertAlmostEqual(row["wall_force_bottom_z [N]"] / -weight, 1, delta=1e-6)
        self.assertEqual(row["wall_force_top_z [N]"], 0)
        self.assertNotIn("wall_force_x_low_x [N]", row)   # periodic: no wall

    def test_the_step_must_suit_the_stiffest_contact(self):
        # pi sqrt(m/2/k)/20 is 1.0e-5 s at 20000 N/m.
        self.run_well("check", self.case, "--set", "run.time_step=9.0e-6")
        self.assert_refused("check", self.case, "--set", "run.time_step=9.0e-6", "--set",
                            "grains.1.contact.normal_stiffness=40000", words=["run.time_step", "7.17e-06"])
        self.assert_refused("check", self.case, "--set", "run.time_step=9.0e-6", "--set",
                            "contact.walls.normal_stiffness=80000", words=["run.time_step", "7.17e-06"])
        self.assert_refused("check", self.case, "--set", "run.time_step=9.0e-6", "--set",
                            "grains.0.diameter=4.0e-3", words=["run.time_step", "7.26e-06"])


class OnASlope(ProgramTest):
    # Three spheres that are one body, and slide without rolling where it is steep enough.
    CASE = """
system: grains
name: slide
domain:
  size: [0.02, 0.02, 0.02]
  spacing: 1.0e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
gravity: {magnitude: 9.8, slope: 0.5}
grains:
  - density: 2550
    shape: {clump: [{position: [0, 0, 0], diameter: 5.0e-3}, {position: [6.0e-3, 0, 0], diameter: 5.0e-3},
                    {position: [3.0e-3, 5.0e-3, 0], diameter: 5.0e-3}]}
    orientation: {axis: [0, 0, 1], angle: 0}
    placement: {positions: [[0.01, 0.01, 2.5e-3]]}
contact: {normal_stiffness: 20000, tangential_stiffness: 5714, restitution: 0.5, wall_friction: 0.8}
run: {until: 0.1, time_step: 5.0e-6}
"""

    def test_what_slides_does_so_under_the_share_of_friction_that_is_given(self):
        # Steeper than friction, so that it slides at once, down a slope S with t g (sin - mu cos). It sticks while the
        # springs of its contacts yield and it bumps on the floor, for a millisecond or so.
        slope = 0.9
        for ratio, friction in ((0.25, 0.2), (1.0, 0.8)):
            self.run_well("run", self.case, "--overwrite", "--set", f"gravity.slope={slope}", "--set",
                          f"contact.kinetic_friction_ratio={ratio}")
            time, speed = self.summary("run")["simulated_time"], self.bed()["velocity"][:, 0].mean()
            expected = time * 9.8 * (slope - friction) / (1 + slope ** 2) ** 0.5
            self.assertAlmostEqual(speed, expected, delta=0.02 * 9.8 * time, msg=ratio)


program.main()
