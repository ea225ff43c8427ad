"""Means of correlated series, their error, and whether they are steady: the same numbers as the run itself gives
(analysis/statistics/correlated_mean.hpp, long_run_variance.hpp and stationarity.hpp; docs/theory.md section 5)."""
from typing import NamedTuple, Optional

import numpy as np

MOST_BATCHES = 1024
LEAST_SHARE = 0.05        # of the time, with intervals that count in at_equal_intervals()
ALIKE = 0.75              # of an interval, from which another one counts as long as it
FEWEST_INDEPENDENT = 20   # values, below which an error is an underestimate and nothing is said of drifts
BOUND = 0.5               # part of the mean by which a steady series may change from its begin to its end
ROUND_OFF = 1e-12         # of the largest batch, below which there is no scatter
LARGEST_LACK = 0.8        # share that a sum of autocovariances is taken to lack, at most
NEGLIGIBLE = 1e-10        # of the variance: a pair of autocovariances below counts as none

TOO_FEW, NOT_BOUNDED, DRIFTING, STEADY = "too few values", "not bounded", "drifting", "steady"


class Mean(NamedTuple):
    """A mean over time in the unit of the series."""
    mean: float
    error: float         # standard error of the mean, correlation counted; not a number of a single value
    deviation: float     # standard deviation of the values
    independent: float   # how many independent values the series is worth, 1

    @property
    def error_holds(self):
        """False where the time is too short to tell how long the values are correlated: the error is larger."""
        return self.independent >= FEWEST_INDEPENDENT


class Steadiness(NamedTuple):
    """Verdict of steadiness()."""
    trend: str     # STEADY, DRIFTING, or why the series is too short to tell: TOO_FEW, NOT_BOUNDED
    # Rise of a straight line over the series, in the unit of the series; not a number with fewer than 3 batches.
    drift: float
    error: float   # standard error of the drift

    @property
    def steady(self) -> Optional[bool]:
        """None: too short a series to tell."""
        return {STEADY: True, DRIFTING: False}.get(self.trend)

    def sentence(self):
        """The verdict with its reason, as run.log has it."""
        if self.trend == TOO_FEW:
            return f"too short a time to tell whether it is steady, which needs {FEWEST_INDEPENDENT} independent values"
        line = f"a straight line through it changes by {self.drift:+.2g} +- {self.error:.2g} over this time, which is"
        return {
            DRIFTING: f"not steady: {line} beyond chance",
            STEADY: f"steady: {line} within chance and (95 %) less than half of the mean",
            NOT_BOUNDED: (
                f"too short a time to tell whether it is steady: {line} within chance, but may be half of the mean"
            ),
        }[self.trend]


def at_equal_intervals(time):
    """Which of the times of a series (s, rising) to take so that means, errors and trends, which weigh all values
    alike, are not those of the part with the shortest intervals: all, or, where the interval was changed at a restart,
    those at the longest."""
    time = np.asarray(time, float)
    steps = np.diff(time)
    if len(steps) < 2:
        return np.ones(len(time), bool)
    # The longest that more than a small share of the time goes in. A gap does not count: none beside it is as long.
    beside = np.maximum(np.append(steps[1:], 0.0), np.append(0.0, steps[:-1]))
    of_time = np.sort(steps[beside >= ALIKE * steps])[::-1]
    if not len(of_time):
        return np.ones(len(time), bool)
    longest = of_time[np.searchsorted(np.cumsum(of_time), LEAST_SHARE * of_time.sum())]
    shorter = steps < ALIKE * longest
    if steps[shorter].sum() <= longest:   # the last row of a run comes when it ends
        return np.ones(len(time), bool)
    wanted = time[0] + longest * np.arange(int((time[-1] - time[0]) / longest + 1e-6) + 1)
    after = np.clip(np.searchsorted(time, wanted), 1, len(time) - 1)
    nearest = np.where(wanted - time[after - 1] < time[after] - wanted, after - 1, after)
    chosen = np.zeros(len(time), bool)
    chosen[nearest] = True
    return chosen


