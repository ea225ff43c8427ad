#!/usr/bin/env python3
"""Compares spheroids with theory: compare.py RUN_FOLDER...

Runs of settling.yaml: the velocity at the end, relative to that of the whole volume, beside the one that the drag of
Oberbeck (1876) and the correction of Hasimoto (1959) for a periodic box give. Runs of jeffery.yaml: the period of the
turn about the vorticity beside that of Jeffery (1922). Runs of towed.yaml: the drag coefficient over the last third of
the way beside that of finite elements in the same box (reference.csv, by reference.py), or where there is none beside
Hölzer and Sommerfeld (2008), of a sphere Brown and Lawler (2003). Half axes are those of the ellipsoid with the volume
and the moments of inertia of the grain. Prints both, their difference, and pass or fail (3 %, towed 10 %); exit code 0
if all pass.
"""
import argparse
import csv
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import numpy as np

import thalweg
from thalweg.checks import Verdict

GRAVITY = 9.81                   # m/s^2
STEADY = 0.2                     # s, from when on the turn counts
WIDTH = 6.0                      # diameters, of the box of reference.csv


def half_axes(body):
    """m, along x, y and z of the frame in which the shape is given; these are the principal axes."""
    moments = np.array(body["inertia"][:3])
    return np.sqrt(5.0 * (moments.sum() / 2.0 - moments) / body["volume"])


def oberbeck(own, across, along):
    """Drag over that of a sphere of radius 1 m: half axis along the axis of symmetry, and across it; the way along it
    or across."""
    if own > across:
        e = np.sqrt(1.0 - (across / own) ** 2)
        logarithm = np.log((1.0 + e) / (1.0 - e))
        if along:
            return own * 8.0 / 3.0 * e**3 / ((1.0 + e**2) * logarithm - 2.0 * e)
        return own * 16.0 / 3.0 * e**3 / (2.0 * e + (3.0 * e**2 - 1.0) * logarithm)
    e = np.sqrt(1.0 - (own / across) ** 2)
    arc, root = np.arcsin(e), np.sqrt(1.0 - e**2)
    if along:
        return across * 4.0 / 3.0 * e**3 / ((2.0 * e**2 - 1.0) * arc + e * root)
    return across * 8.0 / 3.0 * e**3 / ((2.0 * e**2 + 1.0) * arc - e * root)


def symmetry(axes):
    """Number of the axis that differs from the other two, which are equal to 1 %."""
    return int(np.argmax(np.abs(axes - np.median(axes))))


def axis_in_space(grain, number):
    """Unit vector of an axis of the shape as the case turns it."""
    axis, angle = np.array(grain["orientation"]["axis"], float), grain["orientation"]["angle"]
    axis /= np.linalg.norm(axis)
    own = np.eye(3)[number]
    return own * np.cos(angle) + np.cross(axis, own) * np.sin(angle) + axis * (axis @ own) * (1.0 - np.cos(angle))


def ellipsoid_area(axes):
    """m^2, by the sum over a fine grid of its surface; half axes in m."""
    cosine, angle = np.meshgrid((np.arange(400) + 0.5) / 200.0 - 1.0, (np.arange(400) + 0.5) / 400.0 * 2.0 * np.pi)
    sine = np.sqrt(1.0 - cosine**2)
    normal = np.array([sine * np.cos(angle) / axes[0], sine * np.sin(angle) / axes[1], cosine / axes[2]])
    return 4.0 * np.pi * np.prod(axes) * np.sqrt((normal**2).sum(axis=0)).mean()


def standard_drag(reynolds):
    """Of a sphere: Brown and Lawler (2003)."""
    return 24.0 / reynolds * (1.0 + 0.150 * reynolds**0.681) + 0.407 / (1.0 + 8710.0 / reynolds)


def drag_coefficient(reynolds, axes, way):
    """Hölzer and Sommerfeld (2008), with lengthwise and crosswise sphericity; half axes in m; way: number of the axis
    along which it moves."""
    diameter = 2.0 * np.cbrt(np.prod(axes))
    area = ellipsoid_area(axes)
    sphericity = np.pi * diameter**2 / area
    across = np.pi * np.prod(np.delete(axes, way))
    crosswise = np.pi / 4.0 * diameter**2 / across
    lengthwise = np.pi / 4.0 * diameter**2 / (0.5 * area - mean_section_along(axes, way))
    return (8.0 / reynolds / np.sqrt(lengthwise) + 16.0 / reynolds / np.sqrt(sphericity)
            + 3.0 / np.sqrt(reynolds) / sphericity**0.75
            + 0.42 * 10.0 ** (0.4 * (-np.log10(sphericity)) ** 0.2) / crosswise)


def mean_section_along(axes, way):
    """m^2, mean cross-section of the ellipsoid along its way: of its shadows by light from all directions across it."""
    one, two = np.delete(axes, way)
    angle = (np.arange(400) + 0.5) / 400.0 * 2.0 * np.pi
    return (np.pi * axes[way] * np.hypot(one * np.sin(angle), two * np.cos(angle))).mean()


def by_finite_elements(shape, reynolds, width):
    """Drag coefficient of reference.csv at this Reynolds number in a box so wide (diameters), or None."""
    with Path(__file__).with_name("reference.csv").open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            same = row["shape"] == shape and abs(reynolds / float(row["reynolds_number [1]"]) - 1.0) < 0.01
            if same and abs(width / WIDTH - 1.0) < 0.01:
                return float(row["drag_coefficient [1]"])
    return None


