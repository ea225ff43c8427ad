"""The side view: lit grains in front of the water, as thalweg plot draws it, alone and in films."""
import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib import colors
from matplotlib.collections import EllipseCollection

from thalweg.errors import RunFolderError

GRAIN_COLOURS = matplotlib.colormaps["YlOrRd"]
FLUID_COLOURS = colors.LinearSegmentedColormap.from_list("water", ["#f4f8fb", "#a9cfe3", "#4a93bd", "#14496e"])
WATER = -1   # as grain_id; solids have lower ones
SOLID_COLOUR = "#8d8d8d"
PIXELS_PER_DIAMETER = 48


def colour_of(number):
    """Colour of one of up to twenty curves: ten colours, then the same paler."""
    return matplotlib.colormaps["tab20"]((2 * number) % 20 + number // 10 % 2)


def fluid_slice(frame):
    """Speed (m/s; masked inside grains and solids) in the middle layer across y as [z, x], its extent in m, and which
    of its cells are solids'; None if the frame is not one of the velocity in the x-z plane."""
    cells = frame.arrays
    if "velocity" not in cells or 1 in (cells["velocity"].shape[0], cells["velocity"].shape[2]):
        return None
    middle = cells["velocity"].shape[1] // 2
    speed = np.ma.array(np.linalg.norm(cells["velocity"][:, middle].astype(float), axis=-1))
    holder = cells["grain_id"][:, middle] if "grain_id" in cells else np.full(speed.shape, WATER)
    speed.mask = holder != WATER
    upper = frame.corner + frame.spacing * cells["velocity"].shape[2::-1]
    return speed, (frame.corner[0], upper[0], frame.corner[2], upper[2]), holder < WATER


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


def side_view_axes(size):
    """A figure with axes to scale for x and z and two places for colour bars to the right; lengths in inches."""
    width, height = (7.0 * size[k] / max(size[0], size[2]) for k in (0, 2))
    left, right, below, above = 0.75, 2.15, 0.6, 0.45
    total = np.array([left + width + right, below + height + above])
    figure = plt.figure(figsize=total)

    def place(x, z, w, h):
        return figure.add_axes([x / total[0], z / total[1], w / total[0], h / total[1]])

    bars = [place(left + width + 0.2 + 1.0 * k, below, 0.18, height) for k in (0, 1)]
    return figure, place(left, below, width, height), bars


def flow_direction(run):
    """Text after the label of the x axis: which way the fluid goes along x; none without a fluid, without anything that
    drives it along x, or where walls and gravity drive it in opposite directions."""
    fluid = run.case.get("fluid")
    if not fluid:
        return ""
    if fluid.get("mean_velocity"):   # in place of gravity along x
        drives = {np.sign(float(fluid["mean_velocity"]["velocity"]))}
    else:
        speeds = [velocity[0] for velocity in run.velocities_of_faces()]
        drives = set(np.sign([run.gravity[0], *speeds])) - {0.0}
    return {(1.0,): ", flow to the right", (-1.0,): ", flow to the left"}.get(tuple(drives), "")


def draw_outlines(axes, position, radius, linewidth):
    """Grains (m) as circles on axes for x and z in mm, as seen along +y."""
    front_last = np.argsort(-position[:, 1])
    size = 2e3 * radius[front_last]
    axes.add_collection(EllipseCollection(
        size, size, 0 * size, units="xy", offsets=1e3 * position[front_last][:, [0, 2]],
        offset_transform=axes.transData, facecolor="#c9b48a", edgecolor="#6b5a36", linewidth=linewidth))


def largest_speed_of(speed, diameter):
    """End of the scale of grain speeds (m/s): the 90 % quantile of those above one diameter (m) a second."""
    moving = speed[speed > diameter]
    return float(np.quantile(moving, 0.9) if len(moving) else diameter)


def bed_figure(run, frame, fluid=None, largest_speed=None, largest_flow=None, scale=None):
    """A figure of the grains, coloured by speed, before the fluid's speed in the middle plane (`fluid`: its frame).
    largest_speed, largest_flow: ends of the scales in m/s, of this frame if None. scale: pixels per metre."""
    size = run.size
    speed = np.linalg.norm(frame.velocity, axis=1)
    if largest_speed is None:
        largest_speed = largest_speed_of(speed, np.median(frame.diameter))
    position, radius, speed = with_periodic_images(frame.position, frame.radius, speed, size, run.periodic)
    extent = np.array([0.0, size[0], 0.0, size[2]])
    if scale is None:
        scale = max(PIXELS_PER_DIAMETER / (2 * np.median(radius)), 600 / max(size[0], size[2]))
        scale = min(scale, 3000 / max(size[0], size[2]))
    figure, axes, bars = side_view_axes(size)
    norm = colors.Normalize(0.0, 1e2 * largest_speed)
    image = render_spheres(position, radius, 1e2 * speed, extent, scale, norm)
    axes.imshow(image, origin="lower", extent=1e3 * extent, zorder=2)
    figure.colorbar(plt.cm.ScalarMappable(norm, GRAIN_COLOURS), cax=bars[0], label="grain speed [cm/s]", extend="max")
    layer = fluid_slice(fluid) if fluid else None
    if layer is None:
        bars[1].remove()
    else:
        draw_water(figure, axes, bars[1], layer, largest_flow)
    axes.set(xlabel=f"x [mm]{flow_direction(run)}", ylabel="z [mm]", xlim=(0, 1e3 * size[0]), ylim=(0, 1e3 * size[2]))
    axes.set_title(f"{run.name}, t = {frame.time:.4g} s", fontsize=11)
    return figure


def flow_figure(run, fluid, largest_flow=None):
    """A figure of the fluid's speed in the middle plane. largest_flow: end of the scale in m/s, of this frame if
    None."""
    layer = fluid_slice(fluid) if fluid else None
    if layer is None:
        raise RunFolderError(f"{run.folder}: no frame of the velocity yet (output.fluid in the case).")
    figure, axes, bars = side_view_axes(run.size)
    draw_water(figure, axes, bars[0], layer, largest_flow)
    bars[1].remove()
    axes.set(xlabel=f"x [mm]{flow_direction(run)}", ylabel="z [mm]")
    axes.set_title(f"{run.name}, t = {fluid.time:.4g} s", fontsize=11)
    return figure


def draw_water(figure, axes, bar, layer, largest=None):
    """A layer of fluid_slice() with its scale, which ends at `largest` (m/s) or at its own largest speed."""
    flow, box, solid = layer
    water = axes.imshow(1e2 * without_holes(flow), origin="lower", extent=1e3 * np.array(box), cmap=FLUID_COLOURS,
                        vmin=0.0, vmax=None if largest is None else 1e2 * largest, interpolation="bilinear", zorder=1)
    figure.colorbar(water, cax=bar, label="fluid speed [cm/s]")
    if solid.any():
        axes.imshow(np.ma.array(np.ones(solid.shape), mask=~solid), origin="lower", extent=1e3 * np.array(box),
                    cmap=colors.ListedColormap([SOLID_COLOUR]), interpolation="nearest", zorder=1.5)
