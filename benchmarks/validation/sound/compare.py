#!/usr/bin/env python3
"""Sound on the lattice against theory: compare.py waves WAVES.CSV [--figure FILE]
The column released from rest:          compare.py column RUN_FOLDER... [--figure FILE] [--table FILE]

waves: speed and damping of standing waves measured by bin/sound, against s^2 + s k^2 [4/3 nu/(1 + s (tau - 1/2)) +
zeta/(1 + s (tau_b - 1/2))] + k^2/3 = 0, zeta = 2/9 (tau_b - 1/2). Prints the largest differences for each collision.
column: mean velocity of the grains over Stokes' with Schiller and Naumann's correction, against time. Prints its
largest value and its oscillation about the mean over one period of sound, in four parts of the run.
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

import thalweg
from thalweg.checks import Verdict
from thalweg.tables import read_rows

ACCEPTED = 0.02  # of speed and damping, where the wave is slower than the stress: w tau_b < 1


def theory(k, tau, tau_b):
    nu, zeta = (tau - 0.5) / 3, 2 / 9 * (tau_b - 0.5)
    s = 1j * k / 3 ** 0.5
    for _ in range(200):
        half = k * k / 2 * (4 / 3 * nu / (1 + s * (tau - 0.5)) + zeta / (1 + s * (tau_b - 0.5)))
        s = -half + 1j * np.sqrt(k * k / 3 - half * half)
    return s


def compare_waves(file, figure):
    rows = read_rows(file)
    plt.figure(figsize=(6, 4))
    verdict = Verdict()
    for collision in ("bgk", "trt"):
        worst_speed = worst_damping = 0.0
        for row in (r for r in rows if r["collision"] == collision):
            k, tau, tau_b = 2 * np.pi / int(row["cells"]), float(row["tau"]), float(row["tau_b"])
            s = theory(k, tau, tau_b or tau)
            if abs(s) * tau_b > 1:
                continue
            worst_speed = max(worst_speed, abs(float(row["speed"]) * k / s.imag - 1))
            worst_damping = max(worst_damping, abs(float(row["damping"]) / -s.real - 1))
        good = max(worst_speed, worst_damping) <= ACCEPTED
        print(f"{collision}: speed within {100 * worst_speed:.2f} %, damping within {100 * worst_damping:.2f} % where "
              f"w tau_b < 1: {verdict(good)}")
    times = np.geomspace(0.51, 300, 200)
    for cells, colour in ((96, "C0"), (384, "C1")):
        k = 2 * np.pi / cells
        plt.loglog(times, [-theory(k, 0.503, t).real for t in times], colour, label=f"theory, {cells} cells a wave")
        for collision, mark in (("bgk", "o"), ("trt", "^")):
            shown = [r for r in rows if r["collision"] == collision and int(r["cells"]) == cells
                     and float(r["tau"]) == 0.503 and float(r["tau_b"]) > 0]
            plt.loglog([float(r["tau_b"]) for r in shown], [float(r["damping"]) for r in shown], colour + mark,
                       fillstyle="none", label=collision if cells == 96 else None)
    plt.xlabel("bulk relaxation time [steps]")
    plt.ylabel("damping of sound [1/step], tau = 0.503")
    plt.legend(fontsize=8)
    plt.tight_layout()
    plt.savefig(figure, dpi=110)
    return verdict.exit_code


def velocity_of(run):
    """Times (s) and mean velocity downwards (m/s) of the grains."""
    return run.grains.times, np.array([-frame.velocity[:, 2].mean() for frame in run.grains])


def compare_column(runs, figure, table):
    figure_axes = plt.subplots(2, 1, figsize=(7, 6), sharex=True)
    columns = {}
    for run in runs:
        folder = thalweg.Run(run)
        case = folder.case
        settling = case["fluid"]["kinematic_viscosity"] / case["grains"][0]["diameter"]  # Re_t = 1
        period = 2 * case["domain"]["size"][2] / case["domain"]["spacing"] * 3 ** 0.5 * case["fluid"]["time_step"]
        times, velocity = velocity_of(folder)
        velocity = velocity / settling
        window = int(round(period / (times[1] - times[0])))
        swing = velocity - np.convolve(velocity, np.ones(window) / window, "same")
        inside = slice(window // 2, len(swing) - window // 2)
        parts = [np.std(part) for part in np.array_split(swing[inside], 4)]
        print(f"| {run.name} | {velocity.max():.3f} | " + " | ".join(f"{part:.4f}" for part in parts)
              + f" | {velocity[inside][-window:].mean():.4f} |")
        ramped = case["run"]["ramp"] > 0
        label = f"tau_b = {case['fluid']['bulk_relaxation_time']:g}" + (", ramp" if ramped else "")
        figure_axes[1][1 if ramped else 0].plot(times, velocity, label=label, linewidth=1)
        columns["time [s]"], columns[run.name] = times, velocity
    for axes in figure_axes[1]:
        axes.set_ylabel("mean velocity / settling velocity")
        axes.legend(loc="lower right", fontsize=8)
    figure_axes[1][1].set_xlabel("time [s]")
    plt.tight_layout()
    plt.savefig(figure, dpi=110)
    if table:
        with open(table, "w", encoding="utf-8") as file:
            file.write(",".join(columns) + "\n")
            for row in list(zip(*columns.values()))[::4]:
                file.write(",".join(f"{value:.5g}" for value in row) + "\n")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    waves = commands.add_parser("waves")
    waves.add_argument("file", type=Path)
    waves.add_argument("--figure", default="waves.png")
    column = commands.add_parser("column")
    column.add_argument("runs", nargs="+", type=Path, metavar="RUN_FOLDER")
    column.add_argument("--figure", default="column.png")
    column.add_argument("--table")
    arguments = parser.parse_args()
    if arguments.command == "waves":
        return compare_waves(arguments.file, arguments.figure)
    return compare_column(arguments.runs, arguments.figure, arguments.table)


if __name__ == "__main__":
    sys.exit(main())
