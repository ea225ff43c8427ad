#!/usr/bin/python3
"""First motions of settled beds as links of a chain, beside Clark et al. (2017), section III F.

Reads the tables runs.csv of the sweeps first_motion.yaml, first_motion_held.yaml and first_motion_disks.yaml, which are kept
here under the names of the sweeps, and the thresholds Theta_c of motion that stops from shields_curve.csv and friction.csv. If
a bed of length W begins to move where the weakest of its parts does, the share of beds that move at Theta is

  C = 1 - exp[-W ((Theta - Theta_0)/beta)^alpha]

with the same alpha, beta and Theta_0 for every length, and the mean of Theta - Theta_0 goes with W^(-1/alpha). In the paper
Theta_0 is Theta_c: what begins to move in a large bed cannot stop. Prints alpha and Theta_0 that make all beds together most
likely, and the slope of the mean, with standard errors from resampled ensembles, and pass or fail. Exit code 0 if all pass.
"""
import argparse
import math
import sys
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import ScalarFormatter
from scipy.optimize import minimize

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
from thalweg.tables import read_rows
from thresholds import thresholds

ACCEPTED = 0.3   # of alpha
RAMP_STEP = 0.03
# Name of the sweep, exponent of the paper, table and row of the threshold, grains per diameter of length.
SYSTEMS = (("first_motion", "spheres", 2.2, "shields_curve", {"reynolds_number": 100.0}, 20),
           ("first_motion_disks", "disks with friction", 2.4, "friction",
            {"reynolds_number": 30.0, "friction": 0.6}, 10))


def threshold(table, wanted):
    """Theta_c and half its bracket, None if it has not been found."""
    for row in thresholds(table):
        if all(row[key] == value for key, value in wanted.items()):
            return row["shields_number"], row["half_width"]
    return None


def first_motions(name):
    """Shields numbers by the number of grains; those that were watched longer (name_held.csv) in place of the others. A bed
    begins to move somewhere within the last step of its ramp."""
    found = {}
    for path in (HERE / f"{name}.csv", HERE / f"{name}_held.csv"):
        for row in read_rows(path) if path.exists() else []:
            if row["state"] == "done":
                grains = int(row["grains.0.count"]) + int(row["grains.1.count"])
                moving = float(row["figures.shields_number [1]"])
                found[grains, row["grains.0.placement.seed"]] = moving / (1.0 + 0.5 * RAMP_STEP)
    sizes = sorted({grains for grains, _ in found})
    return {size: np.array([value for (grains, _), value in found.items() if grains == size]) for size in sizes}


def unlikelihood(parameters, ensembles):
    """Minus the logarithm of the likelihood; parameters: Theta_0, log beta, log alpha. A bed is known to rest at one level of
    its ramp and to move at the next."""
    first, log_beta, log_alpha = parameters
    total = 0.0
    for length, middles in ensembles:
        resting, moving = middles * (1.0 - 0.5 * RAMP_STEP), middles * (1.0 + 0.5 * RAMP_STEP)
        share_at_rest = [np.exp(-length * (np.maximum(level - first, 0.0) * np.exp(-log_beta))**np.exp(log_alpha))
                         for level in (resting, moving)]
        total -= np.sum(np.log(np.maximum(share_at_rest[0] - share_at_rest[1], 1e-300)))
    return total


def weibull_fit(ensembles):
    """alpha and Theta_0."""
    least = min(middles.min() for _, middles in ensembles)
    start = [0.8 * least, math.log(0.2), math.log(2.0)]
    options = {"maxiter": 2000, "xatol": 1e-4, "fatol": 1e-3}
    found = minimize(unlikelihood, start, (ensembles,), method="Nelder-Mead", options=options)
    return np.array([math.exp(found.x[2]), found.x[0]])


def mean_slope(ensembles, first):
    """Of the logarithm of the mean of Theta - Theta_0 over that of the length."""
    if len(ensembles) < 2:
        return math.nan
    lengths, means = zip(*((length, middles.mean() - first) for length, middles in ensembles))
    return np.polyfit(np.log(lengths), np.log(means), 1)[0]


