#!/usr/bin/env python3
"""What --solve prints, and every remedy that `thalweg check` prints, pasted as it is printed: the case is accepted, the
warning is gone, no other is new, and what the remedy does not name is as it was.

Called by ctest: remedies_test.py THALWEG MPIEXEC [unittest arguments]
"""
import re
import shlex
import sys
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest

CASES = Path(__file__).resolve().parents[2] / "cases"

# Gravel of a sieve curve, four layers under a slope.
GRAVEL = """
system: resolved
domain: {size: [0.08, 0.04, 0.036], spacing: 1.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, time_step: 1.0e-4}
gravity: {magnitude: 9.81, slope: 0.02}
grains:
  - fill: {layers: 4}
    diameter: {sieve: {sizes: [2.0e-3, 2.8e-3, 4.0e-3, 5.6e-3, 8.0e-3], finer: [0, 0.15, 0.5, 0.85, 1]}}
    density: 2650
    placement: {pattern: random, seed: 1}
contact: {restitution: 0.5}
run: {until: 1.0}
"""

# 150 glass spheres of ten cells in water.
WATER = """
system: resolved
domain: {size: [0.06, 0.02, 0.04], spacing: 0.5e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, time_step: 4.0e-5}
gravity: {magnitude: 9.8, slope: 0.01}
grains: [{count: 150, diameter: 5.0e-3, density: 2550, placement: {pattern: uniform, seed: 1}}]
contact: {normal_stiffness: 600, tangential_stiffness: 171, restitution: 0.93}
run: {until: 30}
output: {series: {every: 0.01}}
"""

COLUMN = (CASES / "continuum/case.yaml").read_text()

# Water that goes round in an open reach.
STREAM = """
system: fluid
domain:
  size: [0.3, 0.02, 0.04]
  spacing: 1.0e-3
  boundaries:
    x_low: {type: velocity_inlet, velocity: [0.3, 0, 0], recycling_plane: 0.15}
    x_high: pressure_outlet
    y: periodic
    bottom: no_slip
    top: free_slip
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, time_step: 1.0e-4}
gravity: {magnitude: 9.8}
run: {until: 30}
output: {series: {every: 0.01}}
"""

# A suspension of spheres of six cells in oil.
SUSPENSION = """
system: resolved
domain: {size: [0.0048, 0.0048, 0.0048], spacing: 1.0e-4, boundaries: {x: periodic, y: periodic, bottom: periodic, top: periodic}}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, time_step: 1.6e-5, collision: trt}
gravity: {vector: [0, 0, -9.81], mode: balanced}
grains: [{solid_fraction: 0.25, density: 1250, diameter: 6.0e-4, placement: {pattern: dense, seed: 1}}]
contact: {normal_stiffness: 0.5, tangential_stiffness: 0.15, restitution: 0.5}
coupling: {links: cli, grain_steps_per_fluid_step: auto, lubrication: {minimum_gap: 0.01}}
run: {until: 0.06}
"""

# Spheres in oil under a lid.
OIL = """
system: resolved
domain:
  size: [0.03, 0.01, 0.02]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: {type: moving, velocity: [0.02, 0, 0]}}
fluid: {density: 900, kinematic_viscosity: 1.0e-4, subgrid_model: none, time_step: 1.0e-4, collision: trt}
gravity: {magnitude: 9.8}
grains: [{count: 30, diameter: 4.0e-3, density: 1200, placement: {pattern: uniform, seed: 1}}]
contact: {normal_stiffness: 5, tangential_stiffness: 1.5, restitution: 0.9}
coupling: {links: cli}
run: {until: 20}
"""

CLEAR = ["system=fluid", "grains=null", "contact=null"]   # of the case in water

DRY = """
system: grains
domain: {size: [0.06, 0.02, 0.06], spacing: 1.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}}
gravity: {magnitude: 9.8, slope: 0.1}
grains:
  - {count: 150, diameter: 5.0e-3, density: 2550, placement: {pattern: random, seed: 3}}
  - {count: 20, diameter: 4.0e-3, density: 4000, placement: {pattern: random, seed: 4},
     contact: {normal_stiffness: 1000, damping: 0.02}}
contact: {normal_stiffness: 2000, tangential_stiffness: 571, damping: 0.03, walls: {normal_stiffness: 4000, damping: 0.05}}
run: {until: 1}
"""

MODEL_FLUID = (CASES / "model_fluid/case.yaml").read_text()

