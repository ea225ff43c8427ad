#!/usr/bin/env python3
"""A resolved bed beside the two-phase continuum, as figs. 8, 10(b) and 11 of Zhang et al. (2022):
two_phases.py RUN_FOLDER [CONTINUUM_FOLDER] [options]

RUN_FOLDER: a resolved run with analysis.stress_balance; CONTINUUM_FOLDER: a run of cases/continuum/creep.yaml with the same slope,
grains, fluid and Shields number. Draws solid fraction, velocities and stresses over the height, the creep below the surface, the
stress ratio and the solid fraction of every sheared layer over its mixed inertial number, and the drag of the layers beside the
law of Beetstra et al. (2007). Prints q*, the Shields numbers and the lengths of the creep.
"""
import argparse
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import thalweg_python

import matplotlib
matplotlib.use("Agg")

import thalweg
from thalweg import bed, two_phases


def transport(run):
    """Shields number and q* of a run, measured."""
    if "continuum" in run.profiles:
        return run.summary["figures"]["shields_number"], run.summary["figures"]["q_star"]
    start = run.averaged_from("stress_balance")
    return bed.measured_shields_number(run, start, math.inf), thalweg.mean_with_error(bed.transport_rate(run, start)[1]).mean


def report(run, column):
    layers = two_phases.resolved_bed(run)
    print("Shields number {:.4f}, q* {:.4f}".format(*transport(run)))
    print(f"creep of the run: e-fold {two_phases.decay_length(layers.height, layers.grain_velocity):.2f} d")
    if column is None:
        return
    print("continuum: Shields number {:.4f}, q* {:.4f}".format(*transport(column)))
    different = two_phases.different_materials(run, column)
    if different:
        print(f"two_phases: the two runs differ: {different}.", file=sys.stderr)
    of = column.profiles["continuum"]
    if "creep_velocity" in of:
        print(f"creep of the continuum: e-fold {two_phases.decay_length(-of['creep_depth'] / column.diameter, of['creep_velocity']):.2f} d")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path, metavar="RUN_FOLDER")
    parser.add_argument("continuum", type=Path, metavar="CONTINUUM_FOLDER", nargs="?")
    parser.add_argument("--out", default="two_phases.png")
    arguments = parser.parse_args()
    try:
        run = thalweg.Run(arguments.run)
        column = thalweg.Run(arguments.continuum) if arguments.continuum else None
        if column is not None and "continuum" not in column.profiles:
            raise thalweg.RunFolderError(f"{arguments.continuum}: not a run with system: continuum.")
        report(run, column)
        two_phases.comparison_figure(run, column).savefig(arguments.out, dpi=120)
    except thalweg.RunFolderError as error:
        print(f"two_phases: {error}", file=sys.stderr)
        return 1
    print(arguments.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
