"""q* against the Shields number, as fig. 3(a) of Zhang et al. (2022).

Draws their printed points (bars: standard deviation of q* over the last 10 s), relations of the literature and the
given runs, whose means, standard errors (bars) and verdicts are those of run.log unless times are given. The Shields
number of a run is that of its slope and its measured surface. Open symbols: not steady, or too short to tell. Prints
the table.
"""
import sys

import matplotlib.pyplot as plt
import numpy as np

from thalweg import bed, literature
from thalweg.errors import RunFolderError
from thalweg.run import Run
from thalweg.tables import merged_rows
from thalweg.transport import transport

SMALLEST = 1e-3   # q* that is drawn; what is below stands on the axis
DRAWN = "run", "Shields number [1]", "q_star [1]", "error [1]", "steady"   # headings of the table that the figure needs
VERDICTS = {True: "yes", False: "no", None: "too short"}


def measure(folder, start, stop, surface):
    """Shields number, q* (Mean), steadiness and height of the bed over the diameter."""
    run = Run(folder)
    found = transport(run, start, stop)
    if found.symbol != "q*":
        raise RunFolderError(f"{run.folder}: there is no q* of grains without a fluid.")
    time = (found.start, found.stop)
    if surface == "static":
        height = bed.static_bed_height(run, time[0], time[-1])
    elif bed.has_profiles_of(run, time[0], time[-1]):
        height = bed.bed_height(run)
    elif "grain_profiles" in run.profiles and not len(run.grains.between(time[0], time[-1])):
        height = bed.bed_height(run)
        print(f"thalweg: {folder} has no frames: the height of its bed is the mean from "
              f"{run.averaged_from('grain_profiles'):g} s to its end, not of the time of q*.", file=sys.stderr)
    else:
        height = bed.bed_height(run, time[0], time[-1])
    return (bed.shields_number(run, height, time[0], time[-1], surface != "static"), found.rate, found.verdict.steady,
            height / run.diameter)


def draw_literature(axes):
    shields = np.linspace(0.02, 0.15, 400)
    least, most = literature.old_relations(shields)
    axes.fill_between(shields, np.maximum(least, SMALLEST), np.maximum(most, SMALLEST), color="0.9", lw=0,
                      label="spread of the three relations below")
    for curve, label, style in ((literature.paehtz_duran, "Pähtz and Durán, threshold 0.033", (0, (6, 2))),
                                (literature.meyer_peter_mueller, "Meyer-Peter and Müller", "-"),
                                (literature.wong_parker, "Wong and Parker", "--"),
                                (literature.fernandez_luque_van_beek, "Fernandez Luque and van Beek", "-."),
                                (literature.zhang_wide_bed, "Zhang et al., fig. 6, prefactor as printed", ":"),
                                (lambda tau: literature.zhang_wide_bed(tau, literature.CONTINUUM_PREFACTOR),
                                 f"the same, {literature.CONTINUUM_PREFACTOR} times: their continuum", (0, (1, 3)))):
        values = curve(shields)
        axes.semilogy(shields[values > 0], values[values > 0], linestyle=style, color="0.55", lw=1, label=label)


def draw_paper(axes):
    middle, half = literature.FLUME_THRESHOLD, literature.FLUME_THRESHOLD_ERROR
    axes.axvspan(middle - half, middle + half, color="#f3dcd8", label="threshold of the experiment")
    for (shields, rate, deviation, start), mark in zip(literature.FLUME_POINTS, "^v"):
        axes.errorbar(shields, rate, deviation, fmt=mark, color="#c0392b", ms=6, capsize=3,
                      label=f"Zhang et al., flume, start: {start}")


def number_text(value, form=".4f", absent=""):
    """absent: for the error of a single measurement, which is not a number."""
    return f"{value:{form}}" if np.isfinite(value) else absent


def row_of(folder, shields, rate, steady, height):
    return {
        "run": folder.name, "Shields number [1]": f"{shields:.4f}", "bed [d]": f"{height:.2f}",
        "q_star [1]": f"{rate.mean:.4f}", "error [1]": number_text(rate.error), "deviation [1]": f"{rate.deviation:.4f}",
        "steady": VERDICTS[steady],
    }


def error_in(row):
    """None: q* is a single measurement."""
    return float(row["error [1]"]) if row["error [1]"] else None


def draw_runs(axes, rows):
    for n, row in enumerate(rows):
        shields, rate = float(row["Shields number [1]"]), float(row["q_star [1]"])
        axes.errorbar(
            shields, max(rate, SMALLEST), error_in(row), fmt="osD^v"[n // 10 % 5], color=f"C{n % 10}", ms=7, capsize=3,
            mfc=f"C{n % 10}" if row["steady"] == "yes" else "none", label=row["run"],
        )


def print_table(folders, found):
    print("| run | Shields number | bed [d] | q* | error | deviation | independent values | steady |")
    print("|---|---|---|---|---|---|---|---|")
    for folder, (shields, rate, steady, height) in zip(folders, found):
        print(
            f"| {folder.name} | {shields:.4f} | {height:.2f} | {rate.mean:.4f} |"
            f" {number_text(rate.error, absent='single measurement')} |"
            f" {rate.deviation:.4f} | {rate.independent:.0f} | {VERDICTS[steady]} |"
        )


def below_the_axis(rows):
    """A remark on the runs that stand on the axis because their q* is below it; empty where there is none."""
    low = [row["run"] for row in rows if float(row["q_star [1]"]) < SMALLEST]
    return f"drawn at {SMALLEST:g}, because q* is less: {', '.join(low)}" if low else ""


def figure_of(rows):
    """rows: of the table of runs, as row_of() makes them."""
    figure, axes = plt.subplots(figsize=(9, 4.8), layout="constrained")
    draw_literature(axes)
    draw_paper(axes)
    draw_runs(axes, rows)
    shields = [float(row["Shields number [1]"]) for row in rows]
    tops = [float(row["q_star [1]"]) + (error_in(row) or 0.0) for row in rows]
    axes.set(xlabel="Shields number", ylabel=r"$q^* = q_s\,/\sqrt{(s-1)\,g\,d^3}$",
             xlim=(min([0.015] + [0.9 * value for value in shields]), max([0.15] + [1.1 * value for value in shields])),
             ylim=(SMALLEST, max([1.0] + [1.3 * top for top in tops])))
    axes.set_title(below_the_axis(rows), fontsize=8, loc="left")
    axes.legend(fontsize=7, loc="upper left", bbox_to_anchor=(1.01, 1.0))
    axes.grid(color="#e5e8ea", linewidth=0.8)
    return figure


def draw(folders, start, stop, surface, table):
    """The figure of these runs, after the printed table; start, stop: of the means, s, or None; table: a file, or
    None."""
    folders = [Run(folder).folder for folder in folders]
    found = [measure(folder, start, stop, surface) for folder in folders]
    if found:
        print_table(folders, found)
    rows = [row_of(folder, *one) for folder, one in zip(folders, found)]
    return figure_of(merged_rows(table, rows, DRAWN))
