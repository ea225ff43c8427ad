#!/usr/bin/env python3
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

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import thalweg_python

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import thalweg
from thalweg import drawing, film, height_profiles, transport
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


RATE_COLOUR, SMOOTH_COLOUR, MEAN_COLOUR = "#9bbfd6", "#14496e", "#c0392b"
LEAST_SHARE = 0.35   # of the axis that the rates in the averaging window fill; below, a second panel enlarges them


def mean_transport(run):
    """The mean that run.log has, or None before the first measurement that counts."""
    try:
        return transport.transport(run)
    except thalweg.RunFolderError:
        return None


def draw_rates(axes, time, rate, found):
    """The measured rates and their running mean over a tenth of the time; behind them the averaging window, with the mean in a
    band of one standard error on either side."""
    axes.plot(time, rate, color=RATE_COLOUR, linewidth=0.9, zorder=3, label="measured")
    if len(time) > 100:
        window = 0.1 * (time[-1] - time[0])
        axes.plot(time, running_mean(time, rate, window), color=SMOOTH_COLOUR, linewidth=1.6, zorder=4,
                  label=f"running mean over {window:.2g} s")
    if found is not None:
        axes.axvspan(found.start, found.stop, color="0.94", lw=0, zorder=0)
        mean, error = found.rate.mean, found.rate.error
        if np.isfinite(error):
            axes.fill_between((found.start, found.stop), mean - error, mean + error, color=MEAN_COLOUR, alpha=0.2, lw=0, zorder=1)
        axes.hlines(mean, found.start, found.stop, color=MEAN_COLOUR, linewidth=1.4, zorder=5,
                    label=f"mean from {found.start:.4g} to {found.stop:.4g} s: {mean:.4g} \u00b1 {error:.2g}{found.unit}")
    axes.spines[["top", "right"]].set_visible(False)


def padded(values):
    """Axis limits that show all of the values, and nought."""
    low, high = min(0.0, float(np.min(values))), max(0.0, float(np.max(values)))
    span = (high - low) or 1.0
    return low - (0.05 * span if low < 0.0 else 0.0), high + 0.05 * span


def draw_transport_rate(run, path):
    """All measured q* against time with their running mean, and the mean with its error that run.log has over its time; where a
    start carries so much that this hardly shows, once more below, enlarged."""
    series = run.series
    name, label = "q_star", r"$q^* = q_s\,/\sqrt{(s-1)\,g\,d^3}$"
    if name not in series:
        name, label = "q_s", r"$q_s$ [m$^2$/s]"
    if name not in series:
        raise thalweg.RunFolderError(f"{run.folder / 'series.csv'}: it has no column q_star "
                                     "(analysis.transport_rate in the case).")
    known = np.isfinite(series[name])
    time, rate = series["time"][known], series[name][known]
    if not len(time):
        raise thalweg.RunFolderError(f"{run.folder / 'series.csv'}: it has no measurement of the transport rate yet.")
    found = mean_transport(run)
    inside = rate[(time >= found.start) & (time <= found.stop)] if found is not None else rate
    enlarged = np.ptp(padded(inside)) < LEAST_SHARE * np.ptp(padded(rate))
    figure, panels = plt.subplots(2 if enlarged else 1, 1, figsize=(6.4, 5.4 if enlarged else 3.6), squeeze=False,
                                  constrained_layout=True)
    for axes, shown in zip(panels[:, 0], (rate, inside)):
        draw_rates(axes, time, rate, found)
        axes.set(ylabel=label, ylim=padded(shown))
    end = time[-1] if time[-1] > time[0] else time[0] + 1.0
    panels[0, 0].set(xlim=(time[0], end))
    if enlarged:
        panels[1, 0].set(xlim=(found.start, max(found.stop, found.start + 1e-3 * end)))
        panels[1, 0].set_title("the averaging window, enlarged", fontsize=10)
    panels[-1, 0].set_xlabel("time $t$ [s]")
    panels[0, 0].legend(frameon=False, fontsize=9, ncol=3, loc="lower center", bbox_to_anchor=(0.5, 1.0), columnspacing=1.2,
                        handlelength=1.6)
    figure.suptitle(run.name, fontsize=11)
    figure.align_ylabels()
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
