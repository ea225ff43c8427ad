"""Means and errors of series whose statistics are known."""
import unittest

import numpy as np

import made_up_folder   # where the package is
import thalweg
from thalweg.means import DRIFTING, NOT_BOUNDED, STEADY, TOO_FEW, at_equal_intervals, in_batches, lack, running_mean, \
    student_t_of_5_percent

SERIES, LENGTH = 200, 4000


def autoregressive(generator, memory, count):
    """x_n = memory x_n-1 + noise with variance 1 of x, stationary from the start."""
    x = np.empty(count)
    x[0] = generator.normal()
    noise = generator.normal(size=count) * np.sqrt(1.0 - memory**2)
    for n in range(1, count):
        x[n] = memory * x[n - 1] + noise[n]
    return x


def series_worth(generator, independent, number, count=600):
    """That many series of count values that are worth so many independent ones: (1 - memory)/(1 + memory) of them."""
    memory = (count - independent) / (count + independent)
    return [autoregressive(generator, memory, count) for _ in range(number)]


class EqualIntervals(unittest.TestCase):
    def test_rows_after_a_change_of_the_interval_do_not_weigh_more(self):
        for coarse_first in (True, False):
            time = np.concatenate([np.arange(30) * 0.01, 0.3 + np.arange(301) * 0.001])
            if not coarse_first:
                time = 0.6 - time[::-1]
            chosen = at_equal_intervals(time)
            np.testing.assert_allclose(np.diff(time[chosen]), 0.01, rtol=1e-9)
            self.assertEqual(chosen.sum(), 61)
            # The mean of t itself over 0 to 0.6 s.
            self.assertAlmostEqual(time[chosen].mean(), 0.3, 12)

    def test_a_last_row_out_of_step_or_a_gap_changes_nothing(self):
        time = np.append(np.arange(100) * 0.01, 0.993)
        self.assertTrue(at_equal_intervals(time).all())
        self.assertTrue(at_equal_intervals(np.delete(np.arange(1000) * 0.01, slice(400, 420))).all())
        # However long the gap is: rows of series.csv that are missing before a restart.
        for gap in (slice(100, 900), slice(1, 999)):
            self.assertTrue(at_equal_intervals(np.delete(np.arange(1000) * 0.01, gap)).all())
        for short in ([], [1.0], [1.0, 2.0]):
            self.assertEqual(at_equal_intervals(short).sum(), len(short))


# How often the true mean is within one and two errors, by the number of independent values that a series of 600 is
# worth: the table of docs/theory.md, section 5.
COVERAGE = {3: (0.52, 0.78), 5: (0.59, 0.85), 10: (0.64, 0.90), 30: (0.68, 0.94), 100: (0.68, 0.95)}


class MeanWithError(unittest.TestCase):
    def test_the_error_of_correlated_values(self):
        # The variance of the mean of such a series is (1 + memory)/(1 - memory)/count (Priestley 1981, sec. 5.3). The
        # mean of 200 estimates scatters far less than the 10 % allowed; Geyer's sequence is known to be a few per cent
        # high.
        generator = np.random.default_rng(3)
        for memory in (0.0, 0.5, 0.9):
            errors = [thalweg.mean_with_error(autoregressive(generator, memory, LENGTH)).error for _ in range(SERIES)]
            exact = np.sqrt((1.0 + memory) / (1.0 - memory) / LENGTH)
            self.assertLess(abs(np.mean(errors) / exact - 1.0), 0.1, memory)

    def test_how_often_the_truth_lies_within_one_and_two_errors(self):
        # Counts of 500 scatter by up to 2.2 %, three of which are allowed.
        generator, text = np.random.default_rng(4), (made_up_folder.ROOT / "docs/theory.md").read_text()
        for worth, (one, two) in COVERAGE.items():
            self.assertIn(f"| {worth} | {100 * one:.0f} % | {100 * two:.0f} % |", text)
            found = [thalweg.mean_with_error(x) for x in series_worth(generator, worth, 500)]
            for errors, share in ((1.0, one), (2.0, two)):
                inside = np.mean([abs(m.mean) < errors * m.error for m in found])
                self.assertLess(
                    abs(inside - share), 3.0 * np.sqrt(share * (1.0 - share) / 500) + 0.005, (worth, errors)
                )
            holds = np.mean([m.error_holds for m in found])
            if worth <= 5:   # one in forty
                self.assertLess(holds, 0.05)
            if worth == 100:
                self.assertEqual(holds, 1.0)

    def test_an_error_from_few_independent_values_is_marked(self):
        # 40 values that forget themselves within 20: worth two of them or so. 4000 are worth 200.
        generator = np.random.default_rng(5)
        few, many = (thalweg.mean_with_error(autoregressive(generator, 0.9, count)) for count in (40, 4000))
        self.assertFalse(few.error_holds)
        self.assertTrue(many.error_holds)

    def test_independent_values(self):
        m = thalweg.mean_with_error(np.random.default_rng(5).normal(2.0, 3.0, 100000))
        self.assertLess(abs(m.mean - 2.0), 4 * 3.0 / np.sqrt(1e5))
        self.assertLess(abs(m.error / (3.0 / np.sqrt(1e5)) - 1.0), 0.15)
        self.assertLess(abs(m.deviation / 3.0 - 1.0), 4 / np.sqrt(2e5))

    def test_special_series(self):
        self.assertEqual(thalweg.mean_with_error(np.full(7, 0.3)).error, 0.0)
        self.assertTrue(np.isnan(thalweg.mean_with_error([1.0]).error))
        for of in (thalweg.mean_with_error, thalweg.steadiness):
            for gap in (np.nan, np.inf):
                with self.assertRaisesRegex(ValueError, "1 of 4 values"):
                    of([1.0, 2.0, gap, 3.0])
        with self.assertRaises(ValueError):
            thalweg.mean_with_error([])

    def test_what_an_autocovariance_lacks(self):
        """The sum over i of H_(i, i + lag), H the projection onto the constant and the line."""
        t = np.arange(11) - 5.0
        for fitted, columns in ((1, [np.ones(11)]), (2, [np.ones(11), t])):
            basis = np.linalg.qr(np.array(columns).T)[0]
            projection = basis @ basis.T
            for lag in range(11):
                self.assertAlmostEqual(lack(11, lag, fitted), np.trace(projection, lag), 12)


