"""Sediment along a reach as Python shows it: records, figure and page of a run whose numbers are known."""
import json
import sys
import unittest
import unittest.mock
import warnings

import h5py
import matplotlib.pyplot as plt
import numpy as np

import made_up_folder as made_up
import thalweg
from thalweg.errors import RunFolderError
from thalweg.figures import overview
from thalweg.figures import reach as figure
from thalweg.page.sections import reach_section
from thalweg.report import Report, describe_reach

X, SECTION = np.array([0.01, 0.03, 0.05]), np.array([0.02, 0.04])
Q_STAR = np.array([[0.0, 0.1], [0.2, 0.3], [0.4, 0.5]])   # [time, section]
LEVEL = np.array([[0.01, 0.02, np.nan], [0.012, 0.02, 0.03], [0.014, 0.02, 0.03]])   # m, [time, x]


class ReachTest(made_up.MadeUpFolder):
    def setUp(self):
        super().setUp()
        (self.folder / "case.yaml").write_text(
            made_up.CASE.replace("from: 1.0}", "from: 1.0}, reach: {from: 1.0, record_every: 0.5}")
            .replace("0.12, 0.0105", "0.06, 0.0105")
        )
        (self.folder / "series.csv").write_text("time [s],q_star [1]\n0,0\n1,1\n2,1\n3,1\n")
        self.write_part(0, slice(0, 0))
        self.write_part(10, slice(0, 2))
        self.write_part(20, slice(2, 3))

    def write_part(self, step, rows):
        (self.folder / "reach").mkdir(exist_ok=True)
        with h5py.File(self.folder / f"reach/part_{step:09d}.h5", "w") as file:
            for name, values, unit, axes in (
                ("section", SECTION, "m", "section"), ("x", X, "m", "x"),
                ("time", np.array([0.5, 1.0, 1.5])[rows], "s", "time"), ("interval", np.full(3, 0.5)[rows], "s", "time"),
                ("q_star", Q_STAR[rows], "1", "time section"), ("bed_level", LEVEL[rows], "m", "time x"),
            ):
                made_up.write_array(file, f"/{name}", values, unit, axes)

    def write_means(self, value=0.25):
        with h5py.File(self.folder / "profiles.h5", "w") as file:
            for name, values, unit, axis in (
                ("section", SECTION, "m", "section"), ("x", X, "m", "x"), ("q_star", [value, 0.5], "1", "section"),
                ("q_star_error", [0.05, 0.1], "1", "section"), ("bed_level", [0.012, 0.02, 0.03], "m", "x"),
            ):
                made_up.write_array(file, f"reach/{name}", np.array(values), unit, axis)

    def lines_of_reach(self):
        report = Report(self.run_())
        report.attempt("reach", lambda: describe_reach(report))
        return report.lines

    def test_analyze_tells_the_means_of_the_summary(self):
        self.assertEqual(self.lines_of_reach(), [
            "reach      left out: the means along x are in summary.json, which the run writes at its end."])
        means = {"q_star_mean": 0.25, "q_star_error": 0.05, "mean_from": 1.0, "bed_level_mean": 0.02, "bed_level_trend": -3e-4,
                 "bed_level_trend_error": 1e-4, "q_s_error_holds": 0.0,
                 "arrived_grains": 12, "left_grains": 10, "residence_time_mean": None}
        (self.folder / "summary.json").write_text(json.dumps({"reach": means, "simulated_time": 3.0}), encoding="utf-8")
        self.assertEqual(self.lines_of_reach(), [
            "reach      q* = 0.25 +- 0.05, mean of all sections and of the run from 1 to 3 s (too few records, the error is larger)",
            "reach      bed at 0.02 m, falling by 0.0003 +- 0.0001 m/s",
            "reach      12 grains came in, 10 left"])

    def test_in_grain_units(self):
        case = self.folder / "case.yaml"
        case.write_text(case.read_text() + "model_fluid: {units: grain}\n")
        (self.folder / "series.csv").write_text("time [s],q_s [m^2/s]\n0,0\n1,1\n2,1\n3,1\n")
        means = {"q_s_mean": 0.25, "q_s_error": 0.05, "bed_level_mean": 4.2, "bed_level_trend": 0.02,
                 "arrived_grains": 12, "left_grains": 10, "residence_time_mean": 5.0}
        (self.folder / "summary.json").write_text(json.dumps({"reach": means, "simulated_time": 3.0}), encoding="utf-8")
        self.assertEqual(self.lines_of_reach(), [
            "reach      q_s = 0.25 +- 0.05 sqrt(g'D^3), mean of all sections and of the run from 1 to 3 sqrt(D/g')",
            "reach      bed at 4.2 D, rising by 0.02 sqrt(g'D)",
            "reach      12 grains came in, 10 left; those that did both stayed for 5 sqrt(D/g')"])

    def test_the_means_of_the_run_keep_their_times_beside_those_of_other_times(self):
        means = {"q_star_mean": 0.25, "q_star_error": 0.05, "mean_from": 1.0, "bed_level_trend": None,
                 "arrived_grains": 0, "left_grains": 0}
        (self.folder / "summary.json").write_text(json.dumps({"reach": means, "simulated_time": 3.0}), encoding="utf-8")
        report = Report(self.run_(), 2.0, 2.5)
        describe_reach(report)
        numbers = report.numbers
        self.assertEqual((numbers["from"], numbers["until"]), (2.0, 2.5))
        self.assertEqual((numbers["reach"]["from"], numbers["reach"]["until"]), (1.0, 3.0))
        self.assertTrue(report.lines[0].endswith("of the run from 1 to 3 s"))

    def run_(self):
        return thalweg.Run(self.folder)

    def test_records_are_joined_and_places_are_not(self):
        reach = self.run_().reach
        np.testing.assert_array_equal(reach["x"], X)
        np.testing.assert_array_equal(reach["section"], SECTION)
        np.testing.assert_array_equal(reach["time"], [0.5, 1.0, 1.5])
        np.testing.assert_array_equal(reach["q_star"], Q_STAR)
        self.assertEqual(reach.dimensions("bed_level"), ("time", "x"))
        self.assertEqual(reach.units["bed_level"], "m")

    def test_figure(self):
        self.write_means()
        drawn = figure.figure_of(self.run_())
        level, rate, means = drawn.axes[:3]
        np.testing.assert_array_equal(rate.collections[0].get_array().ravel(), Q_STAR.ravel())
        np.testing.assert_allclose(
            np.ma.filled(level.collections[0].get_array(), np.nan).reshape(3, 3), 1e3 * LEVEL
        )
        (line,) = means.lines
        np.testing.assert_allclose(line.get_xydata(), [[20.0, 0.25], [40.0, 0.5]])
        (bed,) = drawn.axes[-1].lines
        np.testing.assert_allclose(bed.get_xydata()[:, 1], [12.0, 20.0, 30.0])
        plt.close(drawn)

    def test_section_0_of_a_periodic_box_is_its_end_as_well(self):
        with unittest.mock.patch.object(sys.modules[__name__], "SECTION", np.array([0.0, 0.03])):
            self.write_part(0, slice(0, 0))
            self.write_part(10, slice(0, 2))
            self.write_part(20, slice(2, 3))
            self.write_means()
        drawn = figure.figure_of(self.run_())
        self.addCleanup(plt.close, drawn)
        cells = drawn.axes[1].collections[0]
        np.testing.assert_allclose(cells.get_coordinates()[0, :, 0], [-15.0, 15.0, 45.0, 75.0])   # mm, of a box of 60
        np.testing.assert_array_equal(cells.get_array().reshape(3, 3), Q_STAR[:, [0, 1, 0]])
        self.assertEqual(drawn.axes[1].get_xlim(), (0.0, 60.0))
        (line,) = drawn.axes[2].lines
        np.testing.assert_allclose(line.get_xydata(), [[0.0, 0.25], [30.0, 0.5], [60.0, 0.25]])

    def test_a_time_without_records_stays_empty(self):
        """The run went on without analysis.reach for a second between the second and the third record."""
        with h5py.File(self.folder / "reach/part_000000020.h5", "a") as file:
            file["time"][...] = 2.5
        drawn = figure.figure_of(self.run_())
        self.addCleanup(plt.close, drawn)
        cells = drawn.axes[1].collections[0]
        np.testing.assert_allclose(cells.get_coordinates()[:, 0, 1], [0.0, 0.5, 1.0, 2.0, 2.5])
        np.testing.assert_array_equal(cells.get_array().reshape(4, 2).filled(-1.0), np.insert(Q_STAR, 2, -1.0, axis=0))

    def test_a_bed_without_a_level_is_drawn_without_warnings(self):
        with h5py.File(self.folder / "reach/part_000000010.h5", "a") as first:
            first["bed_level"][...] = np.nan
        with h5py.File(self.folder / "reach/part_000000020.h5", "a") as second:
            second["bed_level"][...] = np.nan
        self.write_means()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            drawn = figure.figure_of(self.run_())
        level, rate = drawn.axes[:2]
        self.assertEqual(level.collections[0].get_array().count(), 0)
        self.assertEqual(rate.collections[0].get_array().count(), Q_STAR.size)
        plt.close(drawn)

    def test_upstream_transport_has_colours_of_its_own(self):
        self.assertEqual(figure.colours_of(Q_STAR)["vmin"], 0.0)
        about_nought = figure.colours_of(Q_STAR - 0.6)
        self.assertEqual((about_nought["vmin"], about_nought["vmax"]), (-0.6, 0.6))

    def test_colours_are_those_of_the_records_that_count(self):
        run = self.run_()
        np.testing.assert_array_equal(figure.counted(run, run.reach), [False, False, True])   # it begins at 1 s

    def test_before_the_means_begin(self):
        self.write_means(np.nan)
        with h5py.File(self.folder / "profiles.h5", "a") as file:
            file["reach/q_star"][...] = np.nan
        drawn = figure.figure_of(self.run_())
        self.assertEqual(len(drawn.axes), 4)   # two panels and their colours
        plt.close(drawn)
        self.assertIn("reach", [name for name, _ in overview.figures_of(self.run_())])

    def test_page(self):
        self.write_means()
        found = {"arrived_grains": 12345, "left_grains": 10, "residence_time_mean": 0.75, "balance_residual": 0}
        (self.folder / "summary.json").write_text(json.dumps({"reach": found}))
        self.assertIn("12345 grains came in and 10 left; the mean residence time of those that did both is 0.75 s. The balance",
                      reach_section(self.run_()))
        found |= {"arrived_grains": 0, "left_grains": 0, "residence_time_mean": None}   # a periodic reach
        (self.folder / "summary.json").write_text(json.dumps({"reach": found}))
        page = reach_section(self.run_())
        self.assertIn("The balance of the bins is out by 0 grains.", page)
        self.assertNotIn("came in", page)

    def test_a_run_without(self):
        for part in (self.folder / "reach").iterdir():
            part.unlink()
        self.assertEqual(reach_section(self.run_()), "")
        with self.assertRaisesRegex(RunFolderError, "it has no reach yet"):
            figure.figure_of(self.run_())
        self.write_part(0, slice(0, 0))
        self.assertNotIn("reach", [name for name, _ in overview.figures_of(self.run_())])
        with self.assertRaisesRegex(RunFolderError, "no record of the reach is complete"):
            figure.figure_of(self.run_())


if __name__ == "__main__":
    unittest.main()
