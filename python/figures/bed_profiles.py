#!/usr/bin/env python3
"""Means over the height of a bed, as fig. 7(a) of Zhang et al. (2022): bed_profiles.py RUN_FOLDER [options]

Reads profiles.h5 (analysis.grain_profiles, and analysis.fluid_statistics where it is there) and, for the stress of the fluid on
the grains, their frames (coupling.grain_stress). Heights are from the surface by solid fraction. With
analysis.stress_balance it draws the stresses of that, the total and the line of the driving force, to which the total comes,
with what side walls take, in steady flow. Without, and without side walls, it draws the driving stress, the weight along the
slope of all that is above, and what is left of it for the fluid.
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import thalweg_python

import matplotlib
matplotlib.use("Agg")

import thalweg
from thalweg import height_profiles


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path, metavar="RUN_FOLDER")
    parser.add_argument("--out", default="bed_profiles.png")
    arguments = parser.parse_args()
    try:
        height_profiles.figure_of(thalweg.Run(arguments.run)).savefig(arguments.out, dpi=130)
    except thalweg.RunFolderError as error:
        print(f"bed_profiles: {error}", file=sys.stderr)
        return 1
    print(arguments.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
