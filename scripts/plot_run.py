#!/usr/bin/python3
"""Draws a run: bed.png (side view of the grains in front of the flow), transport_rate.png (q* against time) and profiles.png.

    plot_run.py RUN_FOLDER [--out FOLDER] [--time SECONDS] [--movie FILE]

profiles.png shows means against height, as far as profiles.h5 has them: for a bed the solid fraction, the velocities of grains and
fluid, and the stresses beside the driving stress (analysis.grain_profiles, stress_balance), for a fluid alone the velocity and the
Reynolds stresses (analysis.fluid_statistics). For a fluid alone flow.png shows the flow in the middle plane. --movie writes the side
view of all stored frames as a .gif, as an .mp4 (where ffmpeg is installed) or as numbered images in a folder;
python/figures/movie.py has more options.

Works on a finished run and on one in progress. The interpreter is Debian's own, whose packages scripts/setup
installs.
"""
import argparse
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import thalweg
from thalweg import drawing, film, height_profiles
from thalweg.means import running_mean


def save(figure, path):
    figure.savefig(path, dpi=150)
    plt.close(figure)


def draw_bed(run, time, path):
    """The grains, coloured by speed, in front of the fluid's speed in the middle plane, from the frames nearest to each other
    in time."""
    if time is None and run.fluid:
        time = run.fluid.times[-1]
    grains = run.grains.nearest(time)
    if grains is None:
        raise thalweg.RunFolderError(f"{run.folder}: no picture of the grains yet (output.grains.every in the case).")
    save(drawing.bed_figure(run, grains, run.fluid.nearest(grains.time)), path)


def draw_fluid_profiles(run, path):
    """Mean velocity along x and Reynolds stresses against height."""
    means = run.profiles["fluid_statistics"]
    z, velocity, stress = 1e3 * means["z"], means["velocity"][:, 0], means["reynolds_stress"]
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.8), sharey=True, constrained_layout=True)
    left.plot(velocity, z, color="#14496e")
    left.set(xlabel="mean velocity along x [m/s]", ylabel="z [mm]")
    for column, label in ((0, "$u'u'$"), (1, "$v'v'$"), (2, "$w'w'$"), (4, "$u'w'$")):
        right.plot(stress[:, column], z, label=label)
    right.set(xlabel=r"Reynolds stress [m$^2$/s$^2$]")
    right.legend(frameon=False, fontsize=9)
    for axes in (left, right):
        axes.grid(**height_profiles.GRID)
    figure.suptitle(run.name, fontsize=11)
    save(figure, path)


def range_of_interest(rate, counted):
    """Axis limits that leave out the start, when settling grains may carry tens of times as much."""
    low, high = min(0.0, 1.05 * float(np.min(rate))), 1.08 * float(np.max(rate))
    if 0.0 < np.max(counted) < 0.25 * np.max(rate):
        high = 1.5 * float(np.max(counted))
    return low, high if high > low else low + 1.0


def draw_transport_rate(run, path):
    """q* against time with its running mean and the mean that summary.json reports."""
    series = run.series
    name, label = "q_star", r"transport rate $q^*$ [1]"
    if name not in series:
        name, label = "q_s", r"transport rate $q_s$ [m$^2$/s]"
    if name not in series:
        raise thalweg.RunFolderError(f"{run.folder / 'series.csv'}: it has no column q_star "
                                     "(analysis.transport_rate in the case).")
    time, rate = series["time"], series[name]
    start = float(((run.case.get("analysis") or {}).get("transport_rate") or {}).get("from", 0.0))
    figure, axes = plt.subplots(figsize=(7.6, 3.8), constrained_layout=True)
    axes.plot(time, rate, color="#9bbfd6", linewidth=0.9, label="measured")
    window = 0.1 * (time[-1] - time[0])
    if len(time) > 20:
        axes.plot(time, running_mean(time, rate, window), color="#14496e", linewidth=1.8,
                  label=f"mean over {window:.2g} s")
    counted = time >= start
    if counted.any():
        mean = float(np.mean(rate[counted]))
        axes.hlines(mean, max(start, time[0]), time[-1], color="#c0392b", linestyle="--", linewidth=1.3,
                    label=f"mean from {start:g} s on: {mean:.3g}")
    axes.set(xlabel="time [s]", ylabel=label, xlim=(time[0], time[-1] if time[-1] > time[0] else time[0] + 1))
    axes.set_ylim(*range_of_interest(rate, rate[counted] if counted.any() else rate))
    axes.set_title(run.name, fontsize=11)
    axes.grid(**height_profiles.GRID)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=9)
    save(figure, path)


def pictures_of(run, time):
    """Names of the pictures that the system and the case call for, and the functions that draw them."""
    case, analysis = run.case, run.case.get("analysis") or {}
    if case.get("system") == "fluid":
        pictures = [("flow.png", lambda path: save(drawing.flow_figure(run, run.fluid.nearest(time)), path))]
        if "fluid_statistics" in analysis and "fluid_statistics" in run.profiles:
            pictures.append(("profiles.png", lambda path: draw_fluid_profiles(run, path)))
        return pictures
    pictures = [("bed.png", lambda path: draw_bed(run, time, path))]
    if "transport_rate" in analysis:
        pictures.append(("transport_rate.png", lambda path: draw_transport_rate(run, path)))
    if height_profiles.has_grains(run) and height_profiles.measured(run):
        pictures.append(("profiles.png", lambda path: save(height_profiles.figure_of(run), path)))
    return pictures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run_folder", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, help="folder for the pictures (default: the run folder)")
    parser.add_argument("--time", type=float, help="simulated time in s of bed.png (default: the last picture)")
    parser.add_argument("--movie", type=pathlib.Path, metavar="FILE", help="film of the side view: a .gif, an .mp4 or a folder")
    arguments = parser.parse_args()
    folder = arguments.run_folder
    out = arguments.out or folder
    try:
        if arguments.time is not None and not math.isfinite(arguments.time):
            raise thalweg.RunFolderError(f"--time {arguments.time}: give a time in s.")
        run = thalweg.Run(folder)
        out.mkdir(parents=True, exist_ok=True)
        for name, draw in pictures_of(run, arguments.time):
            draw(out / name)
            print(out / name)
        if arguments.movie:
            film.write_film(run, film.chosen_frames(run), arguments.movie)
            print(arguments.movie)
    except thalweg.RunFolderError as error:
        print(f"plot_run: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
