#!/usr/bin/env python3
"""Profiles of the grains a camera sees, as fig. 5(e, f) of Zhang et al. (2022): visible_grains.py RUN_FOLDER... [options]

Areal fraction, velocity along x and temperature over the height from the surface of static pixels; thalweg.side_view and
thalweg.visible_profiles say what is visible, what is static, and what the temperature is.
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import thalweg_python

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import thalweg
from thalweg.visible_profiles import visible_profiles


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN_FOLDER")
    parser.add_argument("--from", dest="start", type=float, default=-np.inf, help="s, beginning of the means")
    parser.add_argument("--to", dest="stop", type=float, default=np.inf, help="s, their end")
    parser.add_argument("--frames", type=int, default=50, help="how many are evaluated at most")
    parser.add_argument("--out", default="visible_grains.png")
    arguments = parser.parse_args()
    figure, axes = plt.subplots(1, 3, figsize=(10, 4), sharey=True, layout="constrained")
    try:
        for folder in arguments.runs:
            run = thalweg.Run(folder)
            means = visible_profiles(run, arguments.start, arguments.stop, most_frames=arguments.frames)
            z = means["z"] / run.diameter
            axes[0].plot(means["areal_fraction"], z, "o-", ms=3, lw=0.8, label=run.name)
            axes[1].semilogx(np.where(means["velocity"][:, 0] > 0, means["velocity"][:, 0], np.nan), z, "o-", ms=3, lw=0.8)
            axes[2].semilogx(np.where(means["temperature"] > 0, means["temperature"], np.nan), z, "o-", ms=3, lw=0.8)
    except thalweg.RunFolderError as error:
        print(f"visible_grains: {error}", file=sys.stderr)
        return 1
    axes[0].set(xlabel="areal fraction", ylabel="height from the surface [d]")
    axes[1].set(xlabel="velocity along x [m/s]")
    axes[2].set(xlabel="temperature [m²/s²]")
    axes[0].legend(fontsize=8)
    for axis in axes:
        axis.axhline(0.0, color="0.6", lw=0.8)
        axis.grid(color="#e5e8ea", linewidth=0.8)
    figure.savefig(arguments.out, dpi=130)
    print(arguments.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
