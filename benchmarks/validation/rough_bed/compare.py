#!/usr/bin/env python3
"""Mean velocity over a rough bed compared with direct simulations: compare.py [RUN...] [--table FILE] [--figure FILE]

RUN: folders of runs of the case of tutorial 5; each becomes a row of the table (rows of other runs stay). The mean
velocity is that of the last third of the run. Prints it next to that of Mazzuoli and Uhlmann (2017), and pass or fail.
Exit code 0 if all pass.
"""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

from thalweg import Run
from thalweg.checks import Verdict
from thalweg.comparison import compared_rows
from thalweg.literature import SPHERE_CHANNEL_MEAN
from thalweg.rough_bed import rough_flow, roughness_of

COLUMNS = [
    "run", "cells [1]", "subgrid_model", "grain_reynolds_number [1]", "depth [d]", "mean_velocity [u*]", "error [u*]",
    "roughness [d]",
]
ACCEPTED = 0.05   # of the mean velocity: rounding of the simulations' printed numbers and two standard errors of a run


def subgrid_model(fluid):
    """C_s of Smagorinsky's model, or the name of another."""
    return fluid.get("smagorinsky_constant") or fluid["subgrid_model"]


def measured(folder):
    run = Run(folder)
    flow = rough_flow(run, 2.0 / 3.0 * run.series["time"][-1])
    values = [f"{run.diameter / float(run.case['domain']['spacing']):.4g}", subgrid_model(run.case["fluid"])]
    numbers = [flow.grain_reynolds, flow.depth, flow.bulk_velocity, flow.bulk_error, flow.roughness]
    return dict(zip(COLUMNS, [run.folder.name, *map(str, values), *[f"{number:.4g}" for number in numbers]]))


def report(rows):
    verdict = Verdict()
    for row in rows:
        model = row["subgrid_model"]
        v = {column: float(row[column]) for column in COLUMNS[1:] if column != "subgrid_model"}
        difference = v["mean_velocity [u*]"] / SPHERE_CHANNEL_MEAN - 1.0
        good = abs(difference) <= ACCEPTED
        print(
            f"{row['run']}: {v['cells [1]']:.3g} cells, {model if model.isalpha() else 'C_s ' + model}, mean velocity"
            f" {v['mean_velocity [u*]']:.2f} +- {v['error [u*]']:.2f} u* (reference {SPHERE_CHANNEL_MEAN:.2f},"
            f" {100 * difference:+.0f} %), k_s {v['roughness [d]']:.2f} d"
            f" ({roughness_of(SPHERE_CHANNEL_MEAN, v['depth [d]']):.2f}): {verdict(good)}"
        )
    return verdict.exit_code


def draw(rows, name):
    figure, axes = plt.subplots(figsize=(5.6, 4.0), layout="constrained")
    models = sorted({row["subgrid_model"] for row in rows})   # numbers come before names
    for cells, colour in (("6", "#c0392b"), ("10", "#14496e")):
        chosen = sorted((row for row in rows if row["cells [1]"] == cells), key=lambda row: row["subgrid_model"])
        of = lambda column: np.array([float(row[column]) for row in chosen])
        axes.errorbar(
            [models.index(row["subgrid_model"]) for row in chosen], of("mean_velocity [u*]") / SPHERE_CHANNEL_MEAN,
            of("error [u*]") / SPHERE_CHANNEL_MEAN, marker="o", color=colour, capsize=3,
            label=f"{cells} cells a diameter",
        )
    axes.axhspan(1.0 - ACCEPTED, 1.0 + ACCEPTED, color="0.9")
    axes.set_xticks(range(len(models)), models)
    axes.set(xlabel="subgrid model, or its constant $C_s$", ylabel="mean velocity over that of the direct simulation")
    axes.grid(color="#e5e8ea", linewidth=0.8)
    axes.legend(frameon=False, fontsize=9)
    figure.savefig(name, dpi=110)


def main():
    rows, figure = compared_rows(
        __doc__, HERE / "rough_bed.csv", HERE / "rough_bed.png", lambda folder: [measured(folder)]
    )
    exit_code = report(rows)
    draw(rows, figure)
    return exit_code


if __name__ == "__main__":
    sys.exit(main())
