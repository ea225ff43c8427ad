#!/usr/bin/env python3
"""The heap of case.yaml in LAMMPS, from the same bed: lammps.py BED FOLDER. The program is lmp, or what LMP names.

LAMMPS's pair_style granular has the same springs. Its rolling model also has a spring, a dashpot and a limit (sds); its
spring is the angular one divided by the square of the effective radius. Damping and rolling dashpots are those of the
mean diameter. FOLDER/bed.h5 is what angle.py reads.
"""
import argparse
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import h5py
import numpy as np

from thalweg.run import read_bed

STIFFNESS, TANGENTIAL, DENSITY, RADIUS = 200.0, 57.14, 2500.0, 0.5e-3
BOX, PLATE, TOP = (0.052, 0.012, 0.1), (0.006, 0.046), 0.04
TIME_STEP, STEPS = 4.0e-6, 300000

INPUT = """units si
atom_style sphere
boundary f p f
newton off
comm_modify vel yes
processors * * 1
read_data bed.data
neighbor 0.0003 bin
neigh_modify delay 0 every 5 check yes
pair_style granular
pair_coeff * * {grains}
group free type 1
group glued type 2
neigh_modify exclude group glued glued
fix motion free nve/sphere
fix gravity free gravity 9.81 vector 0 0 -1
fix hold glued freeze
region plate block {PLATE[0]} {PLATE[1]} -1 1 {below} {TOP} side out
fix plate free wall/gran/region {walls} region plate
fix ends free wall/gran {walls} xplane 0 {BOX[0]}
fix floor free wall/gran {walls} zplane 0 {BOX[2]}
timestep {TIME_STEP}
thermo 5000
thermo_style custom step time ke cpu
run {STEPS}
write_dump all custom end.txt id x y z radius modify sort id format float %.17g
"""


def law(restitution, friction, rolling, mass_share, radius_share):
    """Contact law of mean grains; share: of mass and radius, 1/2 between two grains, 1 against a wall."""
    mass = DENSITY * 4 / 3 * np.pi * RADIUS ** 3
    effective_mass, arm = mass_share * mass, radius_share * RADIUS
    damping = -2 * np.log(restitution) / (np.pi * np.sqrt(effective_mass / STIFFNESS))  # 1/s, of the effective mass
    spring = 2.25 * STIFFNESS * rolling ** 2                                            # N/m at the effective radius
    inertia = mass_share * 1.4 * mass * RADIUS ** 2
    dashpot = 2 * 0.3 * np.sqrt(inertia * spring * arm ** 2) / arm ** 2
    return (f"hooke {STIFFNESS} {damping:.6g} tangential linear_history {TANGENTIAL} 0 {friction} "
            f"rolling sds {spring:.6g} {dashpot:.6g} {rolling} damping mass_velocity")


def write_data(file, place, radius, density, smooth):
    glued = (place[:, 2] <= TOP + 1e-3) & (place[:, 0] >= PLATE[0]) & (place[:, 0] <= PLATE[1]) & (not smooth)
    lines = ["Heap", "", f"{len(place)} atoms", "2 atom types", ""]
    lines += [f"0 {size} {axis}lo {axis}hi" for axis, size in zip("xyz", BOX)] + ["", "Atoms", ""]
    lines += [f"{n + 1} {2 if glued[n] else 1} {2 * radius[n]:.17g} {density[n]:.17g} {x:.17g} {y:.17g} {z:.17g}"
              for n, (x, y, z) in enumerate(place)]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bed", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--smooth", action="store_true", help="nothing is glued to the plate")
    parser.add_argument("--friction", type=float, default=0.16)
    parser.add_argument("--rolling-friction", type=float, default=0.18)
    parser.add_argument("--wall-friction", type=float, default=0.45)
    parser.add_argument("--wall-rolling-friction", type=float, default=0.09)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True)
    bed = read_bed(arguments.bed)
    place, radius, density = (bed[name] for name in ("position", "radius", "density"))
    write_data(arguments.folder / "bed.data", place, radius, density, arguments.smooth)
    grains = law(0.97, arguments.friction, arguments.rolling_friction, 0.5, 0.5)
    walls = "granular " + law(0.82, arguments.wall_friction, arguments.wall_rolling_friction, 1.0, 1.0)
    values = dict(globals(), grains=grains, walls=walls, below=TOP - 1e-3)
    (arguments.folder / "in.heap").write_text(INPUT.format(**values), encoding="utf-8")
    subprocess.run([os.environ.get("LMP", "lmp"), "-in", "in.heap"], cwd=arguments.folder, check=True)
    end = np.loadtxt(arguments.folder / "end.txt", skiprows=9)
    with h5py.File(arguments.folder / "bed.h5", "w") as file:
        file["grains/position"], file["grains/radius"] = end[:, 1:4], end[:, 4]


if __name__ == "__main__":
    sys.exit(main())
