#!/usr/bin/python3
"""Means over the height of a bed, as fig. 7(a) of Zhang et al. (2022): bed_profiles.py RUN_FOLDER [options]

Reads profiles.h5 (analysis.grain_profiles, and analysis.fluid_statistics where it is there) and, for the stress of the fluid on
the grains, their frames (coupling.grain_stress). Heights are from the surface by solid fraction. With
analysis.stress_balance it draws the stresses of that, the total and the line of the driving force, to which the total comes,
with what side walls take, in steady flow. Without, and without side walls, it draws the driving stress, the weight along the
slope of all that is above, and what is left of it for the fluid.
"""
import argparse
import sys
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import thalweg
from thalweg.bed import surface_by_solid_fraction
from thalweg.layers import layer_profiles


def driving_stress(run, z, fraction):
    """Pa at the middles z (m) of the layers: g_x times the mass of water and grains above."""
    density = run.case["fluid"]["density"] * (1.0 - fraction) + run.case["grains"][0]["density"] * fraction
    weight = density * run.gravity[0] * (z[1] - z[0])
    return np.cumsum(weight[::-1])[::-1] - 0.5 * weight


def component(group, name, which):
    return group[name][:, group.components[name].index(which)]


def balanced_stresses(balance):
    """(label, z in m, Pa) of the stresses that make up the balance of momentum along x."""
    xz = {name: component(balance, name, "xz") for name in balance.components if "xz" in balance.components[name]}
    found = [("solid: contacts and motion", xz["contact_stress"] + xz["kinetic_stress"]),
             ("fluid on grains", xz["grain_fluid_stress"]),
             ("fluid: viscous and subgrid", xz["viscous_stress"] + xz["subgrid_stress"]),
             ("fluid: resolved eddies", xz["reynolds_stress"]),
             ("rotation stress", balance["rotation_stress"]),
             ("total", balance["total_stress"]),
             ("driving", balance["driving_stress"])]
    sides = balance.get("side_wall_stress")
    if sides is not None and np.any(sides):
        found += [("driving less side walls", balance["driving_stress"] - sides)]
    return [(label, balance["z"], values) for label, values in found]


def stresses(run):
    """(label, z in m, Pa) of every shear stress that was measured."""
    if "stress_balance" in run.profiles:
        return balanced_stresses(run.profiles["stress_balance"])
    grains = run.profiles["grain_profiles"]
    z, fraction = grains["z"], grains["solid_fraction"]
    solid = component(grains, "contact_stress", "xz") + component(grains, "kinetic_stress", "xz")
    found = [("solid: contacts and motion", z, solid)]
    if not run.side_walls:   # which would take a share
        driving = driving_stress(run, z, fraction)
        found += [("driving", z, driving), ("fluid: what is left of the driving", z, driving - solid)]
    if "fluid_statistics" in run.profiles:
        fluid = run.profiles["fluid_statistics"]
        share = 1.0 - np.interp(fluid["z"], z, fraction)
        reynolds = -run.case["fluid"]["density"] * share * component(fluid, "reynolds_stress", "xz")
        found.append(("fluid: resolved eddies", fluid["z"], reynolds))
    if len(run.grains) and "fluid_stress" in run.grains[-1].arrays:
        frames = layer_profiles(run, start=run.averaged_from("grain_profiles"))
        found.append(("rotation stress", frames["z"], frames["rotation_stress"]))
    return found


def draw(run, out):
    grains = run.profiles["grain_profiles"]
    surface = surface_by_solid_fraction(grains["z"], grains["solid_fraction"])
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(11, 4.2), sharey=True, layout="constrained")
    z, fraction = (grains["z"] - surface) / run.diameter, grains["solid_fraction"]
    left.plot(fraction, z, "k-")
    left.set(xlabel="solid fraction", ylabel="height from the surface [d]")
    moving = np.where(fraction > 0, grains["velocity"][:, 0], np.nan)
    middle.semilogx(np.where(moving > 0, moving, np.nan), z, label="grains")
    if "fluid_statistics" in run.profiles:
        fluid = run.profiles["fluid_statistics"]
        speed = np.where(fluid["velocity"][:, 0] > 0, fluid["velocity"][:, 0], np.nan)
        middle.semilogx(speed, (fluid["z"] - surface) / run.diameter, label="water")
    middle.set(xlabel="mean velocity along x [m/s]")
    for label, height, values in stresses(run):
        right.plot(values, (height - surface) / run.diameter, label=label, lw=1.2)
    right.set(xlabel="shear stress [Pa]")
    for axes in (left, middle, right):
        axes.axhline(0.0, color="0.6", lw=0.8)
        axes.grid(color="#e5e8ea", linewidth=0.8)
    middle.legend(fontsize=8)
    right.legend(fontsize=8)
    figure.suptitle(run.name, fontsize=11)
    figure.savefig(out, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path, metavar="RUN_FOLDER")
    parser.add_argument("--out", default="bed_profiles.png")
    arguments = parser.parse_args()
    try:
        run = thalweg.Run(arguments.run)
        if "grain_profiles" not in run.profiles:
            raise thalweg.RunFolderError(f"{run.folder / 'profiles.h5'}: it has no means of the grains yet "
                                         "(analysis.grain_profiles in the case; written with every checkpoint).")
        draw(run, arguments.out)
    except thalweg.RunFolderError as error:
        print(f"bed_profiles: {error}", file=sys.stderr)
        return 1
    print(arguments.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
