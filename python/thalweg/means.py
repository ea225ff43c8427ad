"""Means of correlated series, their error, and whether they are steady."""
from typing import NamedTuple

import numpy as np


class Mean(NamedTuple):
    """A mean over time in the unit of the series."""
    mean: float
    error: float         # standard error of the mean, correlation counted
    deviation: float     # standard deviation of the values
    independent: float   # how many independent values the series is worth, 1


class Steadiness(NamedTuple):
    """Verdict of is_steady()."""
    steady: bool
    first: Mean          # of the first third
    last: Mean           # of the last third
    errors_apart: float  # their difference over its standard error, 1


def autocovariance(values):
    """Autocovariance at the lags 0, 1, ... of the values about their mean, each sum divided by the number of values."""
    values = np.asarray(values, float)
    count = len(values)
    spectrum = np.fft.rfft(values - values.mean(), 2 * count)
    return np.fft.irfft(np.abs(spectrum)**2, 2 * count)[:count] / count


def mean_with_error(values):
    """Mean of a stationary series at equal intervals, with its standard error.

    The variance of the mean is that of Geyer's initial positive sequence (Stat. Sci. 7 (1992) 473, sec. 3.3): the
    autocovariances are added in pairs of neighbouring lags as long as a pair is positive.
    """
    values = np.asarray(values, float)
    count = len(values)
    if count == 0:
        raise ValueError("the mean of no values")
    mean = float(values.mean())
    covariance = autocovariance(values)
    variance = covariance[0]
    if variance <= 1e-24 * mean**2 or count < 2:
        return Mean(mean, 0.0 if count > 1 else float("nan"), 0.0, float(count))
    pairs = covariance[:count // 2 * 2].reshape(-1, 2).sum(axis=1)
    negative = np.flatnonzero(pairs <= 0.0)
    total = 2.0 * pairs[:negative[0] if len(negative) else len(pairs)].sum() - variance
    # Careful: a series that swings about its mean would be worth more than its length.
    total = max(total, variance)
    return Mean(mean, float(np.sqrt(total / count)), float(np.sqrt(variance)), float(count * variance / total))


def is_steady(values, errors=2.0):
    """Whether the means of the first and the last third differ by less than `errors` standard errors of their difference.

    The comparison is Geweke's (1992, in Bayesian Statistics 4) with thirds for his first tenth and last half. A steady
    series fails one time in twenty at two errors; a drift slower than the scatter of the means is not seen.
    """
    thirds = np.array_split(np.asarray(values, float), 3)
    if len(thirds[2]) < 2:
        raise ValueError("fewer than six values: nothing can be said of their steadiness")
    first, last = mean_with_error(thirds[0]), mean_with_error(thirds[2])
    error = float(np.hypot(first.error, last.error))
    difference = abs(last.mean - first.mean)
    apart = difference / error if error > 0.0 else (0.0 if difference == 0.0 else float("inf"))
    return Steadiness(apart < errors, first, last, apart)


def running_mean(time, value, window):
    """Mean over [t - window/2, t + window/2], narrower at the ends."""
    total = np.concatenate([[0.0], np.cumsum(value)])
    first, last = np.searchsorted(time, time - window / 2), np.searchsorted(time, time + window / 2, side="right")
    return (total[last] - total[first]) / (last - first)
