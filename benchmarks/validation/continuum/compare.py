#!/usr/bin/env python3
"""Figure 10 of Zhang et al. (2022): q* against the Shields number of the columns of a sweep, and profiles of a column.

    compare.py POINTS GRIDS [RESOLVED...]

POINTS, GRIDS: folders of `thalweg sweep points.yaml` and `grids.yaml`. RESOLVED: run folders of beds with
analysis.stress_balance, whose profiles are drawn over those of the column at slope 0.010 and a Shields number of 0.085.
Writes continuum.csv and continuum.png next to this script; ends with exit code 1 if a column is not steady, or if
one with `drag_speed: streamwise` is more than 2 % from reference.csv.
"""
import csv
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

import thalweg
from thalweg import literature
from thalweg.tables import read_rows

BOUND, STEADY = 0.02, 1e-4
DIAMETER = 5e-3


def table(path):
    with open(path, newline="", encoding="utf-8") as file:
        return [{name.split(" [")[0]: value for name, value in row.items()} for row in csv.DictReader(file)]


def values(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


def compared(points):
    """Rows of continuum.csv: slope, Shields number, reference, q* of both readings, deviations in per cent."""
    found = {(row["closures.drag_speed"], float(row["gravity.slope"]), float(row["column.shields_number"])):
             float(row["figures.q_star"]) for row in points if row["state"] == "done"}
    rows = []
    for slope, shields, reference in values(table(HERE / "reference.csv"), "slope", "shields_number", "q_star"):
        pair = [found.get((speed, slope, shields), np.nan) for speed in ("streamwise", "total")]
        rows.append([slope, shields, reference, *pair, *(100.0 * (q / reference - 1.0) for q in pair)])
    return np.array(rows)


def draw_relation(axes, rows, resolved):
    shields = np.linspace(0.034, 0.15, 200)
    for relation, label in ((literature.meyer_peter_mueller, "Meyer-Peter and Müller"),
                            (literature.fernandez_luque_van_beek, "Fernandez Luque and van Beek"),
                            (literature.wong_parker, "Wong and Parker"),
                            (literature.zhang_wide_bed, "Zhang et al., as printed")):
        axes.plot(shields, relation(shields), lw=1, label=label)
    for slope, marker in ((0.010, "o"), (0.016, "s"), (0.030, "^")):
        of_slope = rows[rows[:, 0] == slope]
        axes.plot(of_slope[:, 1], of_slope[:, 4], marker, color="k", ms=5, label=f"column, slope {slope:g}")
        axes.plot(of_slope[:, 1], of_slope[:, 3], marker, mfc="none", mec="k", ms=5)
        axes.plot(of_slope[:, 1], of_slope[:, 2], "+", color="tab:red", ms=8,
                  label="reference" if slope == 0.030 else None)
    for row in resolved:
        axes.plot(*row, "*", color="tab:blue", ms=11, label="resolved" if row is resolved[0] else None)
    axes.set(xlabel="Shields number", ylabel="q*", yscale="log", ylim=(2e-3, 0.6),
             title="filled: Re_d with the drift, open: without")
    axes.legend(fontsize=7)


def surface(z, fraction):
    """Height of the highest point where the solid fraction reaches 0.31."""
    last = np.flatnonzero(fraction >= 0.31)[-1]
    return np.interp(0.31, fraction[last:last + 2][::-1], z[last:last + 2][::-1])


def draw_profiles(axes, profiles, style, label):
    z = (profiles["z"] - surface(profiles["z"], profiles["solid_fraction"])) / DIAMETER
    grains = np.where(profiles["solid_fraction"] > 1e-3, profiles["grain_velocity"][:, 0], np.nan)
    for name, of_name, color in (("fraction", profiles["solid_fraction"], "tab:brown"),
                                 ("U_s, m/s", grains, "tab:orange"),
                                 ("U_f, m/s", profiles["fluid_velocity"][:, 0], "tab:blue")):
        axes.plot(of_name, z, style, color=color, lw=1.3, label=f"{name}, {label}")


def main(points_folder, grids_folder, *resolved_folders):
    points = table(Path(points_folder) / "runs.csv")
    rows = compared(points)
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.6))
    resolved = read_rows(HERE.parent / "wide_bed" / "relation.csv")
    draw_relation(left, rows, [(float(row["Shields number [1]"]), float(row["q_star [1]"])) for row in resolved])
    for speed, style in (("total", "-"), ("streamwise", ":")):
        folder = Path(points_folder) / "runs" / f"drag_speed_{speed}-slope_0.01-shields_number_0.085"
        draw_profiles(right, thalweg.Run(folder).profiles["continuum"], style, speed)
    for folder in resolved_folders:
        draw_profiles(right, thalweg.Run(folder).profiles["stress_balance"], "--", Path(folder).name)
    right.set(
        ylim=(-2.5, 5.0), xlim=(0.0, 1.0), ylabel="height over the surface, d",
        title="slope 0.010, Shields number 0.085",
    )
    right.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(HERE / "continuum.png", dpi=110)
    header = ("slope", "shields_number", "reference", "streamwise", "total", "streamwise_off_%", "total_off_%")
    with open(HERE / "continuum.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows([[f"{value:.4g}" for value in row] for row in rows])
    print(" ".join(f"{name:>16}" for name in header))
    for row in rows:
        print(" ".join(f"{value:16.4g}" for value in row))
    for row in table(Path(grids_folder) / "runs.csv"):
        print(row["closures.drag_speed"], row["column.shields_number"], row["column.cells_per_diameter"],
              row["figures.q_star"], row["state"])
    steady = all(row["state"] == "done" and float(row["figures.unsteadiness"]) < STEADY for row in points)
    worst = np.max(np.abs(rows[:, 5]))
    print(
        f"steady: {steady}; largest deviation of streamwise {worst:.2g} %, of total {np.max(np.abs(rows[:, 6])):.2g} %"
    )
    return 0 if steady and worst <= 100.0 * BOUND else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
