#!/usr/bin/env python3
"""First motions of settled beds as links of a chain, beside Clark et al. (2017), section III F.

Reads the tables runs.csv of the sweeps first_motion*.yaml, which are kept here under the names of the sweeps, and the
threshold Theta_c of motion that stops from shields_curve.csv. If a bed of length W begins to move where the weakest of
its parts does, the share of beds that move at Theta is

  C = 1 - exp[-W ((Theta - Theta_0)/beta)^alpha]

with the same alpha, beta and Theta_0 for every length, and the mean of Theta - Theta_0 goes with W^(-1/alpha). Of
spheres with quadratic drag Theta_0 is Theta_c in the paper: what begins to move in a large bed cannot stop. Elastic
disks with linear drag stop at much lower Shields numbers, and Theta_0 is one of its own. Prints alpha that makes all
beds together most likely, and the slope of the mean, with standard errors from resampled ensembles: with Theta_0 fitted
as well, and of spheres with the Theta_c of the paper and the one found here, without the beds that begin to move below.
The last is judged, of disks the first; exit code 0 if all pass.
"""
import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import FormatStrFormatter
from scipy.optimize import minimize

from thalweg.checks import Verdict
from thresholds import runs, thresholds

ACCEPTED = 0.3   # of alpha


@dataclass(frozen=True)
class System:
    name: str                # of the sweep
    title: str
    alpha: float             # of the paper
    theta_c: float | None    # of the paper; without one Theta_0 is fitted only
    row: dict                # of the threshold found here, in shields_curve.csv
    grains_per_length: int   # in a diameter of length
    step: float              # relative, of the ramp


SYSTEMS = (System("first_motion", "spheres", 2.2, 0.11, {"reynolds_number": 100.0}, 20, 0.03),
           System("first_motion_disks", "disks with friction", 2.4, None, {}, 10, 0.05))


def threshold(wanted):
    """Theta_c of the row with these values."""
    return next(row["shields_number"] for row in thresholds("shields_curve")
                if all(row[key] == value for key, value in wanted.items()))


def first_motions(system):
    """Middle of the last step of the ramp, within which a bed begins to move, of all beds by their length; those of the
    other tables in place of the first."""
    found = {}
    for part in ("", "_held", "_short_step", "_long"):
        for row in runs(f"{system.name}{part}"):
            grains = int(row["grains.0.count"]) + int(row["grains.1.count"])
            moving = float(row["figures.shields_number [1]"])
            found[grains, row["grains.0.placement.seed"]] = moving / (1.0 + 0.5 * system.step)
    sizes = sorted({grains for grains, _ in found})
    return [
        (size / system.grains_per_length, np.array([value for (grains, _), value in found.items() if grains == size]))
        for size in sizes
    ]


def unlikelihood(first, log_beta, log_alpha, ensembles, step):
    """Minus the logarithm of the likelihood with Theta_0 = first: a bed rests at one level of its ramp and moves at the
    next."""
    total = 0.0
    for length, middles in ensembles:
        resting, moving = middles * (1.0 - 0.5 * step), middles * (1.0 + 0.5 * step)
        share_at_rest = [np.exp(-length * (np.maximum(level - first, 0.0) * np.exp(-log_beta))**np.exp(log_alpha))
                         for level in (resting, moving)]
        total -= np.sum(np.log(np.maximum(share_at_rest[0] - share_at_rest[1], 1e-300)))
    return total


def weibull_fit(ensembles, step, given=None):
    """alpha and Theta_0, which may be given."""
    options = {"maxiter": 2000, "xatol": 1e-4, "fatol": 1e-3}
    start = [math.log(0.2), math.log(2.0)]
    if given is not None:
        found = minimize(
            lambda p: unlikelihood(given, *p, ensembles, step), start, method="Nelder-Mead", options=options
        )
        return math.exp(found.x[1]), given
    least = min(middles.min() for _, middles in ensembles)
    found = minimize(
        lambda p: unlikelihood(*p, ensembles, step), [0.8 * least, *start], method="Nelder-Mead", options=options
    )
    return math.exp(found.x[2]), found.x[0]


def mean_slope(ensembles, first):
    """Of the logarithm of the mean of Theta - Theta_0 over that of the length."""
    if len(ensembles) < 2:
        return math.nan
    lengths, means = zip(*((length, middles.mean() - first) for length, middles in ensembles))
    return np.polyfit(np.log(lengths), np.log(means), 1)[0]


@dataclass(frozen=True)
class Fit:
    ensembles: list     # without the beds that begin to move below Theta_0
    left_out: int
    alpha: float
    first: float        # Theta_0
    slope: float
    alpha_error: float
    first_error: float
    slope_error: float

    def line(self, title, choice):
        print(
            f"{title}, Theta_0 {self.first:.4f} +- {self.first_error:.4f} ({choice}; {self.left_out} beds begin below"
            f" it): alpha {self.alpha:.2f} +- {self.alpha_error:.2f}, -1/alpha {-1 / self.alpha:.3f}, slope"
            f" {self.slope:.3f} +- {self.slope_error:.3f}"
        )


