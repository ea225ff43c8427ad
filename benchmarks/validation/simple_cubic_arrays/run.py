#!/usr/bin/python3
"""Runs the arrays of both solid fractions at all resolutions: run.py THALWEG OUTPUT_FOLDER [LINKS...]

LINKS: kinds of coupling.links, bouzidi if none is given. Every array is run with the spheres at a few places between the
cells. Appends one line a run to OUTPUT_FOLDER/drag.csv, which compare.py reads.
"""
import json
import math
import random
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg

CELLS = [16, 22, 27, 32, 43, 54]     # of half the box at 0.027, of the whole box of 0.216: diameters of 6 to 20 cells
PLACES = 3
SPACING, STEP, DENSITY, VISCOSITY = 0.5e-3, 1e-4, 1000.0, 4.1666667e-4


def gravity(size):
    """m/s^2 that gives all sizes the same Reynolds number, below 0.02."""
    return 0.1 * (0.008 / size) ** 3


def overrides(fraction, cells, place):
    """Options of a run: one sphere in the box at 0.027, eight at 0.216, where one alone has too narrow a box."""
    size, spheres = cells * SPACING, 1 if fraction < 0.1 else 2
    pitch = size / spheres
    diameter = pitch * (6.0 * fraction / math.pi) ** (1.0 / 3.0)
    shift = [SPACING * (place.random() - 0.5) for _ in range(3)]
    positions = [[(k[a] + 0.5) * pitch + shift[a] for a in range(3)] for k in np.ndindex(spheres, spheres, spheres)]
    # Seven and more times the time in which the flow answers, L^2/(6 pi nu (R/L) K): 0.14 and 0.019 L^2/nu.
    until = (1.0 if spheres == 1 else 0.2) * pitch ** 2 / VISCOSITY
    return diameter, until, {
        "domain.size": [size] * 3, "grains.0.diameter": diameter, "grains.0.placement.positions": positions,
        "grains.0.count": len(positions), "analysis.fluid_statistics.from": 0.999 * until, "gravity.vector": [gravity(size), 0, 0],
        "analysis.fluid_statistics.every": STEP, "output.series.every": until}


def drag(run, fraction, diameter):
    """Mean drag over 6 pi eta R U: the links' force and the driving force on the spheres' own volume."""
    folder = thalweg.Run(run)
    case, summary = folder.case, folder.summary
    size = case["domain"]["size"][0]
    volume = math.pi / 6.0 * diameter ** 3
    viscosity = DENSITY * VISCOSITY
    with h5py.File(folder.latest_checkpoint) as file:
        force = np.mean(file["grains/load_force"][:, 0])
    fluid_cells = summary["figures"]["fluid_cells"]
    superficial = summary["fluid_statistics"]["mean_velocity_x"] * fluid_cells * SPACING ** 3 / size ** 3
    return (force + DENSITY * gravity(size) * volume) / (3.0 * math.pi * viscosity * diameter * superficial)


def main():
    thalweg, output = sys.argv[1], Path(sys.argv[2])
    output.mkdir(parents=True, exist_ok=True)
    table = output / "drag.csv"
    if not table.exists():
        table.write_text("links,solid_fraction [1],diameter [cells],place,drag [1]\n")
    for links in sys.argv[3:] or ["bouzidi"]:
        for fraction in (0.027, 0.216):
            for cells in CELLS:
                place = random.Random(1)
                for number in range(PLACES):
                    diameter, until, values = overrides(fraction, cells, place)
                    if cells > 32 and number > 0:
                        continue
                    run = output / f"{links}_{fraction}_{cells}_{number}"
                    command = [thalweg, "run", str(Path(__file__).with_name("case.yaml")), "--out", str(run), "--overwrite",
                               "--until", f"{until:.8g}"]
                    if links != "bouzidi":
                        values["coupling.links"] = links
                    for key, value in values.items():
                        command += ["--set", f"{key}={json.dumps(value)}"]
                    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
                    with open(table, "a") as file:
                        file.write(f"{links},{fraction},{diameter / SPACING:.4f},{number},{drag(run, fraction, diameter):.5f}\n")
                    shutil.rmtree(run)


main()
