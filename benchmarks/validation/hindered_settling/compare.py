#!/usr/bin/env python3
"""Settling velocity of suspensions against solid fraction, compared with Richardson and Zaki (1954):
compare.py [RUN...] [--table FILE] [--figure FILE]

RUN: folders of runs of hindered_settling.yaml; each becomes a row of the table (rows of other runs stay). The velocity
of the grains relative to that of the whole volume is averaged from a third of the run on and corrected for the size of
the box (Ladd 1990). Prints it over that of a single sphere (Schiller and Naumann) and, for each Reynolds number, the
exponent n of (1 - phi)^n with its error, with and without that correction, the exponent of Richardson and Zaki, the
accepted difference, and pass or fail of the corrected exponent. Exit code 0 if all pass.
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
from thalweg.literature import settling_speed

COLUMNS = ["run", "reynolds_number [1]", "solid_fraction [1]", "grains [1]", "velocity [m/s]", "velocity_error [m/s]",
           "single_sphere [m/s]"]
ACCEPTED = 0.3


def exponent_of_richardson_and_zaki(reynolds):
    """n for spheres far from walls, at the Reynolds number of a single one."""
    return 4.65 if reynolds < 0.2 else 4.35 * reynolds**-0.03 if reynolds < 1.0 else 4.45 * reynolds**-0.1


def missing_in_a_small_box(fraction, count):
    """Velocity lost in a periodic box, over that of a single sphere: 1.76 S(0) (eta/eta_s) (phi/N)^(1/3), with the
    structure factor of hard spheres (Carnahan and Starling) and the viscosity eta_s of the suspension (Krieger and
    Dougherty); A. J. C. Ladd, J. Chem. Phys. 93 (1990) 3484. For slow flow."""
    structure = (1.0 - fraction)**4 / (1.0 + 4.0 * fraction + 4.0 * fraction**2 - 4.0 * fraction**3 + fraction**4)
    fluidity = (1.0 - fraction / 0.64)**1.6
    return 1.76 * structure * fluidity * (fraction / count)**(1.0 / 3.0)


def measured(folder):
    run = Run(folder)
    grains, fluid = run.case["grains"][0], run.case["fluid"]
    diameter, density = float(grains["diameter"]), float(grains["density"])
    solid = run.summary["grains"] * np.pi / 6.0 * diameter**3
    fraction = solid / run.size.prod()
    later = run.series["time"] > run.series["time"][-1] / 3.0
    of_grains = run.series["grain_momentum_z"][later] / (density * solid)
    of_fluid = run.series["fluid_momentum_z"][later] / (float(fluid["density"]) * run.size.prod() * (1.0 - fraction))
    settling = mean_with_error((1.0 - fraction) * (of_fluid - of_grains))   # relative to the volume
    density_ratio, viscosity = density / float(fluid["density"]), float(fluid["kinematic_viscosity"])
    alone = settling_speed(diameter, density_ratio, float(run.case["gravity"]["magnitude"]), viscosity)
    reynolds = alone * diameter / viscosity
    values = [reynolds, fraction, run.summary["grains"], settling.mean, settling.error, alone]
    return dict(zip(COLUMNS, [run.folder.name] + [f"{value:.6g}" for value in values]))


def main():
    rows, figure_name = compared_rows(
        __doc__, HERE / "velocities.csv", "hindered_settling.png", lambda folder: [measured(folder)]
    )
    table = np.array([[float(row[column]) for column in COLUMNS[1:]] for row in rows])
    figure, axes = plt.subplots(figsize=(6, 4.5), layout="constrained")
    verdict = Verdict()
    for reynolds, colour in zip(np.unique(np.round(table[:, 0], 3)), ("tab:blue", "tab:red", "k")):
        of_this = table[np.isclose(table[:, 0], reynolds, atol=1e-3)]
        of_this = of_this[np.argsort(of_this[:, 1])]
        phi, ratio, error = of_this[:, 1], of_this[:, 3] / of_this[:, 5], of_this[:, 4] / of_this[:, 5]
        missing = missing_in_a_small_box(phi, of_this[:, 2])
        for p, r, e, m in zip(phi, ratio, error, missing):
            print(
                f"Re {reynolds:<6g} solid fraction {p:.3f}: {r:.3f} +- {e:.3f} of a single sphere, in a large box"
                f" {r + m:.3f}"
            )
        ratio = ratio + missing
        expected = exponent_of_richardson_and_zaki(reynolds)
        axes.errorbar(phi, ratio, error, fmt="o", color=colour, capsize=3, label=f"Re {reynolds:g}")
        curve = np.linspace(0.0, 0.45, 50)
        axes.plot(curve, (1.0 - curve)**expected, color=colour, lw=0.8, label=f"(1 - φ)$^{{{expected:.2f}}}$")
        if len(phi) < 4:
            continue
        (slope, intercept), covariance = np.polyfit(np.log(1.0 - phi), np.log(ratio), 1, cov=True)
        in_this_box = np.polyfit(np.log(1.0 - phi), np.log(ratio - missing), 1)[0]
        good = abs(slope - expected) <= ACCEPTED
        print(
            f"Re {reynolds:<6g} n {slope:.2f} +- {np.sqrt(covariance[0, 0]):.2f}, {np.exp(intercept):.2f} at phi -> 0"
            f" ({in_this_box:.2f} uncorrected); Richardson and Zaki {expected:.2f}, accepted +- {ACCEPTED}:"
            f" {verdict(good)}"
        )
    axes.set(xlabel="solid fraction φ", ylabel="settling velocity over that of a single sphere", yscale="log")
    axes.grid(color="#e5e8ea", linewidth=0.8)
    axes.legend(fontsize=8)
    figure.savefig(figure_name, dpi=110)
    print(figure_name)
    return verdict.exit_code


if __name__ == "__main__":
    sys.exit(main())
