#!/usr/bin/env python3
"""Rheology of the shear cell and the flow rule of Zhang et al. (2022): compare.py [RUN...] [--table FILE] [--figure
FILE]

RUN: folders of runs of shear_cell.yaml or others of the same case; each becomes a row of the table (rows of other runs
stay). All values are means over the heights at least 1.5 diameters from the layers of glued grains. The error is that
of the stress on the top in time. Prints each run with eqs. 20 and 21, the viscosity of the suspension with the laws of
Batchelor and Green (1972) and Boyer et al. (2011), how much the stress differs over the height, and pass or fail. Exit
code 0 if all pass.
"""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

from thalweg import Run, mean_with_error
from thalweg.checks import Verdict
from thalweg.comparison import compared_rows
from thalweg.rheology import flow_state, mixed_fraction, mixed_friction, solid_stress

COLUMNS = [
    "run", "links", "cells [1]", "lubrication", "solid_fraction [1]", "shear_rate [1/s]", "fluid_viscosity [Pa s]",
    "pressure [Pa]", "normal_stress [Pa]", "shear_stress [Pa]", "contact_stress [Pa]", "kinetic_stress [Pa]",
    "fluid_part [Pa]", "total_stress [Pa]", "total_spread [1]", "error [1]", "viscous_number [1]", "mixed_number [1]",
]
ACCEPTED_FRACTION = 0.03   # of the solid fraction: half the distance of the jammed states of rough and smooth spheres
ACCEPTED_FRICTION = 0.2    # of mu
ACCEPTED_DILUTE = 0.05     # of the viscosity below a solid fraction of 0.06


def stress_on_top(run):
    """Shear stress against time (Pa) on the upper wall and everything glued to it."""
    columns = ["grains_2_contact_force_x", "grains_2_fluid_force_x", "wall_force_top_x", "fluid_wall_force_top_x"]
    force = -sum(np.asarray(run.series[column]) for column in columns)
    return force / (run.size[0] * run.size[1])


def measured(folder):
    run = Run(folder)
    layers = run.profiles["stress_balance"]
    grains, fluid = run.case["grains"], run.case["fluid"]
    diameter = float(grains[0]["diameter"])
    viscosity = float(fluid["density"]) * float(fluid["kinematic_viscosity"])
    lower, upper = float(grains[1]["placement"]["region"]["upper"][2]), float(
        grains[2]["placement"]["region"]["lower"][2]
    )
    z = layers["z"]
    core = (z > lower + 1.5 * diameter) & (z < upper - 1.5 * diameter)
    phi = layers["solid_fraction"]
    velocity = phi * layers["grain_velocity"][:, 0] + (1.0 - phi) * layers["fluid_velocity"][:, 0]
    rate = np.polyfit(z[core], velocity[core], 1)[0]
    stress = solid_stress(layers)[core].mean(axis=0)
    state = flow_state(phi[core].mean(), stress, rate, diameter, float(grains[0]["density"]), viscosity)
    total = layers["total_stress"][core]
    later = run.series["time"] > run.averaged_from("stress_balance")
    on_top = mean_with_error(stress_on_top(run)[later])
    mean_of = lambda name, column: layers[name][core, column].mean()
    values = [
        state.solid_fraction, rate, viscosity, state.pressure, -stress[2, 2], state.shear_stress,
        mean_of("contact_stress", 2), mean_of("kinetic_stress", 4), mean_of("grain_fluid_stress", 2), total.mean(),
        np.ptp(total) / total.mean(), on_top.error / on_top.mean, state.viscous_number, state.mixed_number,
    ]
    coupling = run.case["coupling"]
    names = [
        run.folder.name, coupling.get("links", "bouzidi"), f"{diameter / float(run.case['domain']['spacing']):.4g}",
        "on" if "lubrication" in coupling else "off",
    ]
    return dict(zip(COLUMNS, names + [f"{float(value):.5g}" for value in values]))


def batchelor(phi):
    """Viscosity of a dilute suspension over that of the fluid; G. K. Batchelor and J. T. Green, J. Fluid Mech. 56 (1972)
    401; to first order that of Einstein. 7.6 is for a pure straining motion; in simple shear it depends on the pairs
    that orbit each other, and counts for less than 1 % at the fractions compared."""
    return 1.0 + 2.5 * phi + 7.6 * phi**2


def boyer(phi):
    """The same for a dense suspension; F. Boyer, E. Guazzelli, O. Pouliquen, Phys. Rev. Lett. 107 (2011) 188301."""
    densest, mu_1, mu_2, i_0 = 0.585, 0.32, 0.7, 0.005
    ratio = phi / (densest - phi)
    return 1.0 + 2.5 * phi / (1.0 - phi / densest) + (mu_1 + (mu_2 - mu_1) / (1.0 + i_0 * ratio**2)) * ratio**2


def boyer_friction(viscous_number):
    """Stress ratio of a dense suspension, over the stress normal to the shear (Boyer et al. 2011)."""
    return 0.32 + 0.38 / (1.0 + 0.005 / viscous_number) + viscous_number + 2.5 * 0.585 * np.sqrt(viscous_number)


