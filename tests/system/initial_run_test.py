#!/usr/bin/env python3
"""Grains of another run as a start: the same as if that run had gone on.

Called by ctest: initial_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from pictures import cell_data
from program import ProgramTest
from thalweg import Run


class InitialRun(ProgramTest):
    CASE = """
system: resolved
name: a few grains in water
domain:
  size: [0.0128, 0.0128, 0.0192]
  spacing: 0.8e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, time_step: 1.0e-4, precision: double}
gravity: {magnitude: 9.8, slope: 0.1}
grains: [{count: 6, diameter: 5.0e-3, density: 2550, placement: {pattern: uniform, region: {lower: [0, 0, 0], upper: [0.0128, 0.0128, 0.012]}}}]
contact: {restitution: 0.5, friction: 0.5, rolling_friction: 0.05}
run: {until: 0.02}
analysis: {wall_forces: {}}
"""
    DRY = """
system: grains
name: a few dry grains
domain: {size: [0.0128, 0.0128, 0.0192], spacing: 0.8e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}}
gravity: {magnitude: 9.8, slope: 0.1}
grains: [{count: 6, diameter: 5.0e-3, density: 2550, placement: {pattern: uniform, region: {lower: [0, 0, 0], upper: [0.0128, 0.0128, 0.012]}}}]
contact: {restitution: 0.5, friction: 0.5, rolling_friction: 0.05}
run: {until: 0.1}
"""

    def grains(self, run):
        bed = self.bed(run)
        return {name: bed[name] for name in ("position", "velocity", "angular_velocity")}

    def assert_goes_on(self, time, *settings, ranks=0):
        """A run begun from the last checkpoint of another ends as that other run does when it is continued."""
        end = self.summary("first")["simulated_time"]
        self.run_well("run", self.case, "--restart", "first", "--until", f"{end + time}", "--out", "continued")
        self.run_well("run", self.case, "--set", "initial.from=first", *settings, "--until", f"{time}", "--out",
                      "begun", ranks=ranks)
        continued, begun = self.grains("continued"), self.grains("begun")
        for name, values in continued.items():
            numpy.testing.assert_array_equal(begun[name], values, err_msg=name)
        return continued

    def test_springs_on_walls_stay_beside_a_new_solid(self):
        self.case.write_text(self.DRY)
        self.run_well("run", self.case, "--out", "first")
        self.assert_goes_on(0.01, "--set", "solids=[{sphere: {centre: [0.0064, 0.0064, 0.018], radius: 0.001}}]")

    def test_grains_and_fluid_go_on(self):
        self.run_well("run", self.case, "--out", "first")
        self.assert_goes_on(0.00505, "--set", "initial.fields=[grains, fluid]", ranks=2)
        # Without the fluid it is another flow.
        self.run_well(
            "run", self.case, "--set", "initial={from: first, fields: [grains]}", "--until", "0.00505", "--out", "alone"
        )
        self.assertGreater(abs(self.grains("alone")["velocity"] - self.grains("continued")["velocity"]).max(), 1e-4)

    def test_dry_grains_go_on_with_their_springs_and_into_a_fluid(self):
        wet = self.folder / "wet.yaml"
        wet.write_text(self.CASE)
        self.case.write_text(self.DRY)
        self.run_well("run", self.case, "--out", "first")
        moved = self.assert_goes_on(0.01)
        self.assertGreater(len(moved["position"]), 5)
        self.run_well(
            "run", wet, "--set", "initial={from: first, fields: [grains]}", "--until", "0.0001", "--out", "wet"
        )
        # A step or two of 1e-4 s at less than 0.25 m/s.
        numpy.testing.assert_allclose(self.grains("wet")["position"], self.grains("first")["position"], atol=5e-5)

    def test_grains_of_another_run_under_a_flow_of_this_one(self):
        self.run_well("run", self.case, "--out", "first")
        begin = ("--set", "initial.from=first", "--set", "initial.fluid.uniform=[0.25, 0, 0]")
        self.run_well(
            "run", self.case, *begin, "--set", "initial.fields=[grains]", "--until", "0.0001", "--out", "flow"
        )
        numpy.testing.assert_allclose(self.grains("flow")["position"], self.grains("first")["position"], atol=5e-5)
        # The first row is the state at the start, up to what gravity along the bed does in half a step of 1e-4 s.
        half_step = 9.8 * numpy.sin(numpy.arctan(0.1)) * 0.5e-4
        self.assertLess(abs(self.series("flow")["largest_fluid_speed"][0] - 0.25), 1.001 * half_step)
        for fields in ("[fluid]", "[grains, fluid]"):
            self.assert_refused("check", self.case, *begin, "--set", f"initial.fields={fields}", words=["given twice"])

    FLOW = """
