"""Means of correlated series, their error, and whether they are steady."""
from typing import NamedTuple, Optional

import numpy as np

FEWEST_BATCHES, MOST_BATCHES = 8, 64   # of steadiness()
FEWEST_INDEPENDENT = 20                # values, below which an error is an underestimate
LEAST_SHARE = 0.05                     # of the time, with intervals that count in at_equal_intervals()
ROUND_OFF = 1e-12                      # of the largest value, below which there is no drift


class Mean(NamedTuple):
    """A mean over time in the unit of the series."""
    mean: float
    error: float         # standard error of the mean, correlation counted
    deviation: float     # standard deviation of the values
    independent: float   # how many independent values the series is worth, 1

    @property
    def error_holds(self):
        """False where the time is too short to tell how long the values are correlated: the error is larger."""
        return self.independent >= FEWEST_INDEPENDENT


class Steadiness(NamedTuple):
    """Verdict of steadiness()."""
    steady: Optional[bool]   # None: too short a series to tell
    drift: float             # by which a straight line rises over the series, in the unit of the values
    error: float             # standard error of the drift; not a number where the series is too short


def at_equal_intervals(time):
    """Which of the times of a series (s, rising) to take so that means, errors and trends, which weigh all values alike, are not
    those of the part with the shortest intervals: all, or, where the interval was changed at a restart, those at the longest."""
    time = np.asarray(time, float)
    steps = np.diff(time)
    if len(steps) < 2:
        return np.ones(len(time), bool)
    # The longest that more than a small share of the time goes in: a single gap does not count.
    of_time = np.sort(steps)[::-1]
    longest = of_time[np.searchsorted(np.cumsum(of_time), LEAST_SHARE * of_time.sum())]
    shorter = steps < 0.75 * longest
    if steps[shorter].sum() <= longest:   # the last row of a run comes when it ends
        return np.ones(len(time), bool)
    wanted = time[0] + longest * np.arange(int((time[-1] - time[0]) / longest + 1e-6) + 1)
    after = np.clip(np.searchsorted(time, wanted), 1, len(time) - 1)
    nearest = np.where(wanted - time[after - 1] < time[after] - wanted, after - 1, after)
    chosen = np.zeros(len(time), bool)
    chosen[nearest] = True
    return chosen


def autocovariance(values):
    """Autocovariance at the lags 0, 1, ... of the values about their mean, each sum divided by the number of values."""
    values = np.asarray(values, float)
    count = len(values)
    spectrum = np.fft.rfft(values - values.mean(), 2 * count)
    return np.fft.irfft(np.abs(spectrum)**2, 2 * count)[:count] / count


def mean_with_error(values):
    """Mean of a stationary series at equal intervals, with its standard error.

    The variance of the mean is that of Geyer's initial positive sequence (Stat. Sci. 7 (1992) 473, sec. 3.3): the
    autocovariances are added in pairs of neighbouring lags as long as a pair is positive. Of a series that is worth fewer than
    20 independent values the error is an underestimate: see Mean.error_holds.
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


def steadiness(values):
    """Whether a straight line through a series at equal intervals rises or falls by no more than chance.

    The test is that of the run itself (analysis/trend_test.hpp, docs/theory.md section 5): a line is fitted to at most 63
    batches of equal length, and the lag-one autocorrelation of the residuals says how many independent ones they are
    worth (Santer et al., J. Geophys. Res. 105 (2000) 7337). A steady series fails one time in twenty; a drift smaller than
    the scatter is not seen.
    """
    batches = in_batches(np.asarray(values, float))
    count = len(batches)
    if count < FEWEST_BATCHES:
        return Steadiness(None, float("nan"), float("nan"))
    time = np.arange(count) - 0.5 * (count - 1.0)
    spread = float(time @ time)
    slope = float(time @ (batches - batches.mean())) / spread
    rest = batches - batches.mean() - slope * time
    least = count * (ROUND_OFF * np.max(np.abs(batches)))**2
    squares = float(rest @ rest)
    correlation = float(rest[:-1] @ rest[1:]) / squares if squares > least else 0.0
    worth = min(count, count * (1.0 - correlation) / (1.0 + correlation))
    if worth < 4.0:
        return Steadiness(None, slope * count, float("nan"))
    error = float(np.sqrt(max(squares, least) / ((worth - 2.0) * spread)))
    return Steadiness(bool(abs(slope) <= student_t_of_5_percent(worth - 2.0) * error), slope * count, error * count)


def in_batches(values):
    """Means of batches of 1, 2, 4, ... values, the shortest that make fewer than 64; those of an incomplete one are left out."""
    length = 1
    while len(values) // length >= MOST_BATCHES:
        length *= 2
    return values[:len(values) // length * length].reshape(-1, length).mean(axis=1)


def student_t_of_5_percent(degrees_of_freedom):
    """Student's t for a two-sided test at 5 % (Abramowitz and Stegun 26.7.5, within 1 % from two degrees on)."""
    z, v = 1.959963984540054, 1.0 / degrees_of_freedom
    first, second = (z**2 + 1.0) / 4.0, ((5.0 * z**2 + 16.0) * z**2 + 3.0) / 96.0
    third = (((3.0 * z**2 + 19.0) * z**2 + 17.0) * z**2 - 15.0) / 384.0
    fourth = ((((79.0 * z**2 + 776.0) * z**2 + 1482.0) * z**2 - 1920.0) * z**2 - 945.0) / 92160.0
    return z * (1.0 + v * (first + v * (second + v * (third + v * fourth))))


def running_mean(time, value, window):
    """Mean over [t - window/2, t + window/2], narrower at the ends."""
    total = np.concatenate([[0.0], np.cumsum(value)])
    first, last = np.searchsorted(time, time - window / 2), np.searchsorted(time, time + window / 2, side="right")
    return (total[last] - total[first]) / (last - first)
