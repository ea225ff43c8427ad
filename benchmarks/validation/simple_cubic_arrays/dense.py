#!/usr/bin/env python3
"""Drag on dense arrays at ten cells per diameter: dense.py THALWEG OUTPUT_FOLDER [--collision bgk] [--tau 0.6 1 1.5]

Runs arrays of five solid fractions, up to that of touching spheres, with both link rules and several relaxation times,
each with the spheres at a few positions relative to the cells. Appends a line per run to OUTPUT_FOLDER/dense.csv, skips
runs that are there already, and prints the mean difference from Zick and Homsy for each. Exit code 0 if `cli` with trt
is within 3 %.
"""
import argparse
import random
import sys
from pathlib import Path

from arrays import overrides, reference_drags, run_array

from thalweg.checks import Verdict
from thalweg.tables import read_rows

CELLS = {
    0.125: 32, 0.216: 27, 0.343: 23, 0.45: 21, 0.5236: 20,
}  # of the box, two spheres wide: 9.9 to 10.05 per diameter
PLACES, ACCEPTED = 3, 0.03
HEADINGS = ["links", "collision", "tau", "solid_fraction [1]", "diameter [cells]", "place", "drag [1]"]


def setting(row):
    return tuple(row[name] for name in HEADINGS[:4])


def run_missing(thalweg, table, collision, taus):
    done = {setting(row) + (row["place"],) for row in read_rows(table)}
    for fraction, cells in CELLS.items():
        for tau in taus:
            for links in ("bouzidi", "cli"):
                place = random.Random(1)
                for number in range(PLACES):
                    diameter, until, values = overrides(fraction, cells, place, tau)
                    name = (links, collision, str(tau), str(fraction))
                    if name + (str(number),) in done:
                        continue
                    values |= {"coupling.links": links, "fluid.collision": collision}
                    drag = run_array(thalweg, table.parent / "_".join(name + (str(number),)), until, values)
                    with open(table, "a", encoding="utf-8") as file:
                        file.write(f"{','.join(name)},{diameter:.4f},{number},{drag:.5f}\n")


def report(table):
    exact = reference_drags()
    drags = {}
    for row in read_rows(table):
        drags.setdefault(setting(row), []).append(float(row["drag [1]"]))
    verdict = Verdict()
    for (links, collision, tau, fraction), values in sorted(drags.items()):
        error = sum(values) / len(values) / exact[fraction] - 1.0
        spread = (max(values) - min(values)) / exact[fraction]
        said = ""
        if (links, collision) == ("cli", "trt"):
            said = f": {verdict(abs(error) <= ACCEPTED)}"
        print(
            f"{links} {collision}, tau {tau}, solid fraction {fraction}: {100 * error:+.1f} %, places"
            f" {100 * spread:.1f} % apart{said}"
        )
    return verdict.exit_code


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("thalweg")
    parser.add_argument("output", type=Path, metavar="OUTPUT_FOLDER")
    parser.add_argument("--collision", default="trt")
    parser.add_argument("--tau", nargs="+", type=float, default=[0.6, 1.0, 1.5, 1.94])
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    table = arguments.output / "dense.csv"
    if not table.exists():
        table.write_text(",".join(HEADINGS) + "\n", encoding="utf-8")
    run_missing(arguments.thalweg, table, arguments.collision, arguments.tau)
    return report(table)


if __name__ == "__main__":
    sys.exit(main())
