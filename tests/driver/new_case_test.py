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
            (["--sieve", "1:2:3", "--shields", 0.05, "--depth", 0.03], "is no grading curve"),
            (["--diameter", 0.005, "--shields", 5, "--depth", 0.01], "slope"),
        ]:
            result = self.new(*words)
            self.assertEqual(result.returncode, 2, words)
            self.assertIn(reason, result.stderr)
            self.assertFalse(self.case.exists())

    def test_a_file_is_not_overwritten(self):
        words = ["--diameter", 0.005, "--shields", 0.05, "--depth", 0.03]
        self.assertEqual(self.new(*words).returncode, 0)
        before = self.case.read_text()
        again = self.thalweg("new", self.case, *map(str, words))
        self.assertEqual(again.returncode, 2)
        self.assertIn("exists", again.stderr)
        self.assertEqual(self.case.read_text(), before)


program.main()