class Steadiness(unittest.TestCase):
    def test_steady_series_are_called_so(self):
        # Wrong one time in twenty by the definition of the test; of 200 that are 10, give or take three times
        # sqrt(200 0.05 0.95) = 3.1. The mean is a hundred times the scatter, so that it is steady otherwise.
        generator = np.random.default_rng(7)
        for memory in (0.0, 0.8):
            found = [
                thalweg.steadiness(100.0 + autoregressive(generator, memory, LENGTH)).steady for _ in range(SERIES)
            ]
            self.assertLess(abs(found.count(False) - 10), 10, memory)
            self.assertEqual(found.count(None), 0)

    def test_a_drift_is_seen(self):
        # The slope of such a series over the length 1 has the error sqrt(12 (1 + memory)/(1 - memory)/count) = 0.16; a
        # test at two errors misses a rise of five times one time in a thousand.
        generator = np.random.default_rng(8)
        error = np.sqrt(12.0 * 9.0 / LENGTH)
        seen = 0
        for _ in range(100):
            verdict = thalweg.steadiness(autoregressive(generator, 0.8, LENGTH) + np.linspace(0.0, 5.0 * error, LENGTH))
            seen += verdict.steady is False and verdict.drift > 0.0
        self.assertGreaterEqual(seen, 97)

    def test_a_straight_line(self):
        verdict = thalweg.steadiness(3.0 - 2.0 * np.arange(640) / 640 + np.tile([1e-3, -1e-3], 320))
        self.assertEqual(verdict.trend, DRIFTING)
        self.assertAlmostEqual(verdict.drift, -2.0, 4)
        self.assertIn("not steady: a straight line through it changes by -2 +- ", verdict.sentence())

    def test_a_trend_as_large_as_the_mean_is_not_steady(self):
        # Worth three independent values, with scatter and rise of the size of the mean: a run that was once called
        # steady.
        generator = np.random.default_rng(9)
        found = [
            thalweg.steadiness(1.0 + 0.3 * x + np.linspace(-0.5, 0.5, 600)) for x in series_worth(generator, 3, 200)
        ]
        self.assertLessEqual(sum(verdict.steady is True for verdict in found), 2)
        self.assertIn("which needs 20 independent values", thalweg.steadiness(np.arange(10.0)).sentence())

    def test_a_drift_that_may_be_half_of_the_mean_is_not_excluded(self):
        # 100 independent values of variance 1 leave +- 0.35 of the drift, 0.7 with 95 %: more than half of 0.5, less
        # than half of 10.
        generator = np.random.default_rng(10)
        trends = [
            [thalweg.steadiness(mean + generator.normal(size=100)).trend for _ in range(100)] for mean in (0.5, 10.0)
        ]
        self.assertGreater(trends[0].count(NOT_BOUNDED), 85)
        self.assertGreater(trends[1].count(STEADY), 85)

    def test_what_it_cannot_know(self):
        self.assertEqual(thalweg.steadiness(np.ones(19)).trend, TOO_FEW)
        self.assertEqual(thalweg.steadiness(np.ones(20))[:2], (STEADY, 0.0))
        self.assertEqual(thalweg.steadiness(np.zeros(20)).trend, STEADY)   # nothing moves

    def test_batches(self):
        np.testing.assert_array_equal(in_batches(np.arange(1023.0))[0], np.arange(1023.0))
        batches, length = in_batches(np.arange(1025.0))
        np.testing.assert_array_equal(batches, np.arange(512.0) * 2 + 0.5)
        self.assertEqual(length, 2)

    def test_students_numbers(self):
        for degrees, tabled, within in ((2, 4.3027, 0.05), (10, 2.2281, 1e-3), (60, 2.0003, 1e-4)):   # of tables
            self.assertAlmostEqual(student_t_of_5_percent(degrees), tabled, delta=within)


class RunningMean(unittest.TestCase):
    def test_of_a_straight_line(self):
        time = np.arange(0.0, 1.0, 0.01)
        mean = running_mean(time, 3.0 * time + 1.0, 0.1)
        inner = (time > 0.06) & (time < 0.93)
        np.testing.assert_allclose(mean[inner], (3.0 * time + 1.0)[inner], atol=3 * 0.01)


if __name__ == "__main__":
    unittest.main()
