"""Obstacles: grains that are none of the bed but stand in it, such as a sill, a pier or a boulder.

As the program has them (driver/bed/obstacles.hpp): of the grains that are fixed and placed by positions, those
that overlap another one by more than a twentieth of the smaller diameter, and those at least twice as large as the
largest free grain. A place where several overlap counts once. Solids that stand still are obstacles, too. The bed is
what is left, in the room that they leave.
(The program knows those that move as prescribed as well; frames with clumps are left to it.)
"""
import numpy as np

from thalweg.mesh_volume import volumes_in_layers

MERGED, AS_LARGE_AGAIN = 0.05, 2.0   # diameters of the smaller; times the largest free grain
NEUTRAL = 1e-6                       # of the fluid's density: grains no denser than that float
ROWS_A_RADIUS = 20


def apart(run, there, here):
    """Differences (m) of places [..., axis] from one place, to the nearest image in the periodic box."""
    difference = np.asarray(there, float) - here
    return difference - np.where(run.periodic, run.size * np.round(difference / run.size), 0.0)


def distance(run, there, here):
    """m, of places [..., axis] from one place."""
    return np.linalg.norm(apart(run, there, here), axis=-1)


def has_members(run, frame):
    """Whether a frame has members of clumps: by its field `clump`, or by the case where that is left out."""
    clump = frame.arrays.get("clump")
    return bool(np.any(clump >= 0)) if clump is not None else run is not None and run.has_clumps


def velocity_is_free(frame):
    """Which grains of a frame move freely; all where its fields leave out which are held."""
    held = frame.arrays.get("held")
    return np.ones(len(frame), bool) if held is None else held.astype(int) & 1 == 0


def fixed_by_position(run, frame):
    """Which grains of a frame the case fixes at positions."""
    found = np.zeros(len(frame), bool)
    for population in run.section("grains"):
        places = (population.get("placement") or {}).get("positions") or ()
        for place in places if population.get("fixed") else ():
            away = distance(run, frame.position, place)
            nearest = int(np.argmin(away))
            found[nearest] |= away[nearest] < 1e-3 * frame.radius[nearest]
    return found


def obstacles(run, frame):
    """Which grains of a frame are obstacles; none in a box that is periodic along z, and of disks."""
    stands = np.zeros(len(frame), bool)
    if run.periodic[2] or run.case.get("disks"):
        return stands
    fixed = np.flatnonzero(fixed_by_position(run, frame))
    for n, grain in enumerate(fixed):
        others = np.delete(fixed, n)
        smaller = np.minimum(frame.radius[others], frame.radius[grain])
        away = distance(run, frame.position[others], frame.position[grain])
        stands[grain] = np.any(away < frame.radius[others] + frame.radius[grain] - 2.0 * MERGED * smaller)
    free = np.ones(len(frame), bool)
    free[fixed] = False
    free &= velocity_is_free(frame)
    if free.any():
        stands[fixed] |= frame.radius[fixed] >= (1.0 - 1e-9) * AS_LARGE_AGAIN * frame.radius[free].max()
    return stands


def floating(run, frame):
    """Which grains of a frame float over a bed of others: free ones no denser than the fluid, as far as frames tell
    densities. They are no grains of the bed. (Frames with clumps are left to the program.)"""
    none, fluid = np.zeros(len(frame), bool), run.case.get("fluid")
    if not fluid or run.gravity[2] >= 0.0 or "density" not in frame.arrays:
        return none
    if has_members(run, frame):
        return none
    afloat = velocity_is_free(frame) & (frame.density <= (1.0 + NEUTRAL) * float(fluid["density"]))
    return afloat if afloat.any() and not (afloat | obstacles(run, frame)).all() else none


def union_in_layers(run, edges, position, radius):
    """m^3 between one edge (m) and the next that spheres fill together, overlaps counted once, from points a twentieth
    of the smallest radius apart: of one sphere right to 1 %."""
    volumes = np.zeros(len(edges) - 1)
    if not len(radius):
        return volumes
    finest = np.min(radius) / ROWS_A_RADIUS
    counts = np.ceil(run.size[:2] / finest).astype(int)
    step = run.size[:2] / counts
    x, y = ((np.arange(count) + 0.5) * width for count, width in zip(counts, step))
    points = np.stack(np.meshgrid(x, y, [0.0], indexing="ij"), axis=-1)[:, :, 0]
    squares = [np.sum(apart(run, points, place)[..., :2]**2, axis=-1) for place in position]   # from their axes
    for layer, (low, high) in enumerate(zip(edges[:-1], edges[1:])):
        heights = int(np.ceil((high - low) / finest))
        for z in low + (np.arange(heights) + 0.5) * (high - low) / heights:
            covered = np.zeros(counts, bool)
            for square, place, r in zip(squares, position, radius):
                if abs(place[2] - z) < r:
                    covered |= square < r**2 - (place[2] - z)**2
            volumes[layer] += covered.sum() * step[0] * step[1] * (high - low) / heights
    return volumes


def solids_in_layers(run, edges):
    """m^3 between one edge (m) and the next of the solids that stand still."""
    still = [n for n, solid in enumerate(run.case.get("solids") or ()) if not solid.get("motion")]
    if not still or run.periodic[2] or run.case.get("disks") or not len(run.solids):
        return np.zeros(len(edges) - 1)
    surface = run.solids[0]
    triangles = surface.triangles[np.isin(surface.solid, still)]
    return volumes_in_layers(surface.points, triangles, run.size, run.periodic, edges)
