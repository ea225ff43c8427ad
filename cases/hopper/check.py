#!/usr/bin/env python3
"""Compares the discharge of the hopper with Beverloo's law: check.py [RUN] [--orifice DIAMETER] [--figure FILE]

RUN: default run/hopper. Beverloo, Leniger and van de Velde (1961): W = C rho_b sqrt(g) (D - k d)^(5/2), C = 0.58, with
k = 1.4 of smooth spheres and rho_b the bulk density of the flowing grains above the orifice. Prints the rate while the
bin empties steadily, that of the law and pass or fail (10 %). Exit code 0 if it passes.
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

import thalweg
from hopper import BIN, BOTTOM

ACCEPTED = 0.10              # the spread of C (0.55 to 0.65) and k (1.3 to 1.5) in the literature is 10 % at D = 6.7 d


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", nargs="?", type=Path, default=Path("run/hopper"), metavar="RUN")
    parser.add_argument("--orifice", type=float, default=0.020, help="m")
    parser.add_argument("--figure", default="hopper.png")
    arguments = parser.parse_args()

    run = thalweg.Run(arguments.run)
    grains = run.case["grains"][0]
    diameter, volume = grains["diameter"], np.pi / 6.0 * grains["diameter"] ** 3
    times, gone, fractions = [], [], []
    middle = 0.5 * np.asarray(run.case["domain"]["size"][:2], dtype=float)
    for frame in run.grains:
        z = frame.position[:, 2]
        across = np.hypot(*(frame.position[:, :2] - middle).T)
        times.append(frame.time)
        gone.append(np.count_nonzero(z < BOTTOM) * volume * grains["density"])
        # Between three and nine diameters above the orifice, away from the sides.
        core = 0.5 * BIN - 2.0 * diameter
        inside = (z > BOTTOM + 3 * diameter) & (z < BOTTOM + 9 * diameter) & (across < core)
        fractions.append(np.count_nonzero(inside) * volume / (np.pi * core ** 2 * 6 * diameter))
    times, gone, fractions = np.array(times), np.array(gone), np.array(fractions)
    # Steady from the first twentieth that has gone until the bin is filled to half its diameter.
    whole = len(z) * volume * grains["density"]
    left = np.pi / 4.0 * BIN ** 2 * 0.5 * BIN * 0.6 * grains["density"]
    steady = (gone > 0.05 * whole) & (gone < whole - left)
    rate, start = np.polyfit(times[steady], gone[steady], 1)
    solid_fraction = fractions[steady].mean()
    bulk = solid_fraction * grains["density"]
    law = 0.58 * bulk * np.sqrt(run.case["gravity"]["magnitude"]) * (arguments.orifice - 1.4 * diameter) ** 2.5
    good = abs(rate / law - 1.0) <= ACCEPTED
    print(
        f"{rate * 1e3:.1f} g/s from {times[steady][0]:.2f} to {times[steady][-1]:.2f} s, solid fraction"
        f" {solid_fraction:.3f}; Beverloo's law {law * 1e3:.1f} g/s, difference {100 * (rate / law - 1):+.1f} %:"
        f" {'pass' if good else 'FAIL'}"
    )
    plt.figure(figsize=(5.6, 3.4), layout="constrained")
    plt.plot(times, 1e3 * gone, label="run")
    plt.plot(
        times, 1e3 * (start + law * (times - times[0]) + (rate - law) * times[steady][0]), "k--", label="Beverloo's law"
    )
    plt.ylim(0, 1e3 * whole)
    plt.xlabel("time [s]")
    plt.ylabel("grains that have left [g]")
    plt.legend()
    plt.savefig(arguments.figure, dpi=110)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
