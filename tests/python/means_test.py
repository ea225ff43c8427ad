"""Means and errors of series whose statistics are known."""
import unittest

import numpy as np

import made_up_folder  # noqa: F401 (where the package is)
import thalweg
from thalweg.means import at_equal_intervals, autocovariance, in_batches, running_mean, student_t_of_5_percent

SERIES, LENGTH = 200, 4000


def autoregressive(generator, memory, count):
    """x_n = memory x_n-1 + noise with variance 1 of x, stationary from the start."""
    x = np.empty(count)
    x[0] = generator.normal()
    noise = generator.normal(size=count) * np.sqrt(1.0 - memory**2)
    for n in range(1, count):
        x[n] = memory * x[n - 1] + noise[n]
    return x


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
        for short in ([], [1.0], [1.0, 2.0]):
            self.assertEqual(at_equal_intervals(short).sum(), len(short))


class MeanWithError(unittest.TestCase):
    def test_the_error_of_correlated_values(self):
        # The variance of the mean of such a series is (1 + memory)/(1 - memory)/count (Priestley 1981, sec. 5.3). The mean
        # of 200 estimates scatters far less than the 10 % allowed; Geyer's sequence is known to be a few per cent high.
        generator = np.random.default_rng(3)
        for memory in (0.0, 0.5, 0.9):
            errors = [thalweg.mean_with_error(autoregressive(generator, memory, LENGTH)).error for _ in range(SERIES)]
            exact = np.sqrt((1.0 + memory) / (1.0 - memory) / LENGTH)
            self.assertLess(abs(np.mean(errors) / exact - 1.0), 0.1, memory)

    def test_an_error_from_few_independent_values_is_marked(self):
        # 40 values that forget themselves within 20: worth two of them or so. 4000 are worth 200.
        generator = np.random.default_rng(5)
        few, many = (thalweg.mean_with_error(autoregressive(generator, 0.9, count)) for count in (40, 4000))
        self.assertFalse(few.error_holds)
        self.assertTrue(many.error_holds)

    def test_how_often_the_truth_lies_within_two_errors(self):
        # 95.4 % for a normal mean with the exact error; the binomial scatter of 200 is 1.5 %, three of which are allowed,
        # and as much again for the error of the error.
        generator = np.random.default_rng(4)
        found = [thalweg.mean_with_error(autoregressive(generator, 0.8, LENGTH)) for _ in range(SERIES)]
        inside = np.mean([abs(m.mean) < 2.0 * m.error for m in found])
        self.assertGreater(inside, 0.954 - 6 * 0.015)

    def test_independent_values(self):
        m = thalweg.mean_with_error(np.random.default_rng(5).normal(2.0, 3.0, 100000))
        self.assertLess(abs(m.mean - 2.0), 4 * 3.0 / np.sqrt(1e5))
        self.assertLess(abs(m.error / (3.0 / np.sqrt(1e5)) - 1.0), 0.1)
        self.assertLess(abs(m.deviation / 3.0 - 1.0), 4 / np.sqrt(2e5))

    def test_special_series(self):
        self.assertEqual(thalweg.mean_with_error(np.full(7, 0.3))[1:3], (0.0, 0.0))
        self.assertTrue(np.isnan(thalweg.mean_with_error([1.0]).error))
        with self.assertRaises(ValueError):
            thalweg.mean_with_error([])

    def test_autocovariance_is_the_sum_it_says(self):
        x = np.random.default_rng(6).normal(size=50)
        y = x - x.mean()
        direct = [np.sum(y[:50 - k] * y[k:]) / 50 for k in range(50)]
        np.testing.assert_allclose(autocovariance(x), direct, atol=1e-14)


class Steadiness(unittest.TestCase):
    def test_steady_series_are_called_so(self):
        # Wrong one time in twenty by the definition of the test; of 200 that are 10, give or take three times
        # sqrt(200 0.05 0.95) = 3.1.
        generator = np.random.default_rng(7)
        for memory in (0.0, 0.8):
            wrong = sum(not thalweg.steadiness(autoregressive(generator, memory, LENGTH)).steady for _ in range(SERIES))
            self.assertLess(abs(wrong - 10), 10, memory)

    def test_a_drift_is_seen(self):
        # The slope of such a series over the length 1 has the error sqrt(12 (1 + memory)/(1 - memory)/count) = 0.16; a test
        # at two errors misses a rise of five times one time in a thousand.
        generator = np.random.default_rng(8)
        error = np.sqrt(12.0 * 9.0 / LENGTH)
        seen = 0
        for _ in range(100):
            verdict = thalweg.steadiness(autoregressive(generator, 0.8, LENGTH) + np.linspace(0.0, 5.0 * error, LENGTH))
            seen += verdict.steady is False and verdict.drift > 0.0
        self.assertGreaterEqual(seen, 97)

    def test_a_straight_line(self):
        verdict = thalweg.steadiness(3.0 - 2.0 * np.arange(640) / 640 + np.tile([1e-3, -1e-3], 320))
        self.assertIs(verdict.steady, False)
        self.assertAlmostEqual(verdict.drift, -2.0, 6)

    def test_what_it_cannot_know(self):
        self.assertIsNone(thalweg.steadiness(np.ones(7)).steady)
        self.assertEqual(thalweg.steadiness(np.ones(8))[:2], (True, 0.0))

    def test_batches(self):
        np.testing.assert_array_equal(in_batches(np.arange(63.0)), np.arange(63.0))
        np.testing.assert_array_equal(in_batches(np.arange(65.0)), np.arange(32.0) * 2 + 0.5)

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
