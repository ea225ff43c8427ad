"""Means and errors of series whose statistics are known."""
import unittest

import numpy as np

import made_up_folder  # noqa: F401 (where the package is)
import thalweg
from thalweg.means import autocovariance, running_mean

SERIES, LENGTH = 200, 4000


def autoregressive(generator, memory, count):
    """x_n = memory x_n-1 + noise with variance 1 of x, stationary from the start."""
    x = np.empty(count)
    x[0] = generator.normal()
    noise = generator.normal(size=count) * np.sqrt(1.0 - memory**2)
    for n in range(1, count):
        x[n] = memory * x[n - 1] + noise[n]
    return x


class MeanWithError(unittest.TestCase):
    def test_the_error_of_correlated_values(self):
        # The variance of the mean of such a series is (1 + memory)/(1 - memory)/count (Priestley 1981, sec. 5.3). The mean
        # of 200 estimates scatters far less than the 10 % allowed; Geyer's sequence is known to be a few per cent high.
        generator = np.random.default_rng(3)
        for memory in (0.0, 0.5, 0.9):
            errors = [thalweg.mean_with_error(autoregressive(generator, memory, LENGTH)).error for _ in range(SERIES)]
            exact = np.sqrt((1.0 + memory) / (1.0 - memory) / LENGTH)
            self.assertLess(abs(np.mean(errors) / exact - 1.0), 0.1, memory)

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
        # Wrong one time in 22 by a normal distribution; of 200 that are 9 +- 3.
        generator = np.random.default_rng(7)
        wrong = sum(not thalweg.is_steady(autoregressive(generator, 0.8, LENGTH)).steady for _ in range(SERIES))
        self.assertLess(wrong, 9 + 3 * 3 + 9)

    def test_a_drift_is_seen(self):
        # From the first to the last third the mean changes by 2/3, which is 8 errors: sqrt(2 9/(4000/3)) = 0.08.
        generator = np.random.default_rng(8)
        for _ in range(20):
            verdict = thalweg.is_steady(autoregressive(generator, 0.8, LENGTH) + np.linspace(0.0, 1.0, LENGTH))
            self.assertFalse(verdict.steady)
            self.assertGreater(verdict.last.mean, verdict.first.mean)

    def test_constants(self):
        self.assertTrue(thalweg.is_steady(np.full(9, 4.0)).steady)
        self.assertFalse(thalweg.is_steady(np.repeat([1.0, 2.0, 3.0], 3)).steady)
        with self.assertRaises(ValueError):
            thalweg.is_steady(np.zeros(5))


class RunningMean(unittest.TestCase):
    def test_of_a_straight_line(self):
        time = np.arange(0.0, 1.0, 0.01)
        mean = running_mean(time, 3.0 * time + 1.0, 0.1)
        inner = (time > 0.06) & (time < 0.93)
        np.testing.assert_allclose(mean[inner], (3.0 * time + 1.0)[inner], atol=3 * 0.01)


if __name__ == "__main__":
    unittest.main()
