#!/usr/bin/env python3
"""Thresholds of motion beside Clark et al. (2017): thresholds.py [--figure FILE]

Reads the tables thresholds.csv of the sweeps shields_curve.yaml, linear_drag.yaml, lift.yaml, inertia.yaml,
friction.yaml and friction_long.yaml, and runs.csv of long_watch.yaml and hysteresis.yaml, which are kept here under the
names of the sweeps; those that are missing are left out. Prints every threshold with half the width of its bracket, the
value of the paper, what is accepted, and pass or fail. Exit code 0 if all pass.
"""
import argparse
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

from thalweg.checks import Verdict
from thalweg.tables import HEADING, read_rows

LOW, HIGH = 0.28, 0.11                       # section III B: the plateaus at Re_* << 1 and Re_* >> 1
LOW_ACCEPTED, HIGH_ACCEPTED = 0.03, 0.015
LARGEST = 0.36                               # Shields number at which all beds at Re_* = 0.1 go on
LITTLE_RESTITUTION = 0.03                    # of which the dashpot with e_n = 0.1 in the paper's equation is
LIFT_ACCEPTED = 0.1                          # relative
DISKS_FACTOR = 2.0                           # section III E: "roughly"
FRICTION_ACCEPTED = 1.5                      # section III E: increases by less than 50 %


def thresholds(name, state="found"):
    """Rows of a table as dictionaries of numbers by the last words of their headings; thresholds in this state."""
    path = HERE / f"{name}.csv"
    if not path.exists():
        return []
    rows = [
        {HEADING.match(head)[1].rpartition(".")[2]: value for head, value in row.items()} for row in read_rows(path)
    ]
    return [{head: float(value) for head, value in row.items() if head != "state" and value} for row in rows
            if row["state"] == state]


def runs(name):
    """Rows of a table of runs, as dictionaries of text by heading."""
    path = HERE / f"{name}.csv"
    return read_rows(path) if path.exists() else []


class Report(Verdict):
    def line(self, what, row, expected, accepted):
        """accepted: the distance from the expected value beyond half the bracket."""
        good = abs(row["shields_number"] - expected) <= accepted + row["half_width"]
        print(f"{what:<42} {row['shields_number']:.4f} +- {row['half_width']:.4f}   paper {expected:.4f}   "
              f"accepted +- {accepted:.4f}   {self(good)}")

    def bracket(self, what, lower, upper, expected, accepted):
        """A bracket too wide to be judged by its middle: all of it has to be accepted."""
        rounding = 1e-9   # 0.28 - 0.25 is a little above 0.03
        within = max(abs(lower - expected), abs(upper - expected)) <= accepted + rounding
        apart = upper <= expected - accepted + rounding or lower >= expected + accepted - rounding
        verdict = self(within)
        print(f"{what:<42} {lower:.4f} to {upper:.4f}    paper {expected:.4f}   accepted +- {accepted:.4f}   "
              f"{verdict if within or apart else 'UNDECIDED'}")

    def alike(self, what, groups):
        """The mean of each group within 2.6 of its standard errors of the mean of all: 1 % of a normal distribution."""
        if not groups:
            return
        mean = np.mean(np.concatenate(groups))
        off = max(abs(np.mean(group) - mean) / standard_error(group) for group in groups)
        print(f"{what}: means of {len(groups)} kinds within {off:.1f} standard errors of all, accepted 2.6   "
              f"{self(off <= 2.6)}")

    def below(self, what, threshold, limit):
        """threshold: an upper limit of it."""
        print(f"{what:<42} below {threshold:.4f}     paper below {limit:.4f}   {self(threshold < limit)}")


def standard_error(values):
    return np.std(values, ddof=1) / np.sqrt(len(values))


def points(axes, rows, x, **style):
    if rows:
        axes.errorbar(
            [row[x] for row in rows], [row["shields_number"] for row in rows], [row["half_width"] for row in rows],
            capsize=3, **style,
        )


def with_lift(threshold, ratio):
    return threshold / (1.0 + 1.5 * threshold * ratio)   # equation 12


