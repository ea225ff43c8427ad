#!/usr/bin/python3
"""Draws a run: bed.png (the grains from the side before the flow) and transport_rate.png (q* against time).

    plot_run.py RUN_FOLDER [--out FOLDER] [--time SECONDS]

Of a fluid alone: flow.png (the flow in the middle plane) and profiles.png (means over the height), as far as they were
asked for in the case.

Works on a finished run and on one that is still going. The interpreter is Debian's own, whose packages scripts/setup
installs.
"""
import argparse
import csv
import math
import pathlib
import sys
import xml.etree.ElementTree as xml

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import yaml
from matplotlib import colors

GRAIN_COLOURS = matplotlib.colormaps["YlOrRd"]
FLUID_COLOURS = colors.LinearSegmentedColormap.from_list("water", ["#f4f8fb", "#a9cfe3", "#4a93bd", "#14496e"])
PIXELS_PER_DIAMETER = 48


class PlotError(Exception):
    """Something the user can put right."""


def picture_at(index, time):
    """(time in s, path) of the entry of a .pvd index nearest to `time`; the last one if `time` is None."""
    if not index.exists():
        return None
    entries = [(float(e.get("timestep")), index.parent / e.get("file")) for e in xml.parse(index).iter("DataSet")]
    if not entries:
        return None
    return entries[-1] if time is None else min(entries, key=lambda entry: abs(entry[0] - time))


