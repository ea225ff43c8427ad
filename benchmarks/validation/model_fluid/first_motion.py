#!/usr/bin/python3
"""First motions of settled beds as links of a chain, beside Clark et al. (2017), section III F: first_motion.py [--figure FILE]

Reads the tables runs.csv of the sweeps first_motion.yaml and first_motion_disks.yaml, which are kept here under the names of
the sweeps, and the thresholds Theta_c from shields_curve.csv and friction.csv. If a bed of length W begins to move where the
weakest of its parts does, C = 1 - exp[-((Theta - Theta_c)/beta)^alpha] for every length, with the same alpha, and the mean of
Theta - Theta_c goes with W^(-1/alpha). Prints alpha of all lengths together, by maximum likelihood, and the slope, with
errors, and pass or fail. Exit code 0 if all pass.
"""
import argparse
import math
import sys
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

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
    """Shields numbers by the number of grains. A bed begins to move somewhere within the last step of its ramp."""
    path = HERE / f"{name}.csv"
    found = {}
    for row in read_rows(path) if path.exists() else []:
        if row["state"] == "done":
            grains = int(row["grains.0.count"]) + int(row["grains.1.count"])
            found.setdefault(grains, []).append(float(row["shields_number [1]"]) / (1.0 + 0.5 * RAMP_STEP))
    return {grains: np.array(found[grains]) for grains in sorted(found)}


def weibull_exponent(x):
    """alpha of the Weibull distribution that makes positive x most likely."""
    logs = np.log(x)

    def excess(alpha):   # of the derivative of the likelihood, rising with alpha
        weights = x**alpha
        return np.sum(weights * logs) / np.sum(weights) - 1.0 / alpha - np.mean(logs)
    low, high = 0.1, 50.0
    for _ in range(60):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if excess(middle) > 0.0 else (middle, high)
    return math.sqrt(low * high)


def scaled(excesses):
    """All lengths over their own means; a bed that moved below Theta_c, within the error of that, is left out."""
    together = np.concatenate([excess / excess.mean() for excess in excesses])
    return together[together > 0.0]


def with_error(figure, excesses, seed=1):
    """A figure of the excesses and its standard error from 200 resampled ensembles."""
    random = np.random.default_rng(seed)
    again = [figure([random.choice(excess, len(excess)) for excess in excesses]) for _ in range(200)]
    return figure(excesses), float(np.std(again))


def slope_of(lengths):
    return lambda excesses: float(np.polyfit(np.log(lengths), np.log([excess.mean() for excess in excesses]), 1)[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--figure", default="first_motion.png")
    arguments = parser.parse_args()
    figure, axes = plt.subplots(2, 2, figsize=(10, 7), layout="constrained")
    passed = True
    for (name, title, paper, table, wanted, per_length), (left, right) in zip(SYSTEMS, axes):
        critical, found = threshold(table, wanted), first_motions(name)
        if critical is None or not found:
            continue
        lengths = np.array(list(found)) / per_length
        excesses = [values - critical[0] for values in found.values()]
        (alpha, alpha_error), (slope, slope_error) = (
            with_error(lambda drawn: weibull_exponent(scaled(drawn)), excesses), with_error(slope_of(lengths), excesses))
        # Theta_c itself is known to half a bracket.
        shifted = [weibull_exponent(scaled([excess + shift for excess in excesses])) for shift in (critical[1], -critical[1])]
        good = abs(alpha - paper) <= ACCEPTED + alpha_error
        passed = passed and good
        for length, values in zip(lengths, found.values()):
            print(f"{title}, {length:g} D long: {len(values)} beds, mean {values.mean():.4f}, deviation {values.std():.4f}")
        print(f"{title}: Theta_c {critical[0]:.4f} +- {critical[1]:.4f}; alpha {alpha:.2f} +- {alpha_error:.2f} "
              f"({min(shifted):.2f} to {max(shifted):.2f} over the bracket of Theta_c), paper {paper}: "
              f"{'pass' if good else 'FAIL'}; slope {slope:.3f} +- {slope_error:.3f}, -1/alpha {-1 / alpha:.3f}")

        for length, excess in zip(lengths, excesses):
            x = np.sort(excess / excess.mean())
            left.plot(x, (np.arange(len(x)) + 0.5) / len(x), ".", ms=4, label=f"{length:g} D, {len(x)} beds")
        x = np.linspace(0.0, 2.5, 100)
        left.plot(x, 1.0 - np.exp(-(math.gamma(1.0 + 1.0 / paper) * x)**paper), "k", lw=1, label=f"Weibull, α = {paper}")
        left.set(xlabel="(Θ$_f$ − Θ$_c$) over its mean", ylabel="beds that move", title=title)
        left.legend(fontsize=8)
        means = np.array([excess.mean() for excess in excesses])
        errors = [excess.std() / math.sqrt(len(excess)) for excess in excesses]
        right.errorbar(lengths, means, errors, fmt="o", capsize=3)
        right.plot(lengths, means[0] * (lengths / lengths[0])**(-1.0 / paper), "k", lw=1, label=f"W$^{{-1/{paper}}}$")
        right.set(xscale="log", yscale="log", xlabel="length W [D]", ylabel="mean of Θ$_f$ − Θ$_c$")
        right.legend(fontsize=8)
    for panel in axes.flat:
        panel.grid(color="#e5e8ea", linewidth=0.8)
    figure.savefig(arguments.figure, dpi=110)
    print(arguments.figure)
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
