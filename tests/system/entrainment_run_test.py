#!/usr/bin/env python3
"""Starts of grains in a whole run: the same events on any ranks and after a restart, a run that does not notice, and
torques about the hinge that are those of the forces.

Called by ctest: entrainment_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
import thalweg
from program import ProgramTest

D, DX = 4.8e-3, 0.8e-3   # m


def bed():
    """A staggered layer of fixed grains, rows of four across the flow, and above it two proud grains in its pockets,
    each on one grain upstream (at a distance X along x) and two downstream."""
    pitch = 5 * DX
    rows = [[(r + 0.5) * pitch, (k + 0.5 + 0.5 * (r % 2)) * D % (4 * D), 0.5 * D] for r in range(6) for k in range(4)]
    x = (pitch**2 + D**2 / 4) / (2 * pitch)
    height = 0.5 * D + 1.0002 * (D**2 - x**2) ** 0.5
    return rows, [[0.5 * pitch + x, 0.5 * D, height], [2.5 * pitch + x, 2.5 * D, height]]


FIXED, PROUD = bed()


class EntrainmentRun(ProgramTest):
    CASE = f"""
system: resolved
name: proud grains
domain:
  size: [{30 * DX}, {24 * DX}, {20 * DX}]
  spacing: {DX}
  boundaries: {{x: periodic, y: periodic, bottom: no_slip, top: free_slip}}
fluid: {{density: 1000, kinematic_viscosity: 1.0e-6, smagorinsky_constant: 0.27, time_step: 1.0e-4, collision: bgk}}
gravity: {{magnitude: 9.8, slope: 0.12}}
grains:
  - {{count: {len(FIXED)}, diameter: {D}, density: 2000, fixed: true, placement: {{positions: {FIXED}}}}}
  - {{count: 2, diameter: {D}, density: 2000, placement: {{positions: {PROUD}}}}}
contact: {{normal_stiffness: 20000, tangential_stiffness: 5714, restitution: 0.5, friction: 0.5, wall_friction: 0.45}}
coupling: {{grain_steps_per_fluid_step: 20}}
run: {{until: 0.135}}
output:
  series: {{every: 0.01}}
  checkpoint: {{every: 0.06, keep: 9}}
analysis:
  entrainment: {{memory: 0.1, rest_time: 0.005, refresh: 0.05}}