def watched_as_in_the_paper(axes, report, shorter):
    """Ten beds at each of some Shields numbers and Re_* = 0.1, for a million collision times. Section III B: it is
    below the threshold if more than half of them stop. shorter: the threshold of beds watched for less; what stops by
    then is below this one as well."""
    beds = runs("long_watch")
    if not beds:
        return
    lower, upper = shorter["lower"], LARGEST
    for shields in sorted({bed["model_fluid.shields_number [1]"] for bed in beds}, key=float):
        of_this = [bed for bed in beds if bed["model_fluid.shields_number [1]"] == shields]
        done = [(float(bed["simulated_time"]), float(bed["run.until"])) for bed in of_this if bed["state"] == "done"]
        stops = sorted(end for end, until in done if end < until)
        print(f"Re_* 0.1, Theta {shields}: of {len(of_this)} beds {len(stops)} stop, after {stops} sqrt(D/g'), "
              f"{len(done) - len(stops)} go on and {len(of_this) - len(done)} have not been run")
        if 2 * len(stops) > len(of_this):
            lower = max(lower, float(shields))
        elif 2 * (len(done) - len(stops)) >= len(of_this):
            upper = min(upper, float(shields))
    report.bracket("the same, ten beds as long as in the paper", lower, upper, LOW, LOW_ACCEPTED)
    row = {"reynolds_number": 0.1, "shields_number": 0.5 * (lower + upper), "half_width": 0.5 * (upper - lower)}
    points(axes, [row], "reynolds_number", fmt="D", color="tab:purple", mfc="none", label="as long as in the paper")


def shields_curve(axes, report):
    rows = sorted(thresholds("shields_curve"), key=lambda row: row["reynolds_number"])
    points(axes, rows, "reynolds_number", fmt="ks-", label="quadratic drag")
    for row in rows:
        if row["reynolds_number"] <= 0.1 or row["reynolds_number"] >= 100:
            low = row["reynolds_number"] < 1
            report.line(f"quadratic drag, Re_* {row['reynolds_number']:g}", row, LOW if low else HIGH,
                        LOW_ACCEPTED if low else HIGH_ACCEPTED)
            if low:
                watched_as_in_the_paper(axes, report, row)
    for row in thresholds("inertia"):
        report.line(
            f"Re_* 100, B_2 D/m {row['inertial_coefficient']:g}, restitution {row['restitution']:g}", row, HIGH,
            HIGH_ACCEPTED,
        )
    linear = thresholds("linear_drag")
    for restitution, colour in ((LITTLE_RESTITUTION, "tab:blue"), (0.2, "tab:red")):
        of_this = [row for row in linear if row["restitution"] == restitution]
        points(axes, of_this, "reynolds_number", fmt="o--", color=colour, mfc="none",
               label=f"linear drag, restitution {restitution:g}")
    for row in linear:
        if row["restitution"] <= 0.2 and row["reynolds_number"] > 10:
            report.line(
                f"linear drag, restitution {row['restitution']:g}, Re_* {row['reynolds_number']:g}", row, HIGH,
                HIGH_ACCEPTED,
            )
    for row in thresholds("linear_drag", "holds everywhere"):
        report.below(
            f"linear drag, restitution {row['restitution']:g}, Re_* {row['reynolds_number']:g}", row["upper"], HIGH
        )
    for level in (LOW, HIGH):
        axes.axhline(level, color="0.6", lw=0.8)
    axes.text(
        0.98, 0.97, "lines: plateaus of the paper", transform=axes.transAxes, ha="right", va="top", fontsize=8,
        color="0.4",
    )
    axes.set(xscale="log", xlabel="Re$_*$, as printed", ylabel="Θ$_c$", ylim=(0.0, None), title="drag")
    return rows


def hysteresis(report):
    """Where beds at rest, 20 D long, begin to move. Section III C: the same for all drag laws and restitution
    coefficients."""
    kinds = {}
    for bed in runs("hysteresis"):
        if bed["state"] != "done":
            continue
        kind = f"{bed['model_fluid.drag']} drag, restitution {float(bed['contact.restitution [1]']):g}"
        kinds.setdefault(kind, []).append(float(bed["figures.shields_number [1]"]))
    for kind, found in kinds.items():
        print(
            f"beds at rest, {kind}: {len(found)} begin to move at {np.mean(found):.4f} +- {standard_error(found):.4f}"
        )
    report.alike("beds at rest begin to move", list(kinds.values()))


