"""Transport by size class as Python shows it: scales, gradings, figure, page and report of a run whose numbers are
known."""
import json
import unittest

import h5py
import matplotlib.pyplot as plt
import numpy as np

import made_up_folder as made_up
import thalweg
from thalweg.errors import RunFolderError
from thalweg.figures import overview
from thalweg.figures import sizes as figure
from thalweg.page.sections import size_section
from thalweg.report import Report, describe_sizes
from thalweg.sizes import Sizes

ARRAYS = {
    "edges": ([2e-3, 4e-3, 8e-3], "m"), "diameter": ([3e-3, 6e-3], "m"), "density": ([2550.0, 2550.0], "kg/m^3"),
    "bed_share": ([0.5, 0.5], "1"), "surface_share": ([0.2, 0.8], "1"), "surface_share_error": ([0.01, 0.01], "1"),
    "load_share": ([0.75, 0.25], "1"), "q_s": ([3e-6, 1e-6], "m^2/s"), "q_s_error": ([3e-7, 2e-7], "m^2/s"),
    "q_star": ([0.04, 0.01], "1"), "q_star_error": ([0.004, 0.002], "1"), "moving_grains": ([8.0, 0.5], "1"),
    "moving_grains_error": ([1.0, 0.1], "1"),
}


class SizesTest(made_up.MadeUpFolder):
    def setUp(self):
        super().setUp()
        (self.folder / "case.yaml").write_text(
            made_up.CASE.replace("{from: 1.0}", "{from: 1}, fractional_transport: {from: 1}, bed_surface: {from: 1}")
        )
        (self.folder / "series.csv").write_text("time [s],q_star [1]\n0,0\n1,1\n2,1\n3,1\n")
        (self.folder / "summary.json").write_text(json.dumps({"bed_surface": {"bed_stress_mean": 10.0}}))
        self.write()

    def write(self, **changed):
        with h5py.File(self.folder / "profiles.h5", "w") as file:
            for name, (values, unit) in ARRAYS.items():
                made_up.write_array(file, f"fractional_transport/{name}", np.array(changed.get(name, values)), unit,
                                    "edges" if name == "edges" else "diameter")
            made_up.write_array(file, "fractional_transport/d50", np.array([4e-3, 6e-3, 3e-3]), "m", "d50_component",
                                "bed surface load")

    def run_(self):
        return thalweg.Run(self.folder)

    def test_in_grain_units(self):
        case = self.folder / "case.yaml"
        case.write_text(case.read_text() + "model_fluid: {units: grain}\n")
        self.write(edges=[0.8, 1.0, 1.2])
        sizes = Sizes(self.run_())
        self.assertEqual((sizes.headings[0], sizes.rows()[0][0]), ("sizes [D]", "0.8 to 1"))
        self.assertIn("d50 of the bed 0.004 D, of its surface 0.006 D, of the load 0.003 D", sizes.sentence())

    def test_scales(self):
        sizes = Sizes(self.run_())
        self.assertAlmostEqual(sizes.armouring_ratio, 1.5)
        # q*_i by the bed: F_i/f_i times that by the surface.
        rate, error = sizes.q_star_by_bed()
        np.testing.assert_allclose(rate, [0.04 * 0.4, 0.01 * 1.6])
        np.testing.assert_allclose(error, [0.004 * 0.4, 0.002 * 1.6])
        # u* = sqrt(10 Pa/(1000 kg/m^3)) = 0.1 m/s; (s - 1) g = 1.55 * 9.8 m/s^2.
        np.testing.assert_allclose(sizes.w_star(), [1.55 * 9.8 * 3e-6 / (0.2 * 1e-3), 1.55 * 9.8 * 1e-6 / (0.8 * 1e-3)])
        np.testing.assert_allclose(sizes.finer(sizes.surface_share), [0.0, 0.2, 1.0])
        (self.folder / "summary.json").unlink()
        self.assertIsNone(Sizes(self.run_()).w_star())

    def test_rates_and_stress_are_of_the_same_time(self):
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace("bed_surface: {from: 1}", "bed_surface: {}"))   # from the start on
        self.assertIsNone(Sizes(self.run_()).w_star())   # series.csv has no stress
        (self.folder / "series.csv").write_text("time [s],bed_stress [Pa]\n0,22\n1,10\n2,11\n3,9\n")
        self.assertAlmostEqual(Sizes(self.run_()).shear_velocity(), 0.1, 12)   # not that of a mean of 13 Pa

    def test_arrays_over_the_diameter(self):
        found = self.run_().fractional_transport
        self.assertEqual(found.dimensions("q_s"), ("diameter",))
        self.assertEqual(found.dimensions("diameter"), ("diameter",))
        self.assertEqual(found.dimensions("edges"), ("edges",))

    def test_figure(self):
        drawn = figure.figure_of(self.run_())
        left, right = drawn.axes
        (surface,) = [line for line in left.lines if np.allclose(line.get_ydata(), [0.04, 0.01])]
        np.testing.assert_allclose(surface.get_xdata(), [0.75, 1.5])   # over the 4 mm of the bed
        np.testing.assert_allclose([line.get_ydata()[1] for line in right.lines], [50.0, 20.0, 75.0])
        plt.close(drawn)

    def test_a_flow_to_the_left(self):
        (self.folder / "summary.json").write_text(json.dumps({"bed_surface": {"bed_stress_mean": -10.0}}))
        self.write(q_s=[-3e-6, -1e-6], q_star=[-0.04, -0.01])
        self.assertAlmostEqual(Sizes(self.run_()).shear_velocity(), 0.1, 12)
        drawn = figure.figure_of(self.run_())
        self.assertTrue(any(np.allclose(line.get_ydata(), [0.04, 0.01]) for line in drawn.axes[0].lines))
        plt.close(drawn)

    def test_an_error_larger_than_the_rate_ends_above_it(self):
        self.write(q_star=[0.1, 0.01], q_star_error=[0.3, 0.002])
        drawn = figure.figure_of(self.run_())
        ends = [line.get_ydata() for line in drawn.axes[0].lines]   # of bars and caps
        self.assertTrue(any(len(y) and np.isclose(y[0], 0.4) for y in ends))
        self.assertTrue(any(len(y) and np.isclose(y[0], 0.001) for y in ends))
        plt.close(drawn)

    def test_nothing_moves(self):
        still = [0.0, 0.0]
        self.write(q_s=still, q_star=still, q_s_error=still, q_star_error=still, load_share=[np.nan, np.nan])
        drawn = figure.figure_of(self.run_())
        self.assertEqual([text.get_text() for text in drawn.axes[0].texts], ["no class moves downstream"])
        plt.close(drawn)

    def test_before_the_means_begin(self):
        self.write(q_s_error=[np.nan, np.nan], surface_share=[0.0, 0.0])
        with self.assertRaisesRegex(RunFolderError, "begin at 1 s"):
            figure.figure_of(self.run_())
        self.assertEqual(size_section(self.run_()), "")
        self.assertNotIn("sizes", [name for name, _ in overview.figures_of(self.run_())])

    def test_page_and_report(self):
        page = size_section(self.run_())
        self.assertIn("armouring ratio 1.5", page)
        self.assertIn("<td>2 to 4</td>", page)
        report = Report(self.run_())
        describe_sizes(report)
        self.assertIn("d50 of the bed 4 mm, of its surface 6 mm, of the load 3 mm", report.lines[-1])
        self.assertEqual(report.numbers["fractional_transport"]["moving_grains"], [8.0, 0.5])

    def test_a_run_without(self):
        (self.folder / "profiles.h5").unlink()
        self.assertEqual(size_section(self.run_()), "")
        with self.assertRaisesRegex(KeyError, "fractional_transport"):
            Sizes(self.run_())
        with self.assertRaisesRegex(RunFolderError, "analysis.fractional_transport in the case"):
            figure.figure_of(self.run_())


if __name__ == "__main__":
    unittest.main()
