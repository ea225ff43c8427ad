"""Runs of slow flow through simple cubic arrays of spheres: what run.py and dense.py share."""
import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "python"))
import thalweg_python

import h5py
import numpy as np

import thalweg
from thalweg.tables import read_rows

SPACING, STEP, DENSITY = 0.5e-3, 1e-4, 1000.0


def viscosity_of(tau):
    """Viscosity (m^2/s) at a relaxation time of tau."""
    return (tau - 0.5) / 3.0 * SPACING ** 2 / STEP


def gravity(size, viscosity):
    """Acceleration (m/s^2) that gives all sizes and viscosities the same Reynolds number, below 0.02."""
    return 0.1 * (0.008 / size) ** 3 * (viscosity / viscosity_of(1.0)) ** 2


def overrides(fraction, cells, place, tau=1.0):
    """Diameter (cells), duration (s) and options of a run in a box of `cells`: one sphere at a solid fraction of 0.027,
    eight at others, where the box of a single one would be too narrow. place: random.Random, for the position relative
    to the cells."""
    size, spheres = cells * SPACING, 1 if fraction < 0.1 else 2
    pitch, viscosity = size / spheres, viscosity_of(tau)
    # Touching spheres, at pi/6, must not overlap in the last digit.
    diameter = min(pitch * (6.0 * fraction / math.pi) ** (1.0 / 3.0), pitch * (1.0 - 1e-9))
    shift = [SPACING * (place.random() - 0.5) for _ in range(3)]
    positions = [[(k[a] + 0.5) * pitch + shift[a] for a in range(3)] for k in np.ndindex(spheres, spheres, spheres)]
    # At least seven times the response time of the flow, L^2/(6 pi nu (R/L) K): 0.14 and 0.019 L^2/nu.
    until = (1.0 if spheres == 1 else 0.2) * pitch ** 2 / viscosity
    return diameter / SPACING, until, {
        "domain.size": [size] * 3, "fluid.kinematic_viscosity": viscosity, "grains.0.diameter": diameter,
        "grains.0.placement.positions": positions, "grains.0.count": len(positions),
        "analysis.fluid_statistics.from": 0.999 * until, "analysis.fluid_statistics.every": STEP,
        "gravity.vector": [gravity(size, viscosity), 0, 0], "output.series.every": until}


def drag_of(folder):
    """Mean drag of a run over 6 pi eta R U: force of the links plus the driving force on the volume of the spheres."""
    run = thalweg.Run(folder)
    case, summary = run.case, run.summary
    size, diameter = case["domain"]["size"][0], case["grains"][0]["diameter"]
    viscosity = case["fluid"]["kinematic_viscosity"]
    volume = math.pi / 6.0 * diameter ** 3
    with h5py.File(run.latest_checkpoint) as file:
        force = np.mean(file["grains/load_force"][:, 0])
    fluid_cells = summary["figures"]["fluid_cells"]
    superficial = summary["fluid_statistics"]["mean_velocity_x"] * fluid_cells * SPACING ** 3 / size ** 3
    push = force + DENSITY * gravity(size, viscosity) * volume
    return push / (3.0 * math.pi * DENSITY * viscosity * diameter * superficial)


def run_array(program, folder, until, values):
    """Runs case.yaml with `values` in place of its own in `folder`, which is then removed; returns the drag."""
    command = [program, "run", str(HERE / "case.yaml"), "--out", str(folder), "--overwrite", "--until", f"{until:.8g}"]
    for key, value in values.items():
        command += ["--set", f"{key}={json.dumps(value)}"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    drag = drag_of(folder)
    shutil.rmtree(folder)
    return drag


def reference_drags():
    """Drag by solid fraction (as text)."""
    return {row["solid_fraction [1]"]: float(row["drag [1]"]) for row in read_rows(HERE / "reference.csv")}
