"""A resolved bed beside the two-phase continuum, as figs. 8, 10(b) and 11 of Zhang et al. (2022).

Draws solid fraction, velocities and stresses over the height, the creep below the surface, the stress ratio and the
solid fraction of every sheared layer over its mixed inertial number, and the drag of the layers beside the law of
Beetstra et al. (2007). Prints q*, the Shields numbers and the lengths of the creep.
"""
import math
import sys

from thalweg import bed, two_phases
from thalweg.errors import RunFolderError
from thalweg.means import mean_with_error
from thalweg.run import Run


def transport(run):
    """Shields number and q* of a run, measured."""
    if "continuum" in run.profiles:
        return run.summary["figures"]["shields_number"], run.summary["figures"]["q_star"]
    start = run.averaged_from("stress_balance")
    return bed.measured_shields_number(run, start, math.inf), mean_with_error(bed.transport_rate(run, start)[1]).mean


def print_creep(name, height, velocity):
    """Its decay length, where it can be fitted."""
    length = two_phases.e_fold(height, velocity)
    if length:
        print(f"creep of the {name}: {length}")


def report(run, column):
    layers = two_phases.resolved_bed(run)
    print("Shields number {:.4f}, q* {:.4f}".format(*transport(run)))
    print_creep("run", layers.height, layers.grain_velocity)
    if column is None:
        return
    print("continuum: Shields number {:.4f}, q* {:.4f}".format(*transport(column)))
    different = two_phases.different_materials(run, column)
    if different:
        print(f"thalweg: the two runs differ: {different}.", file=sys.stderr)
    of = column.profiles["continuum"]
    if "creep_velocity" in of:
        print_creep("continuum", -of["creep_depth"] / column.diameter, of["creep_velocity"])


def draw(folder, continuum=None):
    """folder: of a resolved run with analysis.stress_balance; continuum: of a run of cases/continuum/creep.yaml with
    the same slope, grains, fluid and Shields number."""
    run, column = Run(folder), Run(continuum) if continuum else None
    if column is not None and "continuum" not in column.profiles:
        raise RunFolderError(f"{continuum}: not a run with system: continuum.")
    report(run, column)
    return two_phases.comparison_figure(run, column)