system: fluid
name: the flow alone
domain:
  size: [0.0128, 0.0128, 0.0192]
  spacing: 0.8e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, time_step: 1.0e-4, precision: double}
gravity: {magnitude: 9.8, slope: 0.1}
initial: {fluid: {uniform: [0.25, 0, 0]}}
run: {until: 0.01}
"""

    def test_grains_of_one_run_and_the_fluid_of_another(self):
        dry, flow = (self.folder / name for name in ("dry.yaml", "flow.yaml"))
        dry.write_text(self.DRY)
        flow.write_text(self.FLOW)
        frames = (
            "--set", "output={grains: {every: 0.01}, fluid: {every: 0.01, fields: [velocity, pressure, grain_id]}}",
        )
        self.run_well("run", dry, "--set", "gravity.slope=0", "--until", "0.3", "--out", "bed")
        self.run_well(
            "run", flow, *frames[:1], "output.fluid={every: 0.01, fields: [velocity, pressure]}", "--out", "flow"
        )
        begin = ("--set", "initial.from={grains: bed, fluid: flow}", "--until", "0.002", *frames)
        for out, ranks in (("one", 1), ("two", 2), ("four", 4)):
            self.run_well("run", self.case, *begin, "--out", out, ranks=ranks)
            self.assert_same_end(out, "one")
        # The grains are those that the bed alone gives, with their springs and so their contact forces ...
        self.run_well("run", self.case, "--set", "initial={from: bed, fields: [grains]}", "--until", "0.002", *frames,
                      "--out", "alone")
        start, alone = (Run(self.folder / out).grains[0] for out in ("one", "alone"))
        for name in ("position", "velocity", "angular_velocity", "contact_force", "contact_stress"):
            numpy.testing.assert_array_equal(start.arrays[name], alone.arrays[name], name)
        numpy.testing.assert_allclose(start.position, self.bed("bed")["position"], atol=1e-15)
        self.assertGreater(abs(start.contact_force[:, :2]).max(), 1e-5)   # N; a grain weighs 1.6e-3
        # ... and around them is the fluid of the other run, which falls under the same slope.
        start, other = (Run(self.folder / out).fluid[which].arrays for out, which in (("one", 0), ("flow", -1)))
        free = start["grain_id"] < 0
        self.assertTrue(0.5 < free.mean() < 1)
        for name in ("velocity", "pressure"):
            numpy.testing.assert_array_equal(start[name][free], other[name][free], name)
        self.assertGreater(other["velocity"][..., 0].max(), 0.2)
        # The saved case is one as well, and says the same.
        self.run_well("run", self.folder / "one/case.yaml", "--out", "again")
        self.assert_same_end("again", "one")

    def test_both_of_the_same_run_are_what_one_source_with_both_fields_is(self):
        self.run_well("run", self.case, "--out", "first")
        ways = {"one": "{from: first, fields: [grains, fluid]}", "each": "{from: {grains: first, fluid: first}}",
                "named": "{from: {run: first}, fields: [grains, fluid]}"}
        for out, initial in ways.items():
            self.run_well("run", self.case, "--set", f"initial={initial}", "--until", "0.002", "--out", out)
            self.assert_same_end(out, "one")

    def test_sources_that_do_not_fit_are_refused_by_check_and_run(self):
        dry, flow = (self.folder / name for name in ("dry.yaml", "flow.yaml"))
        dry.write_text(self.DRY)
        flow.write_text(self.FLOW)
        self.run_well("run", dry, "--until", "0.001", "--out", "bed")
        self.run_well("run", flow, "--until", "0.001", "--out", "flow")
        for initial, words in (
            ("{from: {grains: nowhere, fluid: flow}}", ["case.yaml", "initial.from.grains", "nowhere", "no such file"]),
            ("{from: {grains: bed, fluid: nowhere}}", ["case.yaml", "initial.from.fluid", "nowhere", "no such file"]),
            ("{from: {grains: flow, fluid: flow}}", ["initial.from.grains", "holds no grains"]),
            ("{from: {grains: bed, fluid: bed}}", ["initial.from.fluid", "holds no fluid"]),
            ("{from: {run: bed, fluid: flow}}", ["initial.from.run", "either run"]),
            ("{from: {grains: ''}}", ["initial.from.grains", "give a run folder"]),
            ("{from: {grians: bed}}", ["initial.from.grians", "did you mean initial.from.grains"]),
            ("{from: {grains: bed, fluid: flow}, fields: [grains]}", ["initial.fields", "remove this key"]),
            ("{from: {fluid: flow}, fluid: {uniform: [0.1, 0, 0]}}", ["initial.from", "given twice"]),
        ):
            for command in ("check", "run"):
                self.assert_refused(command, self.case, "--set", f"initial={initial}", words=words)
        for command in ("check", "run"):
            self.assert_refused(command, self.case, "--set", "initial.from={grains: bed}", "--set", "grains.0.count=5",
                                words=["initial.from.grains", "6 grains", "has 5"])
            self.assert_refused(command, self.case, "--set", "initial.from={grains: bed}", "--set",
                                "domain.size=[0.0144, 0.0128, 0.0192]",
                                words=["initial.from.grains", "periodic along x over 0.0128 m", "over 0.0144 m"])
            self.assert_refused(command, dry, "--set", "initial.from={fluid: flow}", words=["initial.from.fluid"])
            self.assert_refused(command, flow, "--set", "initial={from: {grains: bed}}", words=["initial.from.grains"])

    def test_grains_and_flow_go_on_on_a_finer_lattice(self):
        pictures = ("--set", "output={fluid: {every: 0.01, fields: [velocity]}}")
        self.run_well("run", self.case, "--out", "first", *pictures)
        finer = ("--set", "domain.spacing=0.4e-3", "--set", "fluid.time_step=0.4e-4", *pictures, "--until", "0.4e-4",
                 "--set", "initial={from: first, fields: [grains, fluid]}")
        self.run_well("run", self.case, *finer, "--out", "finer")
        self.run_well("run", self.case, *finer, "--out", "on_two", ranks=2)
        self.assert_same_end("finer", "on_two")
        # A step of 4e-5 s at less than 0.25 m/s.
        numpy.testing.assert_allclose(self.grains("finer")["position"], self.grains("first")["position"], atol=1e-5)
        before, after = (cell_data(sorted((self.folder / out / "fluid").glob("*.vti"))[-1 if out == "first" else 0])
                         ["velocity"].astype(float) for out in ("first", "finer"))
        # Means over the box: interpolation keeps them but for the half cells next to the walls and what grains cover.
        self.assertGreater(abs(before).max(), 0.01)
        numpy.testing.assert_allclose(
            after.mean(axis=(0, 1, 2)), before.mean(axis=(0, 1, 2)), atol=0.05 * abs(before).mean()
        )

    def test_grains_that_are_taken_must_be_those_of_the_case(self):
        """Else the run would divide the transport of its own grains by the diameter of others."""
        self.case.write_text(self.DRY)
        self.run_well("run", self.case, "--until", "0.001", "--out", "first")
        for key, value, words in (("diameter", "4e-3", ["Grain 0", "0.005 m", "0.004 m", "grains.0", "bed.h5"]),
                                  ("density", "2000", ["mass"]), ("fixed", "true", ["motion"]),
                                  ("contact", "{friction: 0.1}", ["material"])):
            for command, ranks in (("check", 0), ("run", 0), ("run", 2)):
                self.assert_refused(
                    command, self.case, "--set", "initial.from=first", "--set", f"grains.0.{key}={value}",
                    words=["initial.from", *words], ranks=ranks,
                )
        # The bed file describes them; a placement that would not fit is not used.
        for placement in (
            "{file: first/bed.h5}", "{pattern: uniform, region: {lower: [0, 0, 0], upper: [0.0128, 0.0128, 0.007]}}",
        ):
            case = self.DRY.replace(
                "placement: {pattern: uniform, region: {lower: [0, 0, 0], upper: [0.0128, 0.0128, 0.012]}}",
                f"placement: {placement}",
            )
            if "file" in placement:
                case = case.replace("count: 6, diameter: 5.0e-3, density: 2550, ", "")
            self.case.write_text(case)
            self.run_well("run", self.case, "--set", "initial.from=first", "--until", "0.001", "--out", "then",
                          "--overwrite", ranks=2)
            self.assertEqual(self.summary("then")["reference_diameter"], 5e-3)

    def test_what_does_not_fit_is_refused(self):
        self.case.write_text(self.DRY)
        self.run_well("run", self.case, "--until", "0.001", "--out", "first")
        begin = ("--set", "initial.from=first", "--out", "never")
        self.assert_refused("run", self.case, *begin, "--set", "grains.0.count=5", words=["6 grains", "has 5"])
        self.assert_refused("run", self.case, *begin, "--set", "grains.0.motion={}", words=["rigid populations"])
        self.assert_refused("run", self.case, *begin, "--set", "initial.fields=[fluid]", words=["initial.fields"])
        self.assert_refused("check", self.case, "--set", "initial.from=nowhere", words=["initial.from", "nowhere"])


if __name__ == "__main__":
    program.main(side_by_side=True)