def towed(run):
    """As settling()."""
    grain, fluid = run.case["grains"][0], run.case["fluid"]
    speed = -grain["prescribed_velocity"][2]
    if "shape" in grain:
        axes = half_axes(grain["shape"]["body"])
        number = symmetry(axes)
        way = int(np.argmax([abs(axis_in_space(grain, n)[2]) for n in range(3)]))
        name = f"{'prolate' if axes[number] > np.median(axes) else 'oblate'}_{'along' if way == number else 'across'}"
    else:
        axes, way, name = np.full(3, 0.5 * grain["diameter"]), 2, "sphere"
    diameter = 2.0 * np.cbrt(np.prod(axes))
    reynolds = speed * diameter / fluid["kinematic_viscosity"]
    tracks = run.tracks
    force = tracks["fluid_force"][:, :, 2].sum(axis=1)
    late = tracks["time"] > 2.0 / 3.0 * tracks["time"][-1]
    value = force[late].mean() / (0.5 * fluid["density"] * speed**2 * np.pi / 4.0 * diameter**2)
    half = len(force[late]) // 2
    drift = force[late][half:].mean() / force[late][:half].mean() - 1.0
    correlated = drag_coefficient(reynolds, axes, way) if "shape" in grain else standard_drag(reynolds)
    expected = by_finite_elements(name, reynolds, run.case["domain"]["size"][0] / diameter) or correlated
    return (f"{name.replace('_', ', ')}, Reynolds number {reynolds:.3g}: drag coefficient", value, expected, 0.10,
            f"correlation {correlated:.3f}; {drift:+.1%} from the first to the second half of it")


def settling(run):
    """Name of the quantity, value, reference, largest difference that passes, and what else to say."""
    case, grain = run.case, run.case["grains"][0]
    body, fluid = grain["shape"]["body"], case["fluid"]
    axes = half_axes(body)
    number = symmetry(axes)
    along = abs(axis_in_space(grain, number)[2]) > 0.5
    own, across = axes[number], np.sqrt(np.prod(axes) / axes[number])
    radius = oberbeck(own, across, along)
    box = np.array(case["domain"]["size"])
    volume, viscosity = body["volume"], fluid["density"] * fluid["kinematic_viscosity"]
    fraction, width = volume / box.prod(), box[0]
    weight = (grain["density"] - fluid["density"]) * volume * GRAVITY
    alone = weight / (6.0 * np.pi * viscosity * radius)
    expected = alone * (1.0 - 2.837297 * radius / width + fraction)
    grain_momentum, fluid_momentum = (run.series[f"{of}_momentum_z"] for of in ("grain", "fluid"))
    velocity = grain_momentum / (grain["density"] * volume)
    velocity = -(velocity - fraction * velocity - fluid_momentum / fluid["density"] / box.prod())
    late = run.series["time"] > 0.75 * run.series["time"][-1]
    spheroid = "prolate" if own > across else "oblate"
    return (f"{spheroid}, {'along' if along else 'across'} its axis: velocity [mm/s]", 1e3 * velocity[-1],
            1e3 * expected, 0.03, f"in a large box {1e3 * alone:.3f}, {np.ptp(velocity[late]) / velocity[-1]:.1%} change in the"
            f" last quarter, Reynolds number {velocity[-1] * np.cbrt(6 * volume / np.pi) / fluid['kinematic_viscosity']:.2g}")


def turned(q, vector):
    w, v = q[0], np.array(q[1:])
    return vector + 2.0 * np.cross(v, np.cross(v, vector) + w * vector)


def turning(run):
    """As settling(). The axis of symmetry is at the angle phi from the
    gradient of velocity, tan(phi) = r tan(2 pi t/T)."""
    case = run.case
    axes = half_axes(case["grains"][0]["shape"]["body"])
    number = symmetry(axes)
    ratio = axes[number] / np.sqrt(np.prod(axes) / axes[number])
    top, bottom = (case["domain"]["boundaries"][face]["velocity"][0] for face in ("top", "bottom"))
    rate = (top - bottom) / case["domain"]["size"][2]
    frames = list(run.grains)
    # In the order of rising moments, as the frame of the principal axes has them.
    own = np.eye(3)[0 if ratio > 1.0 else 2]
    directions = np.array([turned(frame.orientation[0], own) for frame in frames])
    times = np.array([frame.time for frame in frames])
    phase = np.unwrap(2.0 * np.arctan2(directions[:, 0] / ratio, directions[:, 2])) / 2.0
    steady = times >= STEADY
    slope, at_start = np.polyfit(times[steady], phase[steady], 1)
    apart = np.abs(phase[steady] - at_start - slope * times[steady]).max()
    return (f"{'prolate' if ratio > 1.0 else 'oblate'} of aspect ratio {ratio:.3f}: period times shear rate",
            rate * 2.0 * np.pi / slope, 2.0 * np.pi * (ratio + 1.0 / ratio), 0.03,
            f"{np.degrees(np.ptp(phase[steady])):.0f} degrees of phase, at most {np.degrees(apart):.1f} off a line,"
            f" {np.abs(directions[:, 1]).max():.1g} out of the plane")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN_FOLDER")
    verdict = Verdict()
    for folder in parser.parse_args().runs:
        run = thalweg.Run(folder)
        grain = run.case["grains"][0]
        compared = (towed if grain.get("prescribed_velocity") else
                    settling if grain["density"] > run.case["fluid"]["density"] else turning)
        name, value, reference, accepted, more = compared(run)
        good = abs(value / reference - 1.0) <= accepted
        print(f"{folder.name}: {name} {value:.4g}, reference {reference:.4g}, {100 * (value / reference - 1):+.2f} %:"
              f" {verdict(good)} ({more})")
    return verdict.exit_code


if __name__ == "__main__":
    sys.exit(main())
