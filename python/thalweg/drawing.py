"""The side view: lit grains in front of the water, as thalweg plot draws it, alone and in films."""
import textwrap

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib import colors
from matplotlib.collections import EllipseCollection

from thalweg.errors import RunFolderError
from thalweg.units import units_of

GRAIN_COLOURS = matplotlib.colormaps["YlOrRd"]
FLUID_COLOURS = colors.LinearSegmentedColormap.from_list("water", ["#f4f8fb", "#a9cfe3", "#4a93bd", "#14496e"])
WATER = -1   # as grain_id; solids have lower ones
SOLID_COLOUR = "#8d8d8d"
PIXELS_PER_DIAMETER = 48
TITLE_SIZE = 11   # points
SOLID_PIXELS = 800   # along the longer side of the box, of the cut of solids
LINE, LETTER = 1.3 * TITLE_SIZE / 72.0, 0.6 * TITLE_SIZE / 72.0   # inches: height of a line, width of a letter


def refuse_column(run):
    """A continuum has no frames to be drawn."""
    if run.system == "continuum":
        raise RunFolderError(f"{run.folder}: a run of system: continuum has neither grains nor flow in space to show; "
                             "thalweg plot profiles draws its column.")


def frames_at(run, time=None):
    """The stored frames of grains and fluid that are nearest to a time (s) and to each other, without a time the last
    of which both are stored; None for what is not."""
    refuse_column(run)
    if time is None and run.fluid:
        time = run.fluid.times[-1]
    grains = run.grains.nearest(time)
    return grains, run.fluid.nearest(time if grains is None else grains.time)


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


def shifted(array, step, axis):
    """An array moved by one place up or down an axis; nought where nothing comes in."""
    moved = np.roll(array, step, axis)
    moved[(slice(None),) * axis + (0 if step > 0 else -1,)] = 0
    return moved


def without_holes(layer):
    """Masked cells filled from their neighbours, ring by ring: grains on top hide them but for their corners."""
    values, known = np.where(layer.mask, 0.0, layer.data), ~np.ma.getmaskarray(layer)
    while known.any() and not known.all():
        total, count = np.zeros_like(values), np.zeros(values.shape, int)
        for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
            total += shifted(np.where(known, values, 0.0), step, axis)
            count += shifted(known, step, axis)
        ring = ~known & (count > 0)
        values[ring] = total[ring] / count[ring]
        known |= ring
    return values


def with_periodic_images(position, radius, speed, size, periodic):
    """The grains and copies of those that stick out of a periodic face."""
    for axis in range(3):
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


def name_above(figure, name):
    """Writes a name above a figure, in as many lines as it takes; a dollar is one."""
    letters = int((figure.get_figwidth() - 0.2) / LETTER)
    figure.suptitle("\n".join(textwrap.wrap(name, letters)), fontsize=TITLE_SIZE, parse_math=False)


def time_in_words(run, time):
    return f"t = {time:.4g} {units_of(run).named('s')}"


def title_of(run, time):
    """What a picture shows, and when, which stays on one line."""
    return f"{run.name}, " + time_in_words(run, time).replace(" ", "\u00a0")


def time_of_its_own(run, fluid, time):
    """What stands below the name of the scale of the fluid in a picture at a time (s): when its frame was, where that
    is another time."""
    own = time_in_words(run, fluid.time)
    return "" if own == time_in_words(run, time) else f"\nat {own}"


def side_view_axes(run, time, bars):
    """A figure with axes to scale for x and z, that many places for colour bars to the right of them, and the title
    above, in as many lines as it takes; lengths in inches. Its size is the same at all times (s), as films need it."""
    size = run.size
    width, height = (7.0 * size[k] / max(size[0], size[2]) for k in (0, 2))
    left, right, below = 0.75, 0.15 + 1.0 * bars, 0.6
    letters = int((left + width + right - 0.2) / LETTER)
    above = 0.25 + LINE * len(textwrap.wrap(title_of(run, -1.234e-100), letters))
    total = np.array([left + width + right, below + height + above])
    figure = plt.figure(figsize=total)
    title = "\n".join(textwrap.wrap(title_of(run, time), letters))
    figure.text(0.5, 1.0 - 0.12 / total[1], title, ha="center", va="top", fontsize=TITLE_SIZE,
                parse_math=False)

    def place(x, z, w, h):
        return figure.add_axes([x / total[0], z / total[1], w / total[0], h / total[1]])

    axes, unit = place(left, below, width, height), units_of(run)
    axes.set(xlabel=f"x [{unit.length}]{flow_direction(run)}", ylabel=f"z [{unit.length}]")
    return figure, axes, [place(left + width + 0.2 + 1.0 * k, below, 0.18, height) for k in range(bars)]


def flow_direction(run, from_y=-1.0):
    """Text after the label of the x axis: which way the fluid goes along x, as seen from a direction whose component
    along y is from_y; none without a fluid, without anything that drives it along x, or where walls and gravity drive
    it in opposite directions."""
    fluid = run.case.get("fluid")
    if not fluid:
        return ""
    if fluid.get("mean_velocity"):   # in place of gravity along x
        drives = {np.sign(float(fluid["mean_velocity"]["velocity"]))}
    else:
        speeds = [velocity[0] for velocity in run.velocities_of_faces()]
        drives = set(np.sign([run.gravity[0], *speeds])) - {0.0}
    way = drives.pop() * -np.sign(from_y) if len(drives) == 1 else 0.0
    return {1.0: ", flow to the right", -1.0: ", flow to the left"}.get(way, "")


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


def typical_diameter(run, frame):
    """m, of the grains of a frame, or of the run's where the frame has none."""
    return np.median(frame.diameter) if len(frame) else run.diameter


