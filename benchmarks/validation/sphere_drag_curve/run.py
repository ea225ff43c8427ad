#!/usr/bin/env python3
"""Runs a sphere that is towed through water at rest, or falls: run.py towed|falling REYNOLDS CELLS --out FOLDER
[options]

CELLS: per diameter. --height, --width: of the box, in diameters. --from: a run of the same box on other cells, whose
sphere and flow it goes on with. Further arguments go to the program, which is `thalweg` in the PATH.
"""
import argparse
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from compare import DENSITY, DIAMETER, GRAVITY, VISCOSITY, standard_drag

LATTICE_VELOCITY = 0.08    # cells a step, at the Reynolds number that is asked for


def options(arguments):
    speed, spacing = arguments.reynolds * VISCOSITY / DIAMETER, DIAMETER / arguments.cells
    height, width = arguments.height * DIAMETER, arguments.width * DIAMETER
    aside = 0.5 * width + 0.000131, 0.5 * width - 0.000043   # m: off the middle of a cell
    values = {"domain.size": f"[{width:.6g}, {width:.6g}, {height:.6g}]", "domain.spacing": f"{spacing:.9g}",
              "fluid.time_step": f"{LATTICE_VELOCITY * spacing / speed:.6g}",
              "grains.0.placement.positions": f"[[{aside[0]:.6g}, {aside[1]:.6g}, {height - 2 * DIAMETER:.6g}]]",
              "analysis.tracks.every": f"{0.04 * DIAMETER / speed:.6g}"}
    if arguments.kind == "towed":
        values |= {"grains.0.prescribed_velocity": f"[0, 0, {-speed:.6g}]",
                   "run.until": f"{(height - 5.5 * DIAMETER) / speed:.6g}"}
    else:
        density = DENSITY * (1.0 + 0.75 * standard_drag(arguments.reynolds) * speed**2 / (GRAVITY * DIAMETER))
        values |= {"grains.0.density": f"{density:.6g}", "grains.0.velocity": f"[{0.01 * speed:.6g}, 0, {-speed:.6g}]",
                   "run.until": f"{(height + 4.0 * DIAMETER) / speed:.6g}"}
    source = getattr(arguments, "from")
    if source:
        values["initial"] = f"{{from: {Path(source).resolve()}, fields: [grains, fluid]}}"
    return [part for key, value in values.items() for part in ("--set", f"{key}={value}")]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kind", choices=["towed", "falling"])
    parser.add_argument("reynolds", type=float)
    parser.add_argument("cells", type=int)
    parser.add_argument("--out", required=True)
    parser.add_argument("--from")
    parser.add_argument("--height", type=float, default=30.0)
    parser.add_argument("--width", type=float, default=5.0)
    arguments, further = parser.parse_known_args()
    case = HERE / f"{arguments.kind}.yaml"
    return subprocess.run(["thalweg", "run", case, "--out", arguments.out, *options(arguments), *further]).returncode


if __name__ == "__main__":
    sys.exit(main())
