#!/usr/bin/env python3
"""Runs the arrays of both solid fractions at all resolutions: run.py THALWEG OUTPUT_FOLDER [LINKS...]

LINKS: kinds of coupling.links, bouzidi if none is given. Every array is run with the spheres at a few positions
relative to the cells. Appends one line per run to OUTPUT_FOLDER/drag.csv, which compare.py reads.
"""
import random
import sys
from pathlib import Path

from arrays import overrides, run_array

CELLS = [16, 22, 27, 32, 43, 54]     # of half the box at 0.027, of the whole box at 0.216: diameters of 6 to 20 cells
PLACES = 3


def main():
    thalweg, output = sys.argv[1], Path(sys.argv[2])
    output.mkdir(parents=True, exist_ok=True)
    table = output / "drag.csv"
    if not table.exists():
        table.write_text("links,solid_fraction [1],diameter [cells],place,drag [1]\n", encoding="utf-8")
    for links in sys.argv[3:] or ["bouzidi"]:
        for fraction in (0.027, 0.216):
            for cells in CELLS:
                place = random.Random(1)
                for number in range(PLACES):
                    diameter, until, values = overrides(fraction, cells, place)
                    if cells > 32 and number > 0:
                        continue
                    values["coupling.links"] = links
                    drag = run_array(thalweg, output / f"{links}_{fraction}_{cells}_{number}", until, values)
                    with open(table, "a", encoding="utf-8") as file:
                        file.write(f"{links},{fraction},{diameter:.4f},{number},{drag:.5f}\n")


main()