def report(rows):
    verdict = Verdict()
    for row in sorted(rows, key=lambda row: float(row["solid_fraction [1]"])):
        v = {column: float(row[column]) for column in COLUMNS[4:]}
        phi, mixed = v["solid_fraction [1]"], v["mixed_number [1]"]
        mu, rule = v["shear_stress [Pa]"] / v["pressure [Pa]"], mixed_friction(phi, v["viscous_number [1]"], mixed)
        viscous = v["fluid_viscosity [Pa s]"] * v["shear_rate [1/s]"]   # Pa, of the fluid alone
        relative = v["total_stress [Pa]"] / viscous
        normal = v["normal_stress [Pa]"]
        of_boyer = v["total_stress [Pa]"] / normal, boyer_friction(viscous / abs(normal))
        good = abs(mu / rule - 1.0) <= ACCEPTED_FRICTION and abs(phi - mixed_fraction(mixed)) <= ACCEPTED_FRACTION
        if phi < 0.06:
            good = abs(relative / batchelor(phi) - 1.0) <= ACCEPTED_DILUTE
        print(
            f"{row['run']}: solid fraction {phi:.3f}, I_m {mixed:.3g} (eq. 21: {mixed_fraction(mixed):.3f}), mu"
            f" {mu:.3f} (eq. 20: {rule:.3f}, {100 * (mu / rule - 1):+.0f} %), over the normal stress"
            f" {of_boyer[0]:.3f} (Boyer {of_boyer[1]:.3f}), viscosity {relative:.3f} +-"
            f" {relative * v['error [1]']:.3f} (Batchelor {batchelor(phi):.3f}, Boyer"
            f" {boyer(phi) if phi < 0.58 else np.nan:.3g}), contacts"
            f" {100 * v['contact_stress [Pa]'] / v['total_stress [Pa]']:.0f} %, stress over the height"
            f" {100 * v['total_spread [1]']:.1f} %: {verdict(good)}"
        )
    return verdict.exit_code


DRAWN = (("resolved", "o"), ("a tenth of the rate", "D"), ("finer, wider or faster", "s"), ("with lubrication", "^"))


def kind_of(row):
    """How a run is drawn: as one of the sweep, with the lubrication correction, slowly, or with another difference."""
    if row["lubrication"] == "on":
        return "with lubrication"
    if float(row["shear_rate [1/s]"]) < 2.0:
        return "a tenth of the rate"
    return "resolved" if row["run"].startswith("solid_fraction") else "finer, wider or faster"


def draw(rows, name):
    of = lambda column: np.array([float(row[column]) for row in rows])
    phi, mixed, mu = of("solid_fraction [1]"), of("mixed_number [1]"), of("shear_stress [Pa]") / of("pressure [Pa]")
    relative, error = of("total_stress [Pa]") / (of("fluid_viscosity [Pa s]") * of("shear_rate [1/s]")), of("error [1]")
    kinds = np.array([kind_of(row) for row in rows])
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.2), layout="constrained")
    for kind, marker in DRAWN:
        chosen = kinds == kind
        style = {"fmt": marker, "capsize": 3, "label": kind}
        axes[0].errorbar(mixed[chosen], mu[chosen], (mu * error)[chosen], **style)
        axes[1].plot(mixed[chosen], phi[chosen], marker, label=kind)
        axes[2].errorbar(phi[chosen], relative[chosen], (relative * error)[chosen], **style)
    order = np.argsort(mixed)
    order = order[kinds[order] == "resolved"]
    rule = mixed_friction(phi, of("viscous_number [1]"), mixed)
    axes[0].plot(mixed[order], rule[order], "k-", lw=1, label="Zhang et al. 2022, eq. 20")
    axes[0].set(xscale="log", yscale="log", xlabel="mixed inertial number $I_m$", ylabel="stress ratio μ")
    curve = np.logspace(np.log10(np.nanmin(mixed)) - 0.1, np.log10(np.nanmax(mixed)) + 0.1, 100)
    axes[1].plot(curve, mixed_fraction(curve), "k-", lw=1, label="eq. 21")
    axes[1].set(xscale="log", xlabel="mixed inertial number $I_m$", ylabel="solid fraction φ")
    fractions = np.linspace(0.0, 0.575, 100)
    axes[2].plot(fractions, boyer(fractions), "k-", lw=1, label="Boyer et al. 2011")
    axes[2].plot(fractions[:40], batchelor(fractions[:40]), "k--", lw=1, label="Batchelor and Green 1972")
    axes[2].set(yscale="log", xlabel="solid fraction φ", ylabel="viscosity over the fluid's")
    for ax in axes:
        ax.grid(color="#e5e8ea", linewidth=0.8)
        ax.legend(fontsize=8)
    figure.savefig(name, dpi=110)
    print(name)


def main():
    rows, figure_name = compared_rows(
        __doc__, HERE / "rheology.csv", "shear_cell.png", lambda folder: [measured(folder)]
    )
    exit_code = report(rows)
    draw(rows, figure_name)
    return exit_code


if __name__ == "__main__":
    sys.exit(main())