def analysed(ensembles):
    alpha, first = weibull_fit(ensembles)
    return np.array([alpha, first, mean_slope(ensembles, first)])


def with_errors(ensembles, seed=1):
    """analysed() of the ensembles and its standard errors from a hundred resampled ones."""
    random = np.random.default_rng(seed)
    again = [analysed([(length, random.choice(middles, len(middles))) for length, middles in ensembles]) for _ in range(100)]
    return analysed(ensembles), np.std(again, axis=0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--figure", default="first_motion.png", metavar="FILE")
    parser.add_argument("--shortest", type=float, default=0.0, metavar="LENGTH", help="Leave out shorter beds, in diameters")
    arguments = parser.parse_args()
    measured = [(first_motions(system[0]), system) for system in SYSTEMS]
    measured = [(found, system) for found, system in measured if found]
    figure, axes = plt.subplots(len(measured), 2, figsize=(10, 3.7 * len(measured)), layout="constrained", squeeze=False)
    passed = True
    for (found, (_, title, paper, table, wanted, per_length)), (left, right) in zip(measured, axes):
        critical = threshold(table, wanted)
        ensembles = [(grains / per_length, middles) for grains, middles in found.items()
                     if grains >= arguments.shortest * per_length]
        (alpha, first, slope), (alpha_error, first_error, slope_error) = with_errors(ensembles)
        for length, middles in ensembles:
            print(f"{title}, {length:g} D long: {len(middles)} beds, mean {middles.mean():.4f}, deviation {middles.std():.4f}")
        good = abs(alpha - paper) <= ACCEPTED + alpha_error
        print(f"{title}: alpha {alpha:.2f} +- {alpha_error:.2f}, paper {paper}: {'pass' if good else 'FAIL'}")
        passed = passed and good
        if len(ensembles) > 1:
            straight = abs(slope + 1.0 / alpha) <= 2.0 * slope_error
            print(f"{title}: slope {slope:.3f} +- {slope_error:.3f}, -1/alpha {-1 / alpha:.3f}: {'pass' if straight else 'FAIL'}")
            passed = passed and straight
        if critical:
            same = abs(first - critical[0]) <= critical[1] + 2.0 * first_error
            print(f"{title}: Theta_0 {first:.4f} +- {first_error:.4f}, Theta_c of motion that stops {critical[0]:.4f} +- "
                  f"{critical[1]:.4f}: {'pass' if same else 'FAIL'}")
            passed = passed and same

        for length, middles in ensembles:
            x = np.sort((middles - first) / (middles.mean() - first))
            left.plot(x, (np.arange(len(x)) + 0.5) / len(x), ".", ms=4, label=f"{length:g} D, {len(x)} beds")
        x = np.linspace(0.0, 2.5, 100)
        left.plot(x, 1.0 - np.exp(-(math.gamma(1.0 + 1.0 / paper) * x)**paper), "k", lw=1, label=f"Weibull, α = {paper}")
        left.set(xlabel="(Θ$_f$ − Θ$_0$) over its mean", ylabel="beds that move", title=title)
        left.legend(fontsize=8)
        lengths = np.array([length for length, _ in ensembles])
        means = np.array([middles.mean() - first for _, middles in ensembles])
        errors = [middles.std() / math.sqrt(len(middles)) for _, middles in ensembles]
        right.errorbar(lengths, means, errors, fmt="o", capsize=3)
        right.plot(lengths, means[0] * (lengths / lengths[0])**(-1.0 / paper), "k", lw=1, label=f"W$^{{-1/{paper}}}$")
        right.set(xscale="log", yscale="log", xlabel="length W [D]", ylabel="mean of Θ$_f$ − Θ$_0$")
        for axis in (right.xaxis, right.yaxis):
            axis.set_major_formatter(ScalarFormatter())
            axis.set_minor_formatter(ScalarFormatter())
        right.legend(fontsize=8)
    for panel in axes.flat:
        panel.grid(color="#e5e8ea", linewidth=0.8)
    figure.savefig(arguments.figure, dpi=110)
    print(arguments.figure)
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
