"""The mean transport rate of a run, its error and whether it is steady: the same numbers, and the same words, as
run.log has."""
from typing import NamedTuple, Optional

import numpy as np

from thalweg import bed
from thalweg.errors import RunFolderError
from thalweg.means import DRIFTING, NOT_BOUNDED, STEADY, TOO_FEW, Mean, Steadiness, mean_with_error, steadiness
from thalweg.units import units_of


class Transport(NamedTuple):
    """The mean of q* (of q_s without a fluid) between two measurements, in the units of the case."""
    start: float         # time of the first measurement
    stop: float          # of the last
    measurements: int
    rate: Mean
    verdict: Steadiness
    moving: Optional[tuple]   # mean number of moving grains and its standard error
    symbol: str
    unit: str                 # with a blank before it
    second: str               # unit of the times

    def sentences(self):
        """The mean with its error, and the verdict."""
        rate = self.rate
        if self.measurements < 2:
            return (
                (
                    f"{self.symbol} = {rate.mean:.4g}{self.unit}, a single measurement, at {self.start:.4g}"
                    f" {self.second}: an error"
                    " needs at least two"
                ),
            )
        few = "" if rate.error_holds else ": too few, the error is larger"
        return (
            (
                f"{self.symbol} = {rate.mean:.4g} +- {rate.error:.2g}{self.unit}, deviation {rate.deviation:.2g}, from"
                f" {self.start:.4g} to {self.stop:.4g} {self.second} ({self.measurements} measurements worth"
                f" {rate.independent:.3g} independent ones{few})"
            ), self.verdict.sentence(),
        )


def transport(run, start=None, stop=None):
    """Transport of a run between two times (s). Without times it is the mean that the run itself has made, from
    summary.json or, while the run is going, from the rows of series.csv; with times it is that of the rows.
    RunFolderError where there is none."""
    column = column_of(run)
    if start is None and stop is None and of_run(run).get("q_s_independent") is not None:
        return by_the_run(run, column)
    time, rate = bed.transport_rate(run, start, np.inf if stop is None else stop, column)
    moving = None
    if "moving_grains" in run.series:
        counts = run.series["moving_grains"][bed.rows_between(run, time[0], time[-1])]
        counts = counts[np.isfinite(counts)]
        moving = mean_with_error(counts)[:2] if len(counts) else None
    return Transport(float(time[0]), float(time[-1]), len(time), mean_with_error(rate), steadiness(rate), moving,
                     *symbol_and_units(run, column))


def column_of(run):
    """Column of series.csv: q_star, or q_s without a fluid."""
    return "q_star" if "q_star" in run.series else "q_s"


def symbol_and_units(run, column):
    """The symbol of a rate, its unit and that of the times."""
    units = units_of(run)
    rate = ("q*", "") if column == "q_star" else ("q_s", f" {units.named('m^2/s')}")
    return *rate, units.named("s")


def of_run(run):
    return (run.summary or {}).get("transport_rate") or {}


def state_of_column(run, stop=np.inf):
    """The last row of series.csv up to a time (s), as numbers by name: a column of two continua changes until it is
    steady, so what counts is its state at the end and no mean."""
    series = run.series
    row = int(np.flatnonzero(series["time"] <= stop + 1e-9)[-1])
    return {name: float(series[name][row]) for name in series}


def sentence_of_column(state):
    """q* of a state of a column, when it was, and how far from steady."""
    return f"q* = {state['q_star']:.4g} at {state['time']:g} s, unsteadiness {state['unsteadiness']:.2g}"


def by_the_run(run, column):
    found = of_run(run)

    def number(name):
        return float("nan") if found[name] is None else found[name]

    rate = Mean(*(number(f"{column}_{name}") for name in ("mean", "error", "deviation")), number("q_s_independent"))
    verdict = Steadiness(
        {1: STEADY, 0: DRIFTING, -1: TOO_FEW, -2: NOT_BOUNDED}[found["steady"]], number(f"{column}_drift"),
        number(f"{column}_drift_error"),
    )
    return Transport(found["measured_from"], found["measured_until"], int(found["measurements"]), rate, verdict,
                     (number("moving_grains_mean"), number("moving_grains_error")),
                     *symbol_and_units(run, column))
