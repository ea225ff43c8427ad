#!/usr/bin/env python3
"""Laminar bed load beside the simulations of Biegert et al. (2017) and the experiment of Aussillous et al. (2013):
compare.py [RUN...] [--table FILE] [--figure FILE]

RUN: folders of runs of case.yaml, which begin on the bed of another run; each becomes a row of the table (rows of other
runs stay). Profiles are means from `analysis.grain_profiles.from` on: those of the run or, where it gathered them
over another time, of the frames of the grains. Prints each run with the reference of the nearest bulk Reynolds number, and pass or fail. Exit code 0 if all pass.
"""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

from thalweg import Run, mean_with_error
from thalweg.bed import has_profiles_of
from thalweg.checks import Verdict
from thalweg.comparison import compared_rows
from thalweg.layers import layer_profiles
from thalweg.tables import read_rows

COLUMNS = [
    "run", "cells [1]", "friction [1]", "kinetic_friction [1]", "from [s]", "until [s]", "reynolds_number [1]",
    "clear_height [diameter]", "shields_number [1]", "bed_fraction [1]", "volume_rate [1]", "error [1]",
    "independent [1]", "solid_rate [1]", "mobile_layer [diameter]",
]
SURFACE = 0.05             # solid fraction at the surface of the bed, as in the reference
MOVING = 0.01              # of the velocity of the grains at the surface, above which they count as mobile
ACCEPTED = 0.2             # of the rate of the reference


def height_of_surface(z, fraction):
    """Height (m) at which the solid fraction falls below SURFACE, from above, between the middles of two layers."""
    last = np.flatnonzero(fraction >= SURFACE)[-1]
    share = (fraction[last] - SURFACE) / (fraction[last] - fraction[last + 1])
    return z[last] + share * (z[last + 1] - z[last])


def measured(folder):
    run = Run(folder)
    case = run.case
    grains, fluid = case["grains"][0], case["fluid"]
    d, nu = float(grains["diameter"]), float(fluid["kinematic_viscosity"])
    start, stop = float(case["analysis"]["grain_profiles"]["from"]), run.series["time"][-1]
    later = run.series["time"] >= start
    gathered = has_profiles_of(run, start, stop)
    layers = run.profiles["grain_profiles"] if gathered else layer_profiles(run, start, stop, 0.25 * d)
    z, fraction, velocity = layers["z"], layers["solid_fraction"], np.nan_to_num(layers["velocity"][:, 0])
    surface = height_of_surface(z, fraction)
    thickness = z[1] - z[0]
    below = np.clip((surface - z) / thickness + 0.5, 0.0, 1.0)      # part of each layer below the surface
    # Discharge per width (m^2/s) of the fluid; series.csv has the momentum of the whole box.
    discharge = np.mean(run.series["fluid_momentum_x"][later]) / (float(fluid["density"]) * run.size[0] * run.size[1])
    solid = mean_with_error(run.series["q_s"][later])
    clear = run.size[2] - surface
    ratio = float(grains["density"]) / float(fluid["density"]) - 1.0
    galileo_squared = ratio * float(case["gravity"]["magnitude"]) * d**3 / nu**2
    at_surface = np.interp(surface, z, velocity)
    mobile = z[velocity >= MOVING * at_surface]
    volume_rate = float(np.sum(below * velocity) * thickness / discharge)
    core = (z > 0.3 * surface) & (z < 0.7 * surface)
    values = [
        start, stop, discharge / nu, clear / d, 6.0 * discharge / nu / galileo_squared * (d / clear)**2,
        fraction[core].mean(), volume_rate, volume_rate * solid.error / solid.mean,
        solid.independent, solid.mean / discharge, (surface - mobile.min()) / d,
    ]
    friction = float(case["contact"]["friction"])
    kinetic = friction * float(case["contact"].get("kinetic_friction_ratio", 1.0))
    names = [run.folder.name, f"{d / float(case['domain']['spacing']):.4g}", f"{friction:g}", f"{kinetic:g}"]
    return dict(zip(COLUMNS, names + [f"{float(value):.4g}" for value in values]))


def friction_of(row):
    static, kinetic = row["friction [1]"], row["kinetic_friction [1]"]
    return f"friction {static}" + (f", sliding {kinetic}" if kinetic != static else "")


def reference_of(reynolds, references):
    return min(references, key=lambda row: abs(float(row["reynolds_number [1]"]) / reynolds - 1.0))


def report(rows, references):
    verdict = Verdict()
    for row in rows:
        v = {column: float(row[column]) for column in COLUMNS[1:]}
        reference = reference_of(v["reynolds_number [1]"], references)
        theirs = {column: float(reference[column]) for column in reference if column != "case"}
        rate = v["volume_rate [1]"]
        in_range = theirs["experiment_low [1]"] <= rate <= theirs["experiment_high [1]"]
        good = in_range and abs(rate / theirs["volume_rate [1]"] - 1.0) <= ACCEPTED
        print(
            f"{row['run']}: {row['cells [1]']} cells, {friction_of(row)}, {v['from [s]']:g} to"
            f" {v['until [s]']:.3g} s, Re_b {v['reynolds_number [1]']:.3g} ({reference['case']}:"
            f" {theirs['reynolds_number [1]']:g}), clear height {v['clear_height [diameter]']:.2f} d"
            f" ({theirs['clear_height [diameter]']:g}), Shields number {v['shields_number [1]']:.3f}"
            f" ({theirs['shields_number [1]']:g}), bed {v['bed_fraction [1]']:.3f}, q_v/q_f {rate:.3g} +-"
            f" {v['error [1]']:.1g} ({theirs['volume_rate [1]']:g}, {100 * (rate / theirs['volume_rate [1]'] - 1):+.0f} %;"
            f" experiment {theirs['experiment_low [1]']:g} to {theirs['experiment_high [1]']:g}), mobile layer"
            f" {v['mobile_layer [diameter]']:.1f} d: {verdict(good)}"
        )
    return verdict.exit_code


def draw(rows, references, name):
    figure, ax = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
    of = lambda table, column: np.array([float(row[column]) for row in table])
    shields, mean = of(references, "experiment_shields [1]"), of(references, "experiment_mean [1]")
    spread = np.abs([mean - of(references, "experiment_low [1]"), of(references, "experiment_high [1]") - mean])
    ax.errorbar(shields, mean, spread, of(references, "experiment_shields_error [1]"), fmt="s", color="0.6", capsize=3,
                label="experiment, Aussillous et al. 2013")
    ax.plot(of(references, "shields_number [1]"), of(references, "volume_rate [1]"), "k^",
            label="simulations, Biegert et al. 2017")
    for friction in sorted({friction_of(row) for row in rows}, reverse=True):
        chosen = [row for row in rows if friction_of(row) == friction]
        ax.errorbar(of(chosen, "shields_number [1]"), of(chosen, "volume_rate [1]"), of(chosen, "error [1]"), fmt="o",
                    capsize=3, label=f"Thalweg, {friction}")
    ax.set(yscale="log", xlabel="Shields number", ylabel="$q_v/q_f$")
    ax.grid(color="#e5e8ea", linewidth=0.8)
    ax.legend(fontsize=8)
    figure.savefig(name, dpi=110)
    print(name)


def main():
    references = read_rows(HERE / "references.csv")
    rows, figure_name = compared_rows(
        __doc__, HERE / "runs.csv", "laminar_bed_load.png", lambda folder: [measured(folder)]
    )
    exit_code = report(rows, references)
    draw(rows, references, figure_name)
    return exit_code


if __name__ == "__main__":
    sys.exit(main())