"""

    def events(self, run):
        """By name: attributes and arrays."""
        return {
            name: (event.attributes, dict(event)) for name, event in thalweg.Run(self.folder / run).entrainment.items()
        }

    def files_of(self, run):
        return {
            path.name: path.read_bytes()
            for pattern in ("entrainment/*", "series.csv")
            for path in (self.folder / run).glob(pattern)
        }

    def assert_same_events(self, a, b):
        self.assertEqual(list(self.events(a)), list(self.events(b)))
        for name, (attributes, arrays) in self.events(a).items():
            others, other_arrays = self.events(b)[name]
            self.assertEqual(attributes.keys(), others.keys())
            for key, value in attributes.items():
                numpy.testing.assert_array_equal(value, others[key], f"{name} {key}")
            self.assertEqual(arrays.keys(), other_arrays.keys())
            for key, values in arrays.items():
                self.assertEqual(values.tobytes(), other_arrays[key].tobytes(), f"{name} {key}")

    def test_starts_on_any_ranks_and_after_restarts(self):
        self.run_well("run", self.case, "--out", "one", ranks=1)
        events = self.events("one")
        self.assertGreaterEqual(len(events), 2)   # both proud grains
        for ranks in (2, 4):
            self.run_well("run", self.case, "--out", f"on_{ranks}", ranks=ranks)
            self.assertEqual(self.files_of(f"on_{ranks}"), self.files_of("one"))
            self.assert_same_end(f"on_{ranks}", "one")
            self.assertEqual(self.summary(f"on_{ranks}")["entrainment"], self.summary("one")["entrainment"])
        for out, step in (
            ("one", 600), ("on_2", 1200),
        ):  # what comes later once more, in the same folder: no event twice
            self.run_well("run", self.case, "--out", out, "--restart",
                          self.folder / out / f"checkpoints/step_{step}.h5", ranks=2)
            self.assert_same_events(out, "on_4")
            self.assert_same_end(out, "on_4")
            self.assertEqual(self.summary(out)["entrainment"], self.summary("on_4")["entrainment"])
        self.check_events(events)

    def check_events(self, events):
        weight = 1000 * numpy.pi / 6 * D**3 * 9.8
        tilt = numpy.arctan(0.12)
        firsts = {}
        for attributes, arrays in events.values():
            firsts.setdefault(int(arrays["id"][0]), (attributes, arrays))
        self.assertEqual(sorted(firsts), [24, 25])
        for attributes, arrays in firsts.values():
            proud = PROUD[int(arrays["id"][0]) - 24]
            numpy.testing.assert_allclose(arrays["rest_position"], proud, atol=0.02 * D)
            numpy.testing.assert_allclose(
                arrays["submerged_weight"], weight * numpy.array([2 * numpy.sin(tilt), 0, -numpy.cos(tilt)]),
                rtol=1e-12, atol=1e-12,
            )
            way = arrays["position"][-1] - arrays["rest_position"]
            self.assertGreater(numpy.linalg.norm(way), 0.1 * D)   # as little beyond as it goes in a step
            self.assertLess(numpy.linalg.norm(arrays["position"][-2] - arrays["rest_position"]), 0.1 * D)
            self.assertGreater(way[0], 0.0)
            self.assertAlmostEqual(arrays["time"][-1] - arrays["time"][0], 0.1, delta=1.01e-4)
            numpy.testing.assert_allclose(numpy.diff(arrays["time"]), 1e-4, rtol=1e-9)
            self.assertEqual(arrays["time"][-1], attributes["time"])
            # It rolls over the two grains downstream, about an axis across the flow through the points where it touches
            # them.
            numpy.testing.assert_allclose(arrays["hinge_axis"], (0, 1, 0), atol=0.05)
            for partner, point in zip(arrays["hinge_partners"], arrays["hinge_points"]):
                middle = 0.5 * (numpy.array(proud) + FIXED[partner])
                middle[1] += 2 * D * numpy.round((proud[1] - FIXED[partner][1]) / (4 * D))
                numpy.testing.assert_allclose(point, middle, atol=0.03 * D)
                self.assertGreater(point[0], proud[0])
            # The torques once more, from the arrays.
            arm = arrays["position"] - arrays["hinge_points"][1]
            axis = arrays["hinge_axis"]
            couple = arrays["fluid_couple"] @ axis
            fluid = numpy.cross(arm, arrays["fluid_force"]) @ axis + couple
            numpy.testing.assert_allclose(arrays["fluid_torque"], fluid, rtol=1e-9, atol=1e-15)
            numpy.testing.assert_allclose(arrays["couple_torque"], couple, rtol=1e-12, atol=1e-18)
            numpy.testing.assert_allclose(arrays["critical_torque"],
                                          -(numpy.cross(arm, arrays["submerged_weight"]) @ axis), rtol=1e-9, atol=1e-15)
            resting = arrays["time"] <= attributes["onset_time"]
            self.assertAlmostEqual(attributes["couple_share"], couple[resting].sum() / fluid[resting].sum(), delta=1e-9)
            # What moves it: the fluid's torque outweighs that of the weight, and from all that acts on it comes its
            # motion.
            self.assertGreater(attributes["largest_torque_ratio"], 1.0)
            mass = 2000 * numpy.pi / 6 * D**3
            force = arrays["fluid_force"] + arrays["contact_force"] + arrays["submerged_weight"]
            gained = mass * (arrays["velocity"][-1] - arrays["velocity"][0])
            given = 1e-4 * force.sum(axis=0)
            numpy.testing.assert_allclose(given, gained, atol=0.05 * numpy.linalg.norm(gained))
            # Contacts: their forces add up to the contact force of every sample, but for the dashpot, which has half a
            # sub-step less of the grain's acceleration in it there: 0.46 kg/s (restitution 0.5) * 9.8 m/s^2 * 2.5e-6 s
            # = 0.02 W.
            added = numpy.zeros_like(arrays["contact_force"])
            numpy.add.at(added, arrays["contact_sample"], arrays["contact_force_each"])
            numpy.testing.assert_allclose(added, arrays["contact_force"], atol=0.02 * weight)

    def test_the_run_does_not_notice(self):
        self.run_well("run", self.case, "--out", "watched", "--until", "0.02")
        self.run_well("run", self.case, "--out", "alone", "--until", "0.02", "--set", "analysis={}")
        self.assert_same_state("watched", "alone")

    def test_a_restart_before_the_first_look_leaves_no_trace(self):
        later = ["--set", "analysis.entrainment.from=0.008", "--set", "output.checkpoint.every=0.01"]
        self.run_well("run", self.case, *later, "--out", "straight", "--until", "0.01")
        self.run_well("run", self.case, *later, "--out", "half", "--until", "0.005")
        self.run_well("run", self.case, *later, "--out", "half", "--restart", "half", "--until", "0.01")
        self.assertNotIn("since", self.summary("half")["entrainment"])
        self.assert_same_end("half", "straight")

    def test_starts_of_another_definition_are_counted_anew(self):
        self.run_well("run", self.case, "--out", "run", "--until", "0.005")
        self.run_well("run", self.case, "--out", "same", "--restart", "run", "--until", "0.01")
        self.assertNotIn("since", self.summary("same")["entrainment"])
        for setting in ("entrainment.displacement=0.2", "reference_diameter=4.0e-3"):
            said = self.run_well(
                "run", self.case, "--set", "analysis." + setting, "--out", "other", "--restart", "run", "--until",
                "0.01", "--overwrite",
            ).stdout
            self.assertIn("analysis.entrainment: averaging starts at 0.005 s", said)
            self.assertEqual(self.summary("other")["entrainment"]["since"], 0.005)

    def test_what_cannot_be_watched_is_refused(self):
        self.assert_refused("run", self.case, "--set", "analysis.entrainment.grains=[26]",
                            words=["analysis.entrainment.grains.0", "ids from 0 to 25"])
        self.assert_refused(
            "run", self.case, "--set", "run.ramp=0.1", words=["analysis.entrainment.from", "run.ramp, 0.1 s"]
        )
        self.assert_refused("run", self.case, "--set", "domain.boundaries.bottom=periodic", "--set",
                            "domain.boundaries.top=periodic", words=["analysis.entrainment", "name the grains"])
        self.assert_refused(
            "run", self.case, "--set", "grains=[]", words=["analysis.entrainment", "no grains to watch"]
        )


if __name__ == "__main__":
    program.main()