# Text of the case, changes of it, and words of the warnings or the refusal that they bring.
VARIATIONS = [
    (GRAVEL, ["fluid.subgrid_model=none"], ["no subgrid model", "2 cells across", "too short", "too weak"]),
    (GRAVEL, ["domain.spacing=3.3333333333e-4"], ["cells per step"]),
    (GRAVEL, ["coupling.fewest_cells_per_diameter=2", "contact.normal_stiffness=20"], ["would overlap"]),
    (GRAVEL, ["domain.size.2=0.06", "grains.0.placement.pattern=uniform"], ["pattern: random"]),
    (GRAVEL, ["domain.spacing=4.0e-3", "coupling.fewest_cells_per_diameter=0.5"], ["domain.spacing: "]),
    (WATER, ["fluid.time_step=8.0e-5", "gravity.slope=0.03"], ["cells per step", "too weak"]),
    (WATER, ["fluid.time_step=2.0e-6"], ["has not been tested below"]),
    (WATER, ["fluid.time_step=4.0e-6", "gravity.slope=0.2"], ["has not been tested below", "slides as a whole"]),
    (WATER, ["gravity={magnitude: 9.8, slope: 0, mode: full}", "fluid.time_step=1.1e-4"], ["compresses it"]),
    (WATER, ["gravity.slope=0.3"], ["slides as a whole"]),
    (WATER, ["gravity={vector: [2.5, 0, -9.5]}"], ["slides as a whole"]),
    (
        WATER, ["contact={normal_stiffness: 20, tangential_stiffness: 5.71, damping: 0.004}"],
        ["would overlap", "dry restitution"],
    ),
    (
        WATER, ["contact={normal_stiffness: 20000, tangential_stiffness: 5714, damping: 0.09}"],
        ["too weak", "dry restitution"],
    ), (WATER, ["contact={law: hertz_mindlin, youngs_modulus: 2.0e4, restitution: 0.9}"], ["would overlap"]),
    (WATER, ["contact={law: hertz_mindlin, youngs_modulus: 1.0e7, restitution: 0.9}"], ["too weak"]),
    (
        WATER,
        [
            "contact.walls={normal_stiffness: 1200}", "grains.0.contact={tangential_stiffness: 100}",
            "fluid.time_step=8.0e-5",
        ], ["too weak"],
    ), (WATER, ["contact={duration: 6.0e-3, restitution: 0.93}"], ["would overlap", "contact.duration: "]),
    (
        WATER, ["contact={duration: {fluid_steps: 10}, damping: 0.09}"],
        ["too weak", "contact.duration: ", "dry restitution"],
    ),
    (
        WATER, ["contact={duration: 2.0e-4, tangential_stiffness: 3000, restitution: 0.93}", "fluid.time_step=8.0e-5"],
        ["too weak"],
    ),
    (
        WATER,
        [
            "contact={restitution: 0.93}", "domain.size=[0.04, 0.02, 0.2]", "grains.0.count=1000",
            "fluid.time_step=1.0e-4",
        ], ["too weak", "fluid.time_step: "],
    ), (WATER, ["contact={restitution: 0.93}"], []), (WATER, ["grains.0.count=400"], ["placement.pattern: dense"]),
    (WATER, ["fluid.bulk_relaxation_time=100", "gravity.slope=0.02"], ["grows stripes"]),
    (WATER, ["fluid.subgrid_model=none"], ["no subgrid model"]),
    (
        WATER, ["fluid.subgrid_model=none", "fluid.collision=trt", "fluid.bulk_relaxation_time=1"],
        ["no subgrid model", "bulk relaxation time"],
    ), (WATER, ["fluid.smagorinsky_constant=0.27", "fluid.collision=bgk"], []),
    (WATER, ["run.until=0.5"], ["too short"]),
    (
        WATER,
        [
            "run.until=0.1",
            "initial={fluid: {log_profile: {bed_height: 0.0137, shear_velocity: 0.05, roughness: 3.0e-4}}}",
        ], ["shorter than one turnover"],
    ),
    (
        WATER, ["initial={fluid: {log_profile: {bed_height: 0.0137, shear_velocity: 0.02, roughness: 3.0e-4}}}"],
        ["shear velocity"],
    ), (WATER, ["run.ramp=40"], ["Gravity rises"]), (WATER, ["output.series.every=1.0e-5"], ["less than a step"]),
    (WATER, ["domain.spacing=1.0e-3"], ["5 cells across"]),
    (WATER, ["domain.spacing=1.0e-3", "coupling.fewest_cells_per_diameter=1"], []),
    (WATER, ["domain.size=[0.061, 0.021, 0.041]", "domain.spacing=1.0e-3"], ["5 cells across"]),
    (
        WATER,
        ["analysis={transport_rate: {from: 40}, fluid_statistics: {from: 30}, bed_surface: {from: 31}}"],
        [
            "The measurement analysis.transport_rate begins at 40 s, after the end of the run at 30 s, and measures nothing",
            "analysis.fluid_statistics begins at 30 s", "analysis.bed_surface begins at 31 s",
        ],
    ), (WATER, ["grains.0.density=300"], ["no heavier"]),
    (
        WATER, ["coupling={grain_steps_per_fluid_step: 1}", "contact.normal_stiffness=20000"],
        ["grain_steps_per_fluid_step: "],
    ), (WATER, ["gravity.slope=-0.01"], ["towards -x"]), (SUSPENSION, [], []),
    (SUSPENSION, ["grains.0.density=450"], []),
    (SUSPENSION, ["coupling.grain_steps_per_fluid_step=1"], ["lubrication force"]),
    (SUSPENSION, ["fluid.collision=bgk"], ["In a dense bed"]),
    (SUSPENSION, ["fluid.time_step=1.0e-3", "run.until=10"], ["so large"]),
    (SUSPENSION, ["fluid.smagorinsky_constant=0.27"], ["The flow is laminar"]), (OIL, [], []),
    (SUSPENSION, ["fluid.subgrid_model=smagorinsky"], ["The flow is laminar"]),
    (
        OIL,
        [
            "fluid.subgrid_model=smagorinsky", "fluid.smagorinsky_constant=0.1", "fluid.collision=bgk",
            "coupling.links=bouzidi",
        ], ["The flow is laminar"],
    ), (OIL, ["fluid.subgrid_model=qr", "fluid.collision=trt_at_bodies"], []),
    (OIL, ["fluid.collision=bgk"], ["In a dense bed"]), (OIL, ["fluid.time_step=1.0e-6"], ["at no velocity"]),
    (OIL, ["fluid.time_step=5.0e-6", "fluid.bulk_relaxation_time=1"], ["bulk relaxation time"]),
    (OIL, ["fluid.time_step=1.5e-3"], ["so large"]), (OIL, ["run.until=0.1"], ["too short"]), (WATER, CLEAR, []),
    (WATER, [*CLEAR, "fluid.time_step=1.0e-6"], ["has not been tested below"]),
    (WATER, [*CLEAR, "gravity.slope=0.1"], ["cells per step"]), (WATER, [*CLEAR, "run.until=1"], ["too short"]),
    (DRY, ["gravity.slope=0.6"], ["slides as a whole"]),
    (WATER, ["contact.friction=26"], ["an angle in degrees", "contact.friction: 0.488"]),  # tan(26 degrees)
    (WATER, ["grains.0.contact={friction: 26}"], ["grains.0.contact.friction = 26", "grains.0.contact.friction: 0.488"]),
    (WATER, ["fluid.density=1", "grains.0.density=2.65"], ["g/cm^3", "fluid.density: 1000"]),
    (WATER, ["fluid.density=1"], ["looks like one of 1 g/cm^3", "fluid.density: 1000"]),
    (WATER, ["gravity.magnitude=980"], ["looks like 980 cm/s^2, which is 9.8", "gravity.magnitude: 9.8"]),
    (STREAM, [], []),
    (
        STREAM, ["domain.boundaries.x_low.recycling_plane=0.002"],
        ["0.05 depths of the water from the inlet", "domain.boundaries.x_low.recycling_plane: 0.12"],
    ),
    (WATER, ["analysis={transport_rate: {every: 31}}"], ["is made every 31 s", "analysis.transport_rate.every: 0.3"]),
    (
        WATER, ["analysis={transport_rate: {from: 1}}", "output.series.every=0"],
        ["is made with the rows of the series", "analysis.transport_rate.every: 0.3"],
    ),
    (WATER, ["gravity.magnitude=9810"], ["looks like 9810 mm/s^2, which is 9.81", "gravity.magnitude: 9.81"]),
    (
        WATER, ["output={grains: {every: 31}}"],
        ["output.grains.every = 31 s is longer than the run of 30 s", "output.grains.every: 30"],
    ),
    (WATER, ["fluid.kinematic_viscosity=1"], ["looks like 1 mm^2/s", "fluid.kinematic_viscosity: 1e-06"]),
    (WATER, ["gravity={vector: [9.8, 0, -981]}"], ["cm/s^2", "gravity.vector: [0.098, 0, -9.81]"]),
    (
        WATER,
        [
            "grains.0.orientation={axis: [0, 1, 0], angle: 90}", "grains.0.diameter=null", "grains.0.count=40",
            "grains.0.shape={clump: [{position: [0, 0, 0], diameter: 5.0e-3}, {position: [0.002, 0, 0], diameter: 5.0e-3}]}",
        ],
        ["14.3 turns, and looks like an angle in degrees", "grains.0.orientation.angle: 1.5708"],
    ),
    (
        WATER, ["domain.boundaries.bottom=free_slip", "domain.boundaries.top=no_slip"],
        ["look swapped", "consider domain.boundaries.bottom: no_slip and domain.boundaries.top: free_slip"],
    ),
    (
        WATER,
        [*CLEAR, "domain.size=[60, 20, 40]", "domain.spacing=0.5", "fluid.time_step=null"],
        ["looks like millimetres", "domain.spacing: 0.5 mm is 0.0005 m"],
    ),
    (COLUMN, ["grains.diameter=5"], ["The grains are 5 m wide", "5 mm is 0.005 m"]),
    (COLUMN, ["grains.density=2.55", "fluid.density=1"], ["grains.density: 2550 and fluid.density: 1000"]),
    (COLUMN, ["fluid.kinematic_viscosity=1"], ["fluid.kinematic_viscosity: 1e-06"]),
    (WATER, ["gravity.slope=1.15"], ["looks like an angle in degrees", "gravity.slope: 0.0201"]),   # tan(1.15 degrees)
    (WATER, ["grains.0.count=70", "gravity.slope=0.3"], ["slides as a whole"]),   # 1.3 diameters of bed
    (
        WATER, ["domain.size=[0.06, 0.02]", "gravity={magnitude: 9.8}", "flow={shields_number: 0.5, depth: 0.02}"],
        ["slides as a whole", "flow.shields_number: "],
    ),
    (   # the gentler the slope, the deeper the water
        WATER,
        [
            "domain.size=[0.06, 0.02]", "gravity={magnitude: 9.8, slope: 0.3}", "flow={shields_number: 0.3}",
            "fluid.time_step=null",
        ], ["slides as a whole", "gravity.slope: "],
    ),
    (
        WATER,
        [
            "domain.size=[0.06, 0.02]", "gravity={magnitude: 9.8, slope: 0.3}", "flow={shields_number: 0.8}",
            "fluid.time_step=null",
        ], ["slides as a whole", "a smaller flow.shields_number"],
    ),
    (WATER, ["analysis={grain_profiles: {from: 0.1}}"], ["Averages begin before the flow has developed"]),
    (WATER, ["fluid.time_step=null"], []),
    (OIL, ["grains.0.placement.region={lower: [0, 0, 0], upper: [0.02, 0.01, 0.02]}", "run.until=0.01"], []),
    (
        DRY, [
            "contact.normal_stiffness=30", "contact.tangential_stiffness=8.6", "grains.1.contact.normal_stiffness=20",
            "run.time_step=2.8e-5",
        ],
        ["would overlap"],
    ), (DRY, ["grains.0.placement.pattern=uniform", "grains.0.count=600"], ["fewer or smaller grains"]),
    (MODEL_FLUID, ["run.time_step=1.3e-3", "model_fluid.shields_number=2000"], ["a twentieth of a diameter"]),
]

