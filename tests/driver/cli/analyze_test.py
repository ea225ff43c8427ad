#!/usr/bin/env python3
"""`thalweg analyze`, and the mean that the run itself reports.

Called by ctest: analyze_test.py THALWEG MPIEXEC [unittest arguments]
"""
import json
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
import program
import thalweg
from program import TUMBLING_GRAINS, ProgramTest
from thalweg import layers, transport


class Analyze(ProgramTest):
    CASE = TUMBLING_GRAINS

    def test_analyze_says_what_the_sediment_does(self):
        self.run_well("run", self.case, "--out", "run")
        said = self.run_well("analyze", "run", "--from", "0.06").stdout
        self.assertRegex(said, r"transport  q_s = [-0-9.e]+ \+- [0-9.e-]+ m\^2/s")   # no q* without a fluid
        self.assertTrue((self.folder / "run/analysis/layers.csv").exists())
        self.assertIn("--until SECONDS", self.run_well("analyze", "--help").stdout)
        self.assert_refused("analyze", "nowhere", words=["nowhere", "case.yaml"])

    def assert_one_mean(self, out):
        """run.log, summary.json and `thalweg analyze` say the same. Returns transport_rate of summary.json."""
        log = (self.folder / out / "run.log").read_text()
        said = self.run_well("analyze", out).stdout
        sentences = [line.split("transport: ")[1] for line in log.splitlines() if "transport: " in line][-2:]
        self.assertEqual(len(sentences), 2, log)
        self.assertEqual(
            [line.removeprefix("transport").strip() for line in said.splitlines() if line.startswith("transport")],
            sentences,
        )
        of_run = self.summary(out)["transport_rate"]
        analyzed = json.loads((self.folder / out / "analysis/summary.json").read_text())
        for name, value in (
            ("q_s_mean", "mean"), ("q_s_error", "error"), ("q_s_deviation", "deviation"),
            ("q_s_independent", "independent"), ("q_s_drift", "drift"), ("q_s_drift_error", "drift_error"),
        ):
            self.assertEqual(analyzed["q_s"][value], of_run[name], name)
        self.assertEqual(
            analyzed["moving_grains"], {"mean": of_run["moving_grains_mean"], "error": of_run["moving_grains_error"]}
        )
        return of_run

    def test_the_run_and_its_reader_agree_on_mean_error_and_what_is_steady(self):
        # 26 rows; 501; 25 of a run that ends between two rows.
        self.run_well("run", self.case, "--out", "run")
        self.run_well("run", self.case, "--out", "fine", "--set", "output.series.every=2e-4", "--set",
                      "analysis.transport_rate.from=0")
        self.run_well("run", self.case, "--out", "early", "--until", "0.0994")
        for out, count in (("run", 26), ("fine", 501), ("early", 25)):
            of_run = self.assert_one_mean(out)
            # The same from the rows of series.csv, which hold every digit.
            run = thalweg.Run(self.folder / out)
            rate = transport.transport(run, run.averaged_from("transport_rate"))
            self.assertEqual((rate.measurements, of_run["measurements"]), (count, count))
            for name, value in (
                ("mean", rate.rate.mean), ("error", rate.rate.error), ("deviation", rate.rate.deviation),
                ("independent", rate.rate.independent), ("drift", rate.verdict.drift),
                ("drift_error", rate.verdict.error),
            ):
                self.assertAlmostEqual(value / of_run[f"q_s_{name}"], 1.0, 11, (out, name))
            self.assertEqual(of_run["steady"] == 1, rate.verdict.steady is True)
        # Where a restart has changed the interval the run's mean begins anew; where it measures more often than there
        # are rows, these are too few: the numbers are still those of the run.
        self.run_well("run", self.case, "--out", "early", "--restart", "early", "--until", "0.15", "--set",
                      "output.series.every=1e-3")
        self.assertLess(self.assert_one_mean("early")["measurements"], 53)
        self.run_well("run", self.case, "--out", "often", "--set", "analysis.transport_rate.every=2e-4")
        self.assertEqual(self.assert_one_mean("often")["measurements"], 251)

    def test_the_run_and_its_reader_agree_on_layers_of_grains(self):
        # The same sums of the same three moments, in C++ as they go and in Python from frames, of two kinds of grains.
        self.run_well("run", self.case, "--out", "run", "--set", "analysis.grain_profiles={from: 0.05, every: 0.02}",
                      "--set", "grains=[{count: 40, diameter: 5.0e-3, density: 2550, placement: {pattern: random}}, "
                      "{count: 20, diameter: 4.0e-3, density: 1500, placement: {pattern: random}}]")
        run = thalweg.Run(self.folder / "run")
        self.assertEqual(len(list(run.grains.between(0.05))), 3)
        of_run = run.profiles["grain_profiles"]
        of_reader = layers.layer_profiles(run, 0.05, thickness=2 * of_run["z"][0])
        numpy.testing.assert_allclose(of_reader["z"], of_run["z"], rtol=1e-12)
        there = of_reader["solid_fraction"] > 0
        self.assertGreater(there.sum(), 4)
        # Sums of up to 60 grains with both signs, each rounded at 1e-16 of its part: 1e-11 of the largest value.
        for name in ("solid_fraction", "velocity", "flux", "granular_temperature", "contact_stress"):
            found, expected = of_run[name][there], numpy.reshape(of_reader[name], of_run[name].shape)[there]
            self.assertGreater(abs(expected).max(), 0.0, name)
            numpy.testing.assert_allclose(found, expected, atol=1e-11 * abs(expected).max(), err_msg=name)


if __name__ == "__main__":
    program.main()