def in_batches(values):
    """Means of batches of 1, 2, 4, ... values, the shortest that make fewer than 1024, and the length of a batch;
    values of an incomplete batch are left out."""
    length = 1
    while len(values) // length >= MOST_BATCHES:
        length *= 2
    return values[:len(values) // length * length].reshape(-1, length).mean(axis=1), length


def autocovariance(distances, lag):
    """Sum of the products of values that many apart, divided by the number of values."""
    return float(distances[lag:] @ distances[:len(distances) - lag]) / len(distances)


def lack(count, lag, fitted):
    """The share of the long-run variance, times count, that the autocovariance at a lag lacks where a mean (fitted: 1)
    or a line (2) through the same values was taken away: the sum over i of H_(i, i + lag), H the projection onto what
    was taken away."""
    terms = count - lag
    of_line = terms * (terms * terms - 1.0 - 3.0 * lag * lag) / (count * (count * count - 1.0)) if fitted == 2 else 0.0
    return terms / count + of_line


def long_run_variance(distances, fitted, round_off):
    """Number of values times the variance of their mean, by Geyer's initial monotone sequence (Stat. Sci. 7 (1992) 473,
    sec. 3.3) with the bias of the autocovariances removed, and how many independent values would have the same.

    distances: of values at equal intervals from their mean (fitted: 1) or from a straight line (2). round_off: what
    they are off by at least, in their unit.
    """
    count = len(distances)
    variance = autocovariance(distances, 0)
    if variance <= round_off**2:
        return round_off**2, float(count)
    total, lacking, before = -variance, -lack(count, 0, fitted), 2.0 * variance
    for lag in range(0, max(2, count // 2) - 1, 2):
        pair = autocovariance(distances, lag) + autocovariance(distances, lag + 1)
        if pair <= NEGLIGIBLE * variance:
            break
        before = min(before, pair)
        total += 2.0 * before
        lacking += 2.0 * (lack(count, lag, fitted) + lack(count, lag + 1, fitted))
    # Careful: a series that swings about its mean would be worth more than its length.
    total = max(total / (1.0 - min(lacking / count, LARGEST_LACK)), variance * count / (count - fitted))
    return total, min(float(count), count * variance / total + fitted)


def numbers(values):
    """The values as an array. ValueError if one is not finite: what stands for "not measured" would make the mean the
    same."""
    values = np.asarray(values, float)
    lacking = np.count_nonzero(~np.isfinite(values))
    if lacking:
        raise ValueError(
            f"{lacking} of {len(values)} values are not finite; leave them out: values[np.isfinite(values)]"
        )
    return values


def mean_with_error(values):
    """Mean of a stationary series at equal intervals, with its standard error, from the long-run variance of its
    batches. Of a series that is worth fewer than 20 independent values the error is an underestimate: see
    Mean.error_holds. ValueError if there are no values, or one is not finite."""
    values = numbers(values)
    count = len(values)
    if count == 0:
        raise ValueError("the mean of no values")
    mean, deviation = float(values.mean()), float(values.std())
    if count < 2:
        return Mean(mean, float("nan"), 0.0, 1.0)
    batches, length = in_batches(values)
    round_off = ROUND_OFF * float(np.max(np.abs(batches)))
    if deviation <= round_off:
        return Mean(mean, 0.0, deviation, float(count))
    squared = long_run_variance(batches - batches.mean(), 1, round_off)[0] * length / count
    return Mean(mean, float(np.sqrt(squared)), deviation, float(min(count, deviation**2 / squared + 1.0)))


def steadiness(values):
    """Whether a straight line through a series at equal intervals rises or falls by no more than chance, and by less
    than half of the mean: that is what `steady` claims, with 95 % confidence. A steady series is said to drift one time
    in twenty.

    The slope has the variance that the long-run variance of the values about the line gives it (Santer et al., J.
    Geophys. Res. 105 (2000) 7337, who take the number of independent values from the first lag alone).
    """
    values = numbers(values)
    batches, _ = in_batches(values)
    count = len(batches)
    if count < 3:
        return Steadiness(TOO_FEW, float("nan"), float("nan"))
    time, spread = np.arange(count) - 0.5 * (count - 1.0), count * (count**2 - 1.0) / 12.0
    slope = float(time @ (batches - batches.mean())) / spread
    variance, independent = long_run_variance(
        batches - batches.mean() - slope * time, 2, ROUND_OFF * np.max(np.abs(batches))
    )
    drift, error = slope * count, float(np.sqrt(variance / spread)) * count
    if independent < FEWEST_INDEPENDENT:
        return Steadiness(TOO_FEW, drift, error)
    chance, mean = student_t_of_5_percent(independent - 2.0) * error, mean_with_error(values)
    if abs(drift) > chance:
        return Steadiness(DRIFTING, drift, error)
    if not mean.error_holds:
        return Steadiness(TOO_FEW, drift, error)
    return Steadiness(STEADY if abs(drift) + chance <= BOUND * abs(mean.mean) else NOT_BOUNDED, drift, error)


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