# Warnings whose remedy is for the user to choose: what drives the flow, and what is measured when.
BY_HAND = ("Gravity drives", "The box is periodic", "Walls close", "The measurement")

KEY = r"(?<![\w.])((?:[a-z_]+\.)+[a-z0-9_.]*[a-z0-9_]): (\{[^}]*\}|\[[^\]]*\]|[^\s,]+)"


def remedies_in(text):
    """The alternatives that a sentence gives, each as (key, value) pairs."""
    found = re.split(r": consider |; give |; consider |: (?=accept it with )", text)
    if len(found) == 1:
        return []
    return [pairs for part in found[-1].split(", or ")
            if (pairs := [(key, value.rstrip(".;")) for key, value in re.findall(KEY, part)])]


def kind_of(sentence):
    """The first words of a warning, which tell it from others."""
    return " ".join(re.sub(r"[-+0-9.e]*[0-9][-+0-9.e]*", "#", sentence).split()[:6])


class Report:
    """What check said: its warnings by kind, or its refusal."""

    def __init__(self, result):
        self.accepted = result.returncode == 0
        self.text = result.stdout + result.stderr
        lines = [re.split(r"  +", line, maxsplit=1) for line in result.stdout.splitlines()]
        self.lines = [(line[0], line[1]) for line in lines if len(line) == 2]
        self.warnings = [text for name, text in self.lines if name == "warning"]
        if not self.accepted:
            self.warnings = [result.stderr]
        self.kinds = sorted(kind_of(warning) for warning in self.warnings)

    def all(self, name):
        return [text for own, text in self.lines if own == name]

    def restitution(self):
        return re.findall(r"dry restitution (.*)", self.text)


