#!/usr/bin/env python3
"""Runs a sphere that settles through liquid at rest: run.py GALILEO CELLS HEIGHT --out FOLDER [options] [further
arguments]

CELLS: per diameter. HEIGHT, --width: of the box, in diameters; the run ends before the sphere lands. --speed: cells a
step at the settling speed. --from: a run of the same box on other cells, whose sphere and flow it goes on with.
Further arguments go to the program, which is `thalweg` in the PATH.
"""
import argparse
import subprocess
import sys
from pathlib import Path

DIAMETER, REFERENCE_SPEED = 2.0e-3, (0.5 * 9.81 * 2.0e-3)**0.5       # m, m/s
EXPECTED = {144: 185.08, 178.46: 243.01, 190: 262.71, 250: 365.10}   # Reynolds numbers


def options(arguments):
    viscosity, spacing = REFERENCE_SPEED * DIAMETER / arguments.galileo, DIAMETER / arguments.cells
    width, height = round(arguments.width * arguments.cells) * spacing, arguments.height * DIAMETER
    speed = EXPECTED[arguments.galileo] * viscosity / DIAMETER
    aside = f"{0.5 * width + 5.3e-5:.6g}, {0.5 * width + 1.1e-5:.6g}"   # m: off the middle of a cell
    values = {"domain.size": f"[{width:.9g}, {width:.9g}, {height:.9g}]", "domain.spacing": f"{spacing:.9g}",
              "fluid.kinematic_viscosity": f"{viscosity:.6g}",
              "fluid.time_step": f"{arguments.speed * spacing / speed:.5g}",
              "grains.0.placement.positions": f"[[{aside}, {height - 2.0 * DIAMETER:.6g}]]",
              "grains.0.velocity": f"[0.012, 0.005, {-speed:.6g}]",
              "run.until": f"{(height - 3.5 * DIAMETER) / speed:.6g}"}
    source = getattr(arguments, "from")
    if source:
        values["initial"] = f"{{from: {Path(source).resolve()}, fields: [grains, fluid]}}"
    return [part for key, value in values.items() for part in ("--set", f"{key}={value}")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("galileo", type=float)
    parser.add_argument("cells", type=int)
    parser.add_argument("height", type=float)
    parser.add_argument("--out", required=True)
    parser.add_argument("--width", type=float, default=5.4)
    parser.add_argument("--from")
    parser.add_argument("--speed", type=float, default=0.08)
    arguments, further = parser.parse_known_args()
    case = Path(__file__).with_name("case.yaml")
    return subprocess.run(["thalweg", "run", case, "--out", arguments.out, *options(arguments), *further]).returncode


if __name__ == "__main__":
    sys.exit(main())