def bed_figure(run, frame, fluid=None, largest_speed=None, largest_flow=None, scale=None):
    """A figure of the grains, coloured by speed, before the fluid's speed in the middle plane (`fluid`: its frame).
    largest_speed, largest_flow: ends of the scales in m/s, of this frame if None. scale: pixels per metre."""
    size = run.size
    speed = np.linalg.norm(frame.velocity, axis=1)
    if largest_speed is None:
        largest_speed = largest_speed_of(speed, typical_diameter(run, frame))
    position, radius, speed = with_periodic_images(frame.position, frame.radius, speed, size, run.periodic)
    extent = np.array([0.0, size[0], 0.0, size[2]])
    if scale is None:
        scale = max(PIXELS_PER_DIAMETER / typical_diameter(run, frame), 600 / max(size[0], size[2]))
        scale = min(scale, 3000 / max(size[0], size[2]))
    layer = fluid_slice(fluid) if fluid else None
    figure, axes, bars = side_view_axes(run, frame.time, 1 if layer is None else 2)
    unit = units_of(run)
    norm = colors.Normalize(0.0, unit.per_speed * largest_speed)
    image = render_spheres(position, radius, unit.per_speed * speed, extent, scale, norm)
    axes.imshow(image, origin="lower", extent=unit.per_length * extent, zorder=2)
    figure.colorbar(plt.cm.ScalarMappable(norm, GRAIN_COLOURS), cax=bars[0], label=f"grain speed [{unit.speed}]",
                    extend="max")
    if layer is not None:
        draw_water(figure, axes, bars[1], layer, unit, largest_flow, time_of_its_own(run, fluid, frame.time))
    if layer is None or not layer[2].any():
        draw_solids(axes, run, frame.time)
    axes.set(xlim=(0, unit.per_length * size[0]), ylim=(0, unit.per_length * size[2]))
    return figure


def flow_figure(run, fluid, largest_flow=None):
    """A figure of the fluid's speed in the middle plane. largest_flow: end of the scale in m/s, of this frame if
    None."""
    layer = fluid_slice(fluid) if fluid else None
    if layer is None:
        raise RunFolderError(f"{run.folder}: no frame of the velocity yet (output.fluid in the case).")
    figure, axes, bars = side_view_axes(run, fluid.time, 1)
    draw_water(figure, axes, bars[0], layer, units_of(run), largest_flow)
    return figure


def draw_water(figure, axes, bar, layer, unit, largest=None, when=""):
    """A layer of fluid_slice() with its scale, which ends at `largest` (m/s) or at its own largest speed. when: below
    the name of the scale."""
    flow, box, solid = layer
    extent = unit.per_length * np.array(box)
    water = axes.imshow(unit.per_speed * without_holes(flow), origin="lower", extent=extent, cmap=FLUID_COLOURS,
                        vmin=0.0, vmax=None if largest is None else unit.per_speed * largest, interpolation="bilinear",
                        zorder=1)
    figure.colorbar(water, cax=bar, label=f"fluid speed [{unit.speed}]{when}")
    if solid.any():
        fill_solid(axes, solid, extent)


def fill_solid(axes, solid, extent):
    """Pixels [z, x] of solids, behind the grains."""
    axes.imshow(np.ma.array(np.ones(solid.shape), mask=~solid), origin="lower", extent=extent,
                cmap=colors.ListedColormap([SOLID_COLOUR]), interpolation="nearest", zorder=1.5)


def draw_solids(axes, run, time):
    """The cut of the solids with the middle plane across y, from their surfaces; nothing where none is stored."""
    surfaces = run.solids.nearest(time)
    if surfaces is None:
        return
    size = run.size
    pixel = max(size[0], size[2]) / SOLID_PIXELS
    x, z = ((np.arange(int(np.ceil(size[k] / pixel))) + 0.5) * pixel for k in (0, 2))
    solid = np.zeros((len(z), len(x)), bool)
    for number in np.unique(surfaces.solid):
        solid |= inside_cut(surfaces.points[surfaces.triangles[surfaces.solid == number]], 0.5 * size[1], x, z)
    if solid.any():
        fill_solid(axes, solid, units_of(run).per_length * pixel * np.array([0, len(x), 0, len(z)]))


def inside_cut(triangles, y, x, z):
    """Whether the points of a grid, as [z, x], of the plane across y (m) are inside a closed surface of triangles
    [triangle, corner, axis] (m): an odd number of edges of the cut lies beside them."""
    ends = cut_of(triangles, y)
    inside = np.zeros((len(z), len(x)), bool)
    for row, height in enumerate(z):
        crossing = ends[(ends[:, 0, 1] <= height) != (ends[:, 1, 1] <= height)]
        (x0, z0), (x1, z1) = crossing[:, 0].T, crossing[:, 1].T
        edges = np.sort(x0 + (height - z0) / (z1 - z0) * (x1 - x0))
        inside[row] = np.searchsorted(edges, x) % 2 == 1
    return inside


def cut_of(triangles, y):
    """Edges [edge, end, (x, z)] in which a plane across y (m) cuts triangles [triangle, corner, axis] (m)."""
    above = triangles[..., 1] >= y
    triangles, above = (of[above.any(axis=1) & ~above.all(axis=1)] for of in (triangles, above))
    ends = []
    for k in range(3):   # from each corner that is alone on its side to the other two
        alone = (above[:, k] != above[:, k - 1]) & (above[:, k] != above[:, k - 2])
        corner, others = triangles[alone, k][:, None], triangles[alone][:, [k - 1, k - 2]]
        share = (y - corner[..., 1]) / (others[..., 1] - corner[..., 1])
        ends.append((corner + share[..., None] * (others - corner))[..., [0, 2]])
    return np.concatenate(ends)