def number_of(contact, key):
    return float(contact.get(key, {"normal_stiffness": 20000.0, "tangential_stiffness": 5714.0}[key]))


class Remedies(ProgramTest):
    def check(self, path, settings):
        return Report(self.thalweg("check", path, *(word for setting in settings for word in ("--set", setting))))

    def assert_contact_is_kept(self, remedy, before, after, path):
        """The restitution, and of stiffnesses the ratio."""
        if not any("normal_stiffness" in key or "duration" in key for key in remedy):
            return
        self.assertEqual(after.restitution(), before.restitution())
        contact = (yaml.safe_load(path.read_text()).get("contact") or {}) | self.contact
        if "contact.normal_stiffness" in remedy and "contact.tangential_stiffness" in remedy:
            ratio = number_of(contact, "tangential_stiffness") / number_of(contact, "normal_stiffness")
            self.assertAlmostEqual(
                float(remedy["contact.tangential_stiffness"]) / float(remedy["contact.normal_stiffness"]) / ratio, 1.0,
                5,
            )

    def assert_the_rest_is_kept(self, remedy, before, after):
        if not any(key.startswith(("domain", "grains")) for key in remedy):
            deeper = "gravity.slope" in remedy and any("domain.size" in text for text in before.all("follows"))
            for name in ("grains", "reference") if deeper else ("domain", "grains", "reference"):
                self.assertEqual(after.all(name), before.all(name), name)
        if not any(key.startswith(("domain", "gravity", "flow", "fluid.density")) for key in remedy):
            self.assertEqual(after.all("Shields"), before.all("Shields"))
            self.assertEqual(after.all("bed"), before.all("bed"))

    def apply(self, path, settings, warning, pairs, before):
        remedy = dict(pairs)
        after = self.check(path, [*settings, *(f"{key}={value}" for key, value in pairs)])
        self.assertTrue(after.accepted, after.text)
        if not before.accepted:
            return
        gone, left = kind_of(warning), list(after.kinds)
        self.assertLess(left.count(gone), before.kinds.count(gone), after.text)
        for kind in set(left):
            self.assertLessEqual(left.count(kind), before.kinds.count(kind), f"new: {kind}\n{after.text}")
        self.assert_contact_is_kept(remedy, before, after, path)
        self.assert_the_rest_is_kept(remedy, before, after)

    def apply_all(self, path, settings=(), words=()):
        self.contact = {}
        for setting in settings:
            key, value = setting.split("=", 1)
            if key == "contact":
                self.contact = yaml.safe_load(value)
            elif key.startswith("contact."):
                self.contact[key.split(".")[1]] = yaml.safe_load(value)
        before = self.check(path, settings)
        for word in words:
            self.assertIn(word, before.text)
        count = 0
        for warning in before.warnings:
            for pairs in remedies_in(warning):
                with self.subTest(case=path.parent.name, settings=settings, remedy=pairs):
                    self.apply(path, settings, warning, pairs, before)
                    count += 1
        if before.accepted:
            self.solve(path, settings)
        return count

    def solve(self, path, settings):
        """The changes that --solve prints, together, leave only the warnings that it says they leave."""
        words = [word for setting in settings for word in ("--set", setting)]
        solution = Report(self.thalweg("check", path, *words, "--solve"))
        self.assertTrue(solution.accepted, solution.text)
        pasted = shlex.split(solution.all("to try")[0])[3:] if solution.all("to try") else []
        after = Report(self.thalweg("check", path, *words, *pasted))
        self.assertTrue(after.accepted, after.text)
        self.assertEqual(after.kinds, solution.kinds, f"{pasted}\n{after.text}")
        for warning in after.warnings:
            if not warning.startswith(BY_HAND):
                self.assertEqual(remedies_in(warning), [], "a remedy that was not taken")

    def test_of_shipped_cases(self):
        applied = 0
        for path in sorted(CASES.rglob("*.yaml")):
            if "system" in yaml.safe_load(path.read_text()):   # no sweep
                here = self.apply_all(path)
                applied += here
                if path.name != "published.yaml":
                    self.assertEqual(here, 0, f"{path} is shipped with a warning")
        self.assertGreater(applied, 1)   # those of the published method at least

    def test_of_cases_that_are_warned_of(self):
        applied = 0
        for text, settings, words in VARIATIONS:
            self.case.write_text(text)
            with self.subTest(settings=settings):
                applied += self.apply_all(self.case, settings, words)
        self.assertGreater(applied, len(VARIATIONS))


program.main()