def fitted(ensembles, step, given=None, seed=1):
    """Weibull fit and slope, with standard errors from a hundred resampled ensembles."""
    kept = [
        (length, middles if given is None else middles[middles * (1.0 - 0.5 * step) > given])
        for length, middles in ensembles
    ]

    def analysed(beds):
        alpha, first = weibull_fit(beds, step, given)
        return np.array([alpha, first, mean_slope(beds, first)])

    random = np.random.default_rng(seed)
    again = [analysed([(length, random.choice(middles, len(middles))) for length, middles in kept]) for _ in range(100)]
    left_out = sum(len(middles) for _, middles in ensembles) - sum(len(middles) for _, middles in kept)
    return Fit(kept, left_out, *analysed(kept), *np.std(again, axis=0))


def judge(system, fit, verdict):
    """Whether alpha is that of the paper, and the slope of the mean -1/alpha."""
    good = abs(fit.alpha - system.alpha) <= ACCEPTED + fit.alpha_error
    print(
        f"{system.title}: alpha {fit.alpha:.2f} +- {fit.alpha_error:.2f}, paper {system.alpha}:"
        f" {verdict(good)}"
    )
    if math.isnan(fit.slope):
        return
    straight = abs(fit.slope + 1.0 / fit.alpha) <= 2.0 * fit.slope_error
    print(f"{system.title}: slope {fit.slope:.3f} +- {fit.slope_error:.3f}, -1/alpha {-1 / fit.alpha:.3f}: "
          f"{verdict(straight)}")


def draw(system, fit, left, right):
    for length, middles in fit.ensembles:
        x = np.sort((middles - fit.first) / (middles.mean() - fit.first))
        left.plot(x, (np.arange(len(x)) + 0.5) / len(x), ".", ms=4, label=f"{length:g} D, {len(x)} beds")
    x = np.linspace(0.0, 2.5, 100)
    left.plot(x, 1.0 - np.exp(-(math.gamma(1.0 + 1.0 / system.alpha) * x)**system.alpha), "k", lw=1,
              label=f"Weibull, α = {system.alpha}")
    left.set(
        xlabel="(Θ$_f$ − Θ$_0$) over its mean", ylabel="beds that move",
        title=f"{system.title}, Θ$_0$ = {fit.first:.3g}",
    )
    left.legend(fontsize=8)
    lengths = np.array([length for length, _ in fit.ensembles])
    means = np.array([middles.mean() - fit.first for _, middles in fit.ensembles])
    errors = [middles.std() / math.sqrt(len(middles)) for _, middles in fit.ensembles]
    right.errorbar(lengths, means, errors, fmt="o", capsize=3)
    right.plot(
        lengths, means[-1] * (lengths / lengths[-1]) ** (-1.0 / system.alpha), "k", lw=1,
        label=f"W$^{{-1/{system.alpha}}}$",
    )
    right.set(xscale="log", yscale="log", xlabel="length W [D]", ylabel="mean of Θ$_f$ − Θ$_0$")
    for axis in (right.xaxis, right.yaxis):
        axis.set_major_formatter(FormatStrFormatter("%g"))
        axis.set_minor_formatter(FormatStrFormatter("%g"))
    right.legend(fontsize=8)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--figure", default="first_motion.png", metavar="FILE")
    parser.add_argument(
        "--shortest", type=float, default=0.0, metavar="LENGTH", help="Leave out shorter beds, in diameters"
    )
    arguments = parser.parse_args()
    measured = [(first_motions(system), system) for system in SYSTEMS]
    measured = [(found, system) for found, system in measured if found]
    figure, axes = plt.subplots(
        len(measured), 2, figsize=(10, 3.7 * len(measured)), layout="constrained", squeeze=False
    )
    verdict = Verdict()
    for (found, system), panels in zip(measured, axes):
        ensembles = [(length, middles) for length, middles in found if length >= arguments.shortest]
        for length, middles in ensembles:
            print(
                f"{system.title}, {length:g} D long: {len(middles)} beds, mean {middles.mean():.4f}, deviation"
                f" {middles.std():.4f}"
            )
        fit = fitted(ensembles, system.step)
        fit.line(system.title, "fitted")
        if system.theta_c:
            fitted(ensembles, system.step, system.theta_c).line(system.title, "Theta_c of the paper")
            fit = fitted(ensembles, system.step, threshold(system.row))
            fit.line(system.title, "Theta_c found here")
        judge(system, fit, verdict)
        draw(system, fit, *panels)
    for panel in axes.flat:
        panel.grid(color="#e5e8ea", linewidth=0.8)
    figure.savefig(arguments.figure, dpi=110)
    print(arguments.figure)
    return verdict.exit_code


if __name__ == "__main__":
    sys.exit(main())
