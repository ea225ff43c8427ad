#!/usr/bin/env python3
"""`thalweg new` over random experiments: it writes a case of the flow asked for, of which `thalweg check` has no
warning, or says in one sentence why there is none, and leaves no file.

Called by ctest: new_case_test.py THALWEG MPIEXEC [unittest arguments]; EXPERIMENTS=300 in the environment tries more of
them.
"""
import json
import math
import os
import random
import sys
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest

GRAVITY = 9.81
EXPERIMENT = ["--diameter", 0.005, "--shields", 0.05, "--depth", 0.03]   # gravel in water


def log_uniform(chance, low, high):
    return math.exp(chance.uniform(math.log(low), math.log(high)))


class Experiment:
    """What somebody may ask for: grains of 0.2 mm to 5 cm, from plastic in water to steel in oil, from rest to sheet
    flow."""

    def __init__(self, seed):
        chance = random.Random(seed)
        self.diameter = float(f"{log_uniform(chance, 2e-4, 5e-2):.3g}")
        self.fluid = chance.choice([(1000.0, 1e-6), (1000.0, 1e-5), (900.0, 1e-4), (1260.0, 1e-3)])
        self.density = float(f"{self.fluid[0] * (1 + log_uniform(chance, 0.05, 7)):.4g}")
        self.shields = float(f"{log_uniform(chance, 0.01, 1):.3g}")
        self.depth = float(f"{self.diameter * log_uniform(chance, 2, 20):.3g}")
        self.width = chance.choice([None, None, float(f"{self.diameter * log_uniform(chance, 1.6, 8):.3g}")])
        self.words = ["--density", self.density, "--fluid-density", self.fluid[0], "--viscosity", self.fluid[1],
                      "--shields", self.shields, "--depth", self.depth,
                      "--accuracy", chance.choice(["look", "measure", "publish"]), "--layers", chance.choice([2, 5, 8])]
        if self.width:
            self.words += ["--width", self.width]
        if chance.random() < 0.25:
            low, high = 0.7 * self.diameter, 1.4 * self.diameter
            self.words += ["--sieve", f"{low:.9g}:0,{self.diameter:.9g}:0.5,{high:.9g}:1"]
        else:
            self.words += ["--diameter", self.diameter]

    def shields_number(self, slope, depth, width):
        """Zhang et al. 2022: g sin(alpha) R over (s - 1) g d, with R = H W/(2 H + W) between side walls."""
        radius = depth * width / (2 * depth + width) if self.width else depth
        return math.sin(math.atan(slope)) * radius / ((self.density / self.fluid[0] - 1) * self.diameter)