def lift(axes, report, without):
    rows = thresholds("lift")
    for reynolds, colour in ((0.5, "tab:green"), (100.0, "k")):
        at_rest = [row for row in without if row["reynolds_number"] == reynolds]
        of_this = [row for row in rows if row["reynolds_number"] == reynolds]
        if not at_rest or not of_this:
            continue
        points(
            axes, [row | {"lift_ratio": 0.0} for row in at_rest] + sorted(of_this, key=lambda row: row["lift_ratio"]),
            "lift_ratio", fmt="s", color=colour, label=f"Re$_*$ {reynolds:g}",
        )
        ratio = np.linspace(0.0, 3.0, 50)
        axes.plot(ratio, with_lift(at_rest[0]["shields_number"], ratio), color=colour, lw=0.8)
        for row in of_this:
            expected = with_lift(at_rest[0]["shields_number"], row["lift_ratio"])
            report.line(f"lift over drag {row['lift_ratio']:g}, Re_* {reynolds:g}, equation 12", row, expected,
                        LIFT_ACCEPTED * expected)
    axes.set(xlabel="lift over drag", ylim=(0.0, None), title="lift (lines: equation 12)")


def friction(axes, report, without):
    rows = thresholds("friction")
    for reynolds, plateau, colour in ((0.5, LOW, "tab:green"), (30.0, HIGH, "k")):
        of_this = sorted((row for row in rows if row["reynolds_number"] == reynolds), key=lambda row: row["friction"])
        points(axes, of_this, "friction", fmt="o-", color=colour, mfc="none", label=f"Re$_*$ {reynolds:g}")
        if not of_this:
            continue
        axes.axhline(DISKS_FACTOR * plateau, color=colour, lw=0.8, ls=":")
        least = min(row["shields_number"] for row in of_this)
        most = max(row["shields_number"] for row in of_this)
        good = most <= FRICTION_ACCEPTED * least
        print(f"disks, Re_* {reynolds:g}: {least:.3f} to {most:.3f} with friction, {100 * (most / least - 1):.0f} % "
              f"(paper: less than 50 %; twice the value of spheres: {DISKS_FACTOR * plateau:.2f})   "
              f"{report(good)}")
    friction_as_in_the_paper(axes, report)
    axes.set(xscale="log", xlabel="friction coefficient", ylim=(0.0, None), title="disks (dotted: twice the plateaus)")


def friction_as_in_the_paper(axes, report):
    """Disks at Re_* = 0.5, watched for a million collision times. A search that has not been finished gives a lower
    limit."""
    found, limits = thresholds("friction_long"), thresholds("friction_long", "unfinished")
    without = [row for row in found if row["friction"] < 0.01]
    others = [row for row in found + limits if row["friction"] >= 0.01]
    if not without or not others:
        return
    points(axes, found, "friction", fmt="D", color="tab:purple", mfc="none", label="the same, as long as in the paper")
    axes.plot(
        [row["friction"] for row in limits], [row["lower"] for row in limits], "^", color="tab:purple", mfc="none",
        label="lower limits",
    )
    above = max(row["lower"] for row in others)
    least = above / without[0]["upper"]
    most = max(row["upper"] for row in others) / without[0]["lower"]
    verdict = "UNDECIDED" if least <= FRICTION_ACCEPTED < most else report(most <= FRICTION_ACCEPTED)
    print(f"the same, as long as in the paper: {without[0]['lower']:.3f} to {without[0]['upper']:.3f} with friction "
          f"{without[0]['friction']:g}, more than {above:.3f} with friction: at least "
          f"+{100 * (least - 1):.0f} %   {verdict}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--figure", default="thresholds.png")
    arguments = parser.parse_args()
    figure, axes = plt.subplots(1, 3, figsize=(12, 4), layout="constrained")
    report = Report()
    without = shields_curve(axes[0], report)
    hysteresis(report)
    lift(axes[1], report, without)
    friction(axes[2], report, without)
    for panel in axes:
        panel.set_visible(panel.has_data())   # a sweep that has not been run
        panel.grid(color="#e5e8ea", linewidth=0.8)
        if panel.get_legend_handles_labels()[0]:
            panel.legend(fontsize=8)
    figure.savefig(arguments.figure, dpi=110)
    print(arguments.figure)
    return report.exit_code


if __name__ == "__main__":
    sys.exit(main())