def read_vtk(path):
    """The data set in a .vtp, .vti or .pvti file."""
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPImageDataReader, vtkXMLPolyDataReader

    readers = {".vtp": vtkXMLPolyDataReader, ".vti": vtkXMLImageDataReader, ".pvti": vtkXMLPImageDataReader}
    if not path.exists():
        raise PlotError(f"{path}: the picture its index names does not exist.")
    reader = readers[path.suffix]()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def read_grains(path):
    """Positions (m), radii (m) and speeds (m/s) of the grains in a .vtp file."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    data = read_vtk(path)
    if data.GetNumberOfPoints() == 0:
        raise PlotError(f"{path}: there are no grains in this picture.")
    position = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    array = {name: vtk_to_numpy(data.GetPointData().GetArray(name)) for name in ("radius", "velocity")}
    return position, array["radius"].astype(float), np.linalg.norm(array["velocity"], axis=1)


def read_fluid_slice(path):
    """Speed (m/s; masked inside grains) in the middle layer across y as [z, x], and its extent in m."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    image = read_vtk(path)
    nx, ny, nz = (max(n - 1, 1) for n in image.GetDimensions())
    cells = image.GetCellData()
    if cells.GetArray("velocity") is None or nx == 1 or nz == 1:
        return None   # not a picture of the x-z plane
    velocity = vtk_to_numpy(cells.GetArray("velocity")).reshape(nz, ny, nx, 3)[:, ny // 2]
    speed = np.ma.array(np.linalg.norm(velocity.astype(float), axis=-1))
    if cells.GetArray("grain_id") is not None:
        speed.mask = vtk_to_numpy(cells.GetArray("grain_id")).reshape(nz, ny, nx)[:, ny // 2] >= 0
    bounds = image.GetBounds()
    return speed, (bounds[0], bounds[1], bounds[4], bounds[5])


def without_holes(layer):
    """Masked cells filled from their neighbours, ring by ring: grains on top hide them but for their corners."""
    values, known = np.where(layer.mask, 0.0, layer.data), ~np.ma.getmaskarray(layer)
    while known.any() and not known.all():
        total, count = np.zeros_like(values), np.zeros(values.shape, int)
        for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
            total += np.roll(np.where(known, values, 0.0), step, axis)
            count += np.roll(known, step, axis)
        ring = ~known & (count > 0)
        values[ring] = total[ring] / count[ring]
        known |= ring
    return values


def with_periodic_images(position, radius, speed, size, periodic):
    """The grains and copies of those that stick out of a periodic face across x or y."""
    for axis in (0, 1):
        if not periodic[axis]:
            continue
        low, high = position[:, axis] < radius, position[:, axis] > size[axis] - radius
        shift = np.zeros(3)
        shift[axis] = size[axis]
        position = np.vstack([position, position[low] + shift, position[high] - shift])
        radius = np.concatenate([radius, radius[low], radius[high]])
        speed = np.concatenate([speed, speed[low], speed[high]])
    return position, radius, speed


def render_spheres(position, radius, speed, extent, scale, norm):
    """An RGBA image of lit spheres seen along +y, rows from the bottom up; transparent where there is no grain.

    A depth buffer by hand: it needs no display and no OpenGL, and a bed of thousands of grains takes a second.
    """
    scale *= 2   # twice as fine, averaged at the end: smooth edges
    width, height = (2 * int(round((extent[k + 1] - extent[k]) * scale / 2)) for k in (0, 2))
    depth = np.full((height, width), -np.inf)
    image = np.zeros((height, width, 4))
    light = np.array([-0.35, 0.62, 0.70])   # x, towards the eye, up
    light /= np.linalg.norm(light)
    for centre, r, v in zip(position, radius, speed):
        cx, cz, rp = (centre[0] - extent[0]) * scale, (centre[2] - extent[2]) * scale, r * scale
        x0, x1 = max(int(cx - rp), 0), min(int(cx + rp) + 2, width)
        z0, z1 = max(int(cz - rp), 0), min(int(cz + rp) + 2, height)
        if x0 >= x1 or z0 >= z1:
            continue
        dx, dz = np.meshgrid((np.arange(x0, x1) + 0.5 - cx) / rp, (np.arange(z0, z1) + 0.5 - cz) / rp)
        inside = dx * dx + dz * dz < 1.0
        up = np.sqrt(np.where(inside, 1.0 - dx * dx - dz * dz, 0.0))
        nearer = inside & (up * r - centre[1] > depth[z0:z1, x0:x1])
        lit = np.clip(dx * light[0] + up * light[1] + dz * light[2], 0.0, 1.0)
        shine = 0.35 * lit**24
        rgb = np.array(GRAIN_COLOURS(norm(v))[:3]) * (0.34 + 0.66 * lit)[..., None] + shine[..., None]
        image[z0:z1, x0:x1][nearer] = np.dstack([np.clip(rgb, 0, 1), np.ones_like(lit)])[nearer]
        depth[z0:z1, x0:x1][nearer] = (up * r - centre[1])[nearer]
    fine = image.reshape(height // 2, 2, width // 2, 2, 4)
    alpha = fine[..., 3].mean(axis=(1, 3))
    rgb = (fine[..., :3] * fine[..., 3:]).mean(axis=(1, 3)) / np.maximum(alpha, 0.25)[..., None]
    return np.dstack([rgb, alpha])


def draw_bed(folder, case, time, path):
    """The grains, coloured by speed, before the fluid's speed in the middle plane."""
    grains = picture_at(folder / "grains.pvd", time)
    if grains is None:
        raise PlotError(f"{folder}: no picture of the grains yet (output.grains.every in the case).")
    position, radius, speed = read_grains(grains[1])
    size = np.array(case["domain"]["size"], float)
    boundaries = case["domain"].get("boundaries", {})
    periodic = [face_type(boundaries.get(axis)) == "periodic" for axis in ("x", "y")]
    largest = max(np.quantile(speed, 0.98), 1e-3)
    position, radius, speed = with_periodic_images(position, radius, speed, size, periodic)

    extent = np.array([0.0, size[0], 0.0, size[2]])
    scale = max(PIXELS_PER_DIAMETER / (2 * np.median(radius)), 600 / max(size[0], size[2]))   # pixels per metre
    scale = min(scale, 3000 / max(size[0], size[2]))
    figure, axes, bars = side_view(size)
    norm = colors.Normalize(0.0, 1e2 * largest)
    image = render_spheres(position, radius, 1e2 * speed, extent, scale, norm)
    axes.imshow(image, origin="lower", extent=1e3 * extent, zorder=2)
    figure.colorbar(plt.cm.ScalarMappable(norm, GRAIN_COLOURS), cax=bars[0], label="grain speed [cm/s]", extend="max")
    fluid = picture_at(folder / "fluid.pvd", grains[0])
    layer = read_fluid_slice(fluid[1]) if fluid else None
    if layer is None:
        bars[1].remove()
    else:
        flow, box = layer
        water = axes.imshow(1e2 * without_holes(flow), origin="lower", extent=1e3 * np.array(box), cmap=FLUID_COLOURS,
                            vmin=0.0, interpolation="bilinear", zorder=1)
        figure.colorbar(water, cax=bars[1], label="fluid speed [cm/s]")
    axes.set(xlabel="x [mm], flow to the right", ylabel="z [mm]", xlim=(0, 1e3 * size[0]), ylim=(0, 1e3 * size[2]))
    axes.set_title(f"{case.get('name', folder.name)}, t = {grains[0]:.3g} s", fontsize=11)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def draw_flow(folder, case, time, path):
    """The fluid's speed in the middle plane."""
    fluid = picture_at(folder / "fluid.pvd", time)
    layer = read_fluid_slice(fluid[1]) if fluid else None
    if layer is None:
        raise PlotError(f"{folder}: no picture of the velocity yet (output.fluid in the case).")
    size = np.array(case["domain"]["size"], float)
    flow, box = layer
    figure, axes, bars = side_view(size)
    water = axes.imshow(1e2 * without_holes(flow), origin="lower", extent=1e3 * np.array(box), cmap=FLUID_COLOURS,
                        vmin=0.0, interpolation="bilinear")
    figure.colorbar(water, cax=bars[0], label="fluid speed [cm/s]")
    bars[1].remove()
    axes.set(xlabel="x [mm]", ylabel="z [mm]")
    axes.set_title(f"{case.get('name', folder.name)}, t = {fluid[0]:.3g} s", fontsize=11)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def draw_profiles(folder, case, path):
    """Mean velocity along x and Reynolds stresses over the height."""
    with h5py.File(folder / "profiles.h5") as file:
        means = file["fluid_statistics"]
        z, velocity, stress = 1e3 * means["z"][:], means["velocity"][:, 0], means["reynolds_stress"][:]
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.8), sharey=True, constrained_layout=True)
    left.plot(velocity, z, color="#14496e")
    left.set(xlabel="mean velocity along x [m/s]", ylabel="z [mm]")
    for column, label in ((0, "$u'u'$"), (1, "$v'v'$"), (2, "$w'w'$"), (4, "$u'w'$")):
        right.plot(stress[:, column], z, label=label)
    right.set(xlabel=r"Reynolds stress [m$^2$/s$^2$]")
    right.legend(frameon=False, fontsize=9)
    for axes in (left, right):
        axes.grid(color="#e5e8ea", linewidth=0.8)
    figure.suptitle(case.get("name", folder.name), fontsize=11)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def side_view(size):
    """A figure with axes to scale for x and z and two places for colour bars to the right; lengths in inches."""
    width, height = (7.0 * size[k] / max(size[0], size[2]) for k in (0, 2))
    left, right, below, above = 0.75, 2.15, 0.6, 0.45
    total = np.array([left + width + right, below + height + above])
    figure = plt.figure(figsize=total)

    def place(x, z, w, h):
        return figure.add_axes([x / total[0], z / total[1], w / total[0], h / total[1]])

    bars = [place(left + width + 0.2 + 1.0 * k, below, 0.18, height) for k in (0, 1)]
    return figure, place(left, below, width, height), bars


def face_type(boundary):
    """A boundary is written as its type or as a mapping with the key type."""
    return boundary.get("type") if isinstance(boundary, dict) else boundary


def read_series(path):
    """Columns of series.csv by name without the unit; a last row cut short by a running program is left out."""
    if not path.exists():
        raise PlotError(f"{path}: there is no such file; is this the folder of a run?")
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    if len(rows) < 2:
        raise PlotError(f"{path}: there is no measurement in it yet.")
    names = [heading.split(" [")[0].strip() for heading in rows[0]]
    values = np.array([[float(v) for v in row] for row in rows[1:] if len(row) == len(names)])
    return dict(zip(names, values.T))


def running_mean(time, value, window):
    """Mean over [t - window/2, t + window/2], narrower at the ends."""
    total = np.concatenate([[0.0], np.cumsum(value)])
    first, last = np.searchsorted(time, time - window / 2), np.searchsorted(time, time + window / 2, side="right")
    return (total[last] - total[first]) / (last - first)


def range_of_interest(rate, counted):
    """Limits that show what counts: grains that settle at the start may carry tens of times as much."""
    low, high = min(0.0, 1.05 * float(np.min(rate))), 1.08 * float(np.max(rate))
    if 0.0 < np.max(counted) < 0.25 * np.max(rate):
        high = 1.5 * float(np.max(counted))
    return low, high if high > low else low + 1.0


def draw_transport_rate(folder, case, path):
    """q* against time with its running mean and the mean that summary.json reports."""
    series = read_series(folder / "series.csv")
    name, label = "q_star", r"transport rate $q^*$ [1]"
    if name not in series:
        name, label = "q_s", r"transport rate $q_s$ [m$^2$/s]"
    if name not in series:
        raise PlotError(f"{folder / 'series.csv'}: it has no column q_star (analysis.transport_rate in the case).")
    time, rate = series["time"], series[name]
    start = float(((case.get("analysis") or {}).get("transport_rate") or {}).get("from", 0.0))
    figure, axes = plt.subplots(figsize=(7.6, 3.8), constrained_layout=True)
    axes.plot(time, rate, color="#9bbfd6", linewidth=0.9, label="measured")
    window = 0.1 * (time[-1] - time[0])
    if len(time) > 20:
        axes.plot(time, running_mean(time, rate, window), color="#14496e", linewidth=1.8,
                  label=f"mean over {window:.2g} s")
    counted = time >= start
    if counted.any():
        mean = float(np.mean(rate[counted]))
        axes.hlines(mean, max(start, time[0]), time[-1], color="#c0392b", linestyle="--", linewidth=1.3,
                    label=f"mean from {start:g} s on: {mean:.3g}")
    axes.set(xlabel="time [s]", ylabel=label, xlim=(time[0], time[-1] if time[-1] > time[0] else time[0] + 1))
    axes.set_ylim(*range_of_interest(rate, rate[counted] if counted.any() else rate))
    axes.set_title(case.get("name", folder.name), fontsize=11)
    axes.grid(color="#e5e8ea", linewidth=0.8)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=9)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def pictures_of(folder, case, time):
    """Names of the pictures that the system and the case call for, and who draws them."""
    analysis = case.get("analysis") or {}
    if case.get("system") == "fluid":
        pictures = [("flow.png", lambda path: draw_flow(folder, case, time, path))]
        if "fluid_statistics" in analysis and (folder / "profiles.h5").exists():
            pictures.append(("profiles.png", lambda path: draw_profiles(folder, case, path)))
        return pictures
    pictures = [("bed.png", lambda path: draw_bed(folder, case, time, path))]
    if case.get("system") != "grains" or "transport_rate" in analysis:
        pictures.append(("transport_rate.png", lambda path: draw_transport_rate(folder, case, path)))
    return pictures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run_folder", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, help="folder for the pictures (default: the run folder)")
    parser.add_argument("--time", type=float, help="simulated time in s of bed.png (default: the last picture)")
    arguments = parser.parse_args()
    folder = arguments.run_folder
    out = arguments.out or folder
    try:
        if arguments.time is not None and not math.isfinite(arguments.time):
            raise PlotError(f"--time {arguments.time}: give a time in s.")
        if not (folder / "case.yaml").exists():
            raise PlotError(f"{folder}: there is no case.yaml in it; give the folder of a run.")
        case = yaml.safe_load((folder / "case.yaml").read_text())
        out.mkdir(parents=True, exist_ok=True)
        for name, draw in pictures_of(folder, case, arguments.time):
            draw(out / name)
            print(out / name)
    except PlotError as error:
        print(f"plot_run: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