class NewCase(ProgramTest):
    def new(self, *words):
        self.case.unlink(missing_ok=True)
        return self.thalweg("new", self.case, *map(str, words))

    def test_random_experiments(self):
        written = 0
        for seed in range(int(os.environ.get("EXPERIMENTS", "16"))):
            experiment = Experiment(seed)
            with self.subTest(seed=seed, words=" ".join(map(str, experiment.words))):
                result = self.new(*experiment.words)
                if result.returncode == 2:
                    self.assertRegex(result.stderr, r"^thalweg: \S.*[.]\n$")
                    self.assertFalse(self.case.exists())
                    continue
                self.assertEqual(result.returncode, 0, result.stderr)
                written += 1
                self.assert_right(experiment)
        self.assertGreater(written, 8)

    def assert_right(self, experiment):
        report = self.thalweg("check", self.case, "--json")
        if report.returncode != 0:   # a right case that this machine cannot run
            self.assertIn("of memory, and this machine has", report.stderr)
        report = json.loads(report.stdout)
        self.assertEqual(report["warnings"], [])
        figures = report["figures"]
        width = yaml.safe_load(self.case.read_text())["domain"]["size"][1]
        asked = experiment.shields_number(figures["slope"], figures["depth"], width)
        # The median by volume of some dozens of sizes drawn from 0.7 to 1.4 d has a standard error of 1.25 x
        # 0.17/sqrt(60), 3 %.
        self.assertAlmostEqual(asked / experiment.shields, 1.0, delta=0.08 if "--sieve" in experiment.words else 0.005)
        # Half a cell, and a bed that is some grains more or less high.
        self.assertAlmostEqual(figures["depth"], experiment.depth, delta=0.3 * experiment.diameter)

    def test_means_have_a_window(self):
        """Of 20 sqrt(d/((s - 1) g)) times the 5 turnovers of a look, and in slow flow of a quarter of the time that it
        takes to develop, which rounding does not take away."""
        for diameter, shields, depth in [(0.0001, 0.05, 0.003), (0.0002, 0.1, 0.002), (0.0005, 0.02, 0.02)]:
            with self.subTest(diameter=diameter):
                result = self.new("--diameter", diameter, "--shields", shields, "--depth", depth)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertNotIn("warning", result.stdout)
                case = yaml.safe_load(self.case.read_text())
                starts = [keys["from"] for keys in case["analysis"].values()]
                window = case["run"]["until"] - max(starts)
                self.assertGreaterEqual(window, 100 * math.sqrt(diameter / (1.65 * GRAVITY)))
                self.assertGreaterEqual(window, 0.249 * max(starts))
                self.assertLess(case["output"]["series"]["every"], 0.01 * window)
                self.assertGreater(case["output"]["series"]["every"], 0)

    def test_hours_make_the_box_smaller(self):
        words = ["--diameter", 0.005, "--shields", 0.05, "--depth", 0.03, "--accuracy", "measure"]
        self.assertEqual(self.new(*words).returncode, 0)
        whole = yaml.safe_load(self.case.read_text())["domain"]["size"]
        cost = json.loads(self.thalweg("check", self.case, "--json").stdout)["figures"]["core_seconds"]
        result = self.new(*words, "--hours", cost / 3600 / 2)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertLess(math.prod(yaml.safe_load(self.case.read_text())["domain"]["size"]), 0.8 * math.prod(whole))
        result = self.new(*words, "--hours", 1e-3)
        self.assertEqual(result.returncode, 2)
        self.assertIn("even in the smallest box", result.stderr)
        self.assertFalse(self.case.exists())

    def test_what_is_missing_is_said(self):
        for words, reason in [
            (["--shields", 0.05, "--depth", 0.03], "no size"),
            (["--diameter", 0.005, "--depth", 0.03], "two of --shields, --slope and --depth"),
            (["--diameter", 0.005, "--shields", 0.05, "--depth", 0.03, "--slope", 0.1], "two of"),
            (["--diameter", 0.005, "--shields", 0.05, "--depth", 0.03, "--density", 900], "make no bed"),
            (["--sieve", "1:2:3", "--shields", 0.05, "--depth", 0.03], "is not a grading curve"),
            (["--diameter", 0.005, "--shields", 5, "--depth", 0.01], "no slope gives --shields 5"),
            (["--diameter", 0.005, "--shields", 0.5, "--depth", 0.01], "would slide as a whole: give --shields 0."),
            (["--diameter", 0.005, "--slope", 0.5, "--depth", 0.03], "would slide as a whole: give --slope 0."),
            (["--diameter", 0.005, "--shields", 0.8, "--slope", 0.2, "--layers", 2], "give a smaller --shields"),
            (["--diameter", 0.005, "--shields", 0.1, "--slope", 0.01, "--width", 0.02], "however deep"),
            (["--diameter", 0.005, "--shields", 0.05, "--depth", 0.002], "less than a diameter"),
            (["--diameter", 0.005, "--shields", 0.05, "--depth", 0.006, "--layers", 40], "or fewer --layers"),
            (["--diameter", 0.005, "--shields", 0.05, "--depth", 0.03, "--width", 0.004], "at least --width 0.00503"),
            (["--diameter", 0.005, "--shields", 0.05, "--depth", 0.03, "--length", 0.009], "at least --length 0.0101"),
            (
                [*EXPERIMENT, "--width", 0.05, "--periodic-width", 0.05],
                "the width is given twice: --width between side walls, or --periodic-width",
            ),
        ]:
            self.assert_refused_in_words(words, reason)

    def assert_refused_in_words(self, words, reason):
        """In those of the options, and not of keys of a case that nobody has written."""
        result = self.new(*words)
        self.assertEqual(result.returncode, 2, words)
        self.assertIn(reason, result.stderr)
        self.assertNotRegex(result.stderr, r"case\.yaml|[a-z]_?[a-z]*\.[a-z_]+[ :=]")
        self.assertFalse(self.case.exists())

    def test_numbers_in_other_units_are_refused(self):
        for words, reason in [
            (["--diameter", 5, "--shields", 0.05, "--depth", 30], "5 mm is 0.005 m"),
            (["--diameter", 0.5, "--shields", 0.05, "--depth", 0.03], "0.5 mm is 0.0005 m"),
            (["--sieve", "2:0,4:0.5,8:1", "--shields", 0.05, "--depth", 0.03], "--sieve is in m"),
            (["--diameter", 0.005, "--shields", 0.05, "--depth", 40], "give --depth 0.04"),
            ([*EXPERIMENT, "--width", 10], "give --width 0.01"),
            ([*EXPERIMENT, "--periodic-width", 30], "give --periodic-width 0.03"),
            ([*EXPERIMENT, "--length", 60], "give --length 0.06"),
            ([*EXPERIMENT, "--density", 2.65], "give --density 2650"),
            ([*EXPERIMENT, "--fluid-density", 1], "give --fluid-density 1000"),
            ([*EXPERIMENT, "--viscosity", 0.001], "give --viscosity 1e-06"),
            (["--diameter", 0.005, "--slope", 2, "--depth", 0.03], "in degrees, give --slope 0.0349"),
            ([*EXPERIMENT, "--layers", 0.025], "give --layers 5"),
        ]:
            self.assert_refused_in_words(words, reason)
        # An oil as viscous as that is no mistake, and nor is a flume a metre wide.
        self.assertEqual(self.new(*EXPERIMENT, "--fluid-density", 960, "--viscosity", 0.001).returncode, 0)
        self.assertEqual(self.new(*EXPERIMENT, "--width", 1).returncode, 0)

    def test_the_box_may_be_given(self):
        """Its sides are the whole numbers of cells nearest to what is asked for, whatever the hours."""
        self.assertEqual(self.new(*EXPERIMENT, "--length", 0.1, "--periodic-width", 0.03).returncode, 0)
        domain = yaml.safe_load(self.case.read_text())["domain"]
        self.assertEqual(domain["boundaries"]["y"], "periodic")
        for side, asked in zip(domain["size"], (0.1, 0.03)):
            self.assertAlmostEqual(side, asked, delta=0.51 * domain["spacing"])
        for _ in range(5):   # both commands measure the speed of a machine that others may slow in between
            self.new(*EXPERIMENT, "--length", 0.1, "--periodic-width", 0.03)
            cost = json.loads(self.thalweg("check", self.case, "--json").stdout)["figures"]["core_seconds"]
            result = self.new(*EXPERIMENT, "--length", 0.1, "--hours", 0.8 * cost / 3600)
            if result.returncode == 0:
                break
        self.assertEqual(result.returncode, 0, result.stderr)
        length, width = yaml.safe_load(self.case.read_text())["domain"]["size"]
        self.assertAlmostEqual(length, 0.1, delta=0.51 * domain["spacing"])
        self.assertLess(width, 0.029)

    def test_sieves_that_let_nothing_or_all_pass_change_nothing(self):
        def case_of(sieve):
            written = self.new("--sieve", sieve, "--shields", 0.05, "--depth", 0.03, "--accuracy", "look")
            self.assertEqual(written.returncode, 0, written.stderr)
            case = yaml.safe_load(self.case.read_text())
            del case["grains"][0]["diameter"]
            return case

        self.assertEqual(case_of("0.001:0,0.002:0,0.004:1,0.016:1"), case_of("0.002:0,0.004:1"))

    def test_viscous_fluids(self):
        """Of a slow flow drag is within some percent with trt, links cli and no subgrid model (docs/input.md, "Links"),
        and check has no warning; also where the step is at its limit, tau - 1/2 = 0.15."""
        for accuracy, diameter, viscosity in [("look", 0.005, 1e-3), ("measure", 0.001, 1e-4), ("publish", 0.003, 5e-5)]:
            with self.subTest(diameter=diameter):
                result = self.new("--diameter", diameter, "--density", 1190, "--fluid-density", 960, "--viscosity",
                                  viscosity, "--shields", 0.2, "--depth", 5 * diameter, "--accuracy", accuracy)
                self.assertEqual(result.returncode, 0, result.stderr)
                case = yaml.safe_load(self.case.read_text())
                self.assertEqual((case["fluid"]["collision"], case["fluid"]["subgrid_model"]), ("trt", "none"))
                self.assertEqual(case["coupling"], {"links": "cli"})
                self.assertEqual(json.loads(self.run_well("check", self.case, "--json").stdout)["warnings"], [])
        self.assertEqual(self.new(*EXPERIMENT).returncode, 0)
        self.assertNotIn("coupling", yaml.safe_load(self.case.read_text()))   # water has the defaults

    def test_narrow_flumes(self):
        """Between walls 1.2 diameters apart grains settle to a solid fraction of 0.43, loosely enough to be placed in no
        more room than they fill."""
        for layers in 2, 5:
            with self.subTest(layers=layers):
                result = self.new("--diameter", 0.005, "--slope", 0.02, "--depth", 0.03, "--width", 0.006, "--layers",
                                  layers)
                self.assertEqual(result.returncode, 0, result.stderr)
                case = yaml.safe_load(self.case.read_text())
                top = case["grains"][0]["placement"]["region"]["upper"][2]
                self.assertGreaterEqual(top, 1.0199 * layers * 0.005)
                self.assertEqual(json.loads(self.run_well("check", self.case, "--json").stdout)["warnings"], [])

    def test_a_file_is_not_overwritten(self):
        words = ["--diameter", 0.005, "--shields", 0.05, "--depth", 0.03]
        self.assertEqual(self.new(*words).returncode, 0)
        before = self.case.read_text()
        again = self.thalweg("new", self.case, *map(str, words))
        self.assertEqual(again.returncode, 2)
        self.assertIn("exists", again.stderr)
        self.assertEqual(self.case.read_text(), before)


program.main()
