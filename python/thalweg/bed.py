"""Surface of a bed, depth of the flow over it and Shields number, measured."""
import numpy as np

from thalweg.errors import RunFolderError
from thalweg.layers import layer_profiles
from thalweg.means import at_equal_intervals
from thalweg.obstacles import floating, has_members, obstacles
from thalweg.run import DRAGGING
from thalweg.side_view import static_surface
from thalweg.units import units_of


def surface_by_solid_fraction(z, fraction, window=0.0):
    """Height (m) at which the solid fraction, a mean over `window` (m), falls to half of the bed's, between the middles
    z (m) of two layers. The bed's is the mean between the heights below which 10 and 50 % of all grains lie, as in
    `analysis.bed_surface`."""
    z, fraction = np.asarray(z, float), np.nan_to_num(np.asarray(fraction, float))
    if not np.sum(fraction) > 0.0:
        raise RunFolderError("these profiles hold no grains; nothing has been measured yet.")
    if len(z) < 2:
        raise RunFolderError("there is a single layer, which has no surface of a bed.")
    between = 0.5 * (z[1:] + z[:-1])
    edges = np.concatenate([[2.0 * z[0] - between[0]], between, [2.0 * z[-1] - between[-1]]])
    below = np.concatenate([[0.0], np.cumsum(fraction * np.diff(edges))])
    shares = np.array([0.1, 0.5]) * below[-1]
    low, high = np.interp(shares, below, edges)
    half = 0.5 * (shares[1] - shares[0]) / (high - low)
    if window > 0.0:
        lower, upper = np.maximum(z - 0.5 * window, edges[0]), np.minimum(z + 0.5 * window, edges[-1])
        fraction = (np.interp(upper, edges, below) - np.interp(lower, edges, below)) / (upper - lower)
    last = np.flatnonzero(fraction >= half)[-1]
    if last + 1 == len(z):
        raise RunFolderError("the grains reach the top: there is no surface of a bed.")
    share = (fraction[last] - half) / (fraction[last] - fraction[last + 1])
    return float(z[last] + share * (z[last + 1] - z[last]))


def has_profiles_of(run, start, stop):
    """Whether the profiles that the run gathered are means over the time from `start` to `stop` (s)."""
    time = run.series["time"]
    steps = np.diff(time[at_equal_intervals(time)])
    interval = 2.0 * float(np.median(steps)) if len(steps) else 0.0   # a gap in the rows is none
    return ("grain_profiles" in run.profiles and abs(run.averaged_from("grain_profiles") - start) <= interval and
            stop >= time[-1] - interval)


def bed_height(run, start=-np.inf, stop=np.inf):
    """Height (m) of the surface by solid fraction, from profiles.h5 or, if it has none, times (s) are given, or it holds
    more than the bed, from the frames between them, in layers of a quarter of a diameter. Without times they are the
    frames from the begin of the run's own means on."""
    if "grain_profiles" in run.profiles and not np.isfinite([start, stop]).any():
        if not more_than_the_bed(run):
            profiles = run.profiles["grain_profiles"]
            return surface_by_solid_fraction(profiles["z"], profiles["solid_fraction"], run.diameter)
        start = run.averaged_from("grain_profiles")
    profiles = layer_profiles(run, start, stop, 0.25 * run.diameter, bed_only=True)
    return surface_by_solid_fraction(profiles["z"], profiles["solid_fraction"], run.diameter)


def any_float(run):
    """Whether the last frame has grains that float over a bed of others."""
    return len(run.grains) > 0 and bool(floating(run, run.grains[-1]).any())


def more_than_the_bed(run):
    """Whether there is more in the box than the bed and water, as the frames tell: grains that float, obstacles, solids.
    The means of profiles.h5 count such grains, and solids take no room from them. (Frames with clumps tell nothing.)"""
    if not len(run.grains) or has_members(run, run.grains[-1]):
        return False
    return any_float(run) or is_obstructed(run)


def static_bed_height(run, start=-np.inf, stop=np.inf, frames=10):
    """Height (m) of the surface by static pixels, the mean over that many times between two (s) at which there are
    any."""
    times = run.grains.between(start, stop).times
    if len(times) == 0:
        raise RunFolderError(
            f"{run.folder}: there is no frame of the grains between {start:g} and {stop:g} {units_of(run).named('s')}."
        )
    chosen = np.unique(np.linspace(0, len(times) - 1, frames).astype(int))
    heights = np.array([static_surface(run, times[k]).mean for k in chosen])
    if np.isnan(heights).all():
        raise RunFolderError(f"{run.folder}: no grain is at rest long enough for a static pixel.")
    return float(np.nanmean(heights))


def hydraulic_radius(depth, width=None, side_walls=2):
    """m: H W/(n H + W) in a channel that wide beside n side walls, H without (Zhang et al. 2022, sec. 2.2 and 2.3)."""
    return depth if width is None else depth * width / (side_walls * depth + width)


def shields_of(slope, depth, diameter, density_ratio, width=None, side_walls=2):
    """Shields number R sin(atan(slope))/((s - 1) d), with R the hydraulic radius; lengths in m."""
    return np.sin(np.arctan(slope)) * hydraulic_radius(depth, width, side_walls) / ((density_ratio - 1.0) * diameter)


def slope_of(shields, depth, diameter, density_ratio, width=None, side_walls=2):
    """Slope (a tangent) that gives a Shields number: the inverse of shields_of(); lengths in m."""
    return np.tan(np.arcsin(shields * (density_ratio - 1.0) * diameter / hydraulic_radius(depth, width, side_walls)))


def measured_shields_number(run, start, stop):
    """Mean between two times (s) of the Shields number that `analysis.bed_surface` wrote into series.csv."""
    if run.side_walls_move:
        raise RunFolderError(
            f"{run.folder}: the share of side walls that move does not follow from the hydraulic radius; the bed stress "
            "is that of analysis.stress_balance."
        )
    if "shields_number" not in run.series and "bed_height" in run.series:
        raise RunFolderError(
            f"{run.folder}: analysis.bed_surface has no Shields number where neither a slope nor a held mean velocity nor "
            "a moving top drives the flow."
        )
    if "shields_number" not in run.series and run.driven_by_slope and not is_obstructed(run):
        raise RunFolderError(
            f"{run.folder}: a restart at {run.driven_alike_since:g} {units_of(run).named('s')} changed what drives the"
            " flow; choose times after it, or add analysis.bed_surface to the case, which measures the Shields number."
        )
    if "shields_number" not in run.series:
        raise RunFolderError(
            f"{run.folder}: the Shields number of this flow does not follow from its slope alone, but from forces that "
            "a run measures: add analysis.bed_surface to the case."
        )
    return mean_between(run, "shields_number", start, stop)


def mean_between(run, column, start, stop):
    """Mean of a column of series.csv between two times (s). Rows that have no number, because nothing could be
    measured, do not count; RunFolderError where none has."""
    values = run.series[column][rows_between(run, start, stop)]
    values = values[np.isfinite(values)]
    if not len(values):
        raise RunFolderError(
            f"{run.folder / 'series.csv'}: no row from {start:g} to {stop:g} s has a number in the column " f"{column}."
        )
    return float(np.mean(values))


def rows_between(run, start, stop):
    """Rows of series.csv between two times (s), at equal intervals."""
    time = run.series["time"]
    rows = np.flatnonzero((time >= start - 1e-9) & (time <= stop + 1e-9))
    return rows[at_equal_intervals(time[rows])]


def is_obstructed(run):
    """Whether solids, or grains that are obstacles, take a part of the force that drives the flow."""
    return bool(run.case.get("solids")) or (len(run.grains) > 0 and bool(obstacles(run, run.grains[0]).any()))


def share_of_gravity(run, start=-np.inf, stop=np.inf):
    """Mean of gravity between two times (s) over its full value: below 1 while `run.ramp` raises it as 3 x^2 - 2 x^3 of
    its duration. 1 where no times are given."""
    duration = float((run.case.get("run") or {}).get("ramp") or 0.0)
    if not duration > 0.0 or not np.isfinite([start, stop]).any():
        return 1.0
    first, last = max(start, 0.0), min(stop, float(run.series["time"][-1]))

    def impulse(time):
        x = min(time / duration, 1.0)
        return duration * (x**3 - 0.5 * x**4) + max(time - duration, 0.0)
    return (impulse(last) - impulse(first)) / (last - first) if last > first else 1.0


def follows_from_slope(run, start=-np.inf):
    """Whether the stress on the bed from a time (s) on is that of the slope in the case."""
    return run.driven_by_slope and not is_obstructed(run) and run.driven_alike_since <= start


def shields_number(run, surface, start=-np.inf, stop=np.inf, by_solid_fraction=True):
    """Shields number of a run whose bed ends at the height `surface` (m), negative towards -x: where a slope drives the
    flow by depth and slope, or by hydraulic radius beside side walls, with the mean gravity between two times (s); else,
    where obstacles stand in the flow, and where a restart after the first time changed gravity, the mean between them of
    what the run measured for the surface by solid fraction, and for another one as much more as its hydraulic radius is
    larger. RunFolderError where that cannot be said, because the top drags on the flow as well."""
    if follows_from_slope(run, start):
        sine = run.gravity[0] / np.linalg.norm(run.gravity)
        return share_of_gravity(run, start, stop) * shields_of(
            np.tan(np.arcsin(sine)), run.size[2] - surface, run.diameter, run.density_ratio, run.size[1], run.side_walls
        )
    measured = measured_shields_number(run, start, stop)
    if by_solid_fraction:
        return measured
    if run.faces("z")[1] in DRAGGING:
        raise RunFolderError(
            f"{run.folder}: the top of the box drags on the flow, and the stress was measured for the surface by "
            "solid fraction."
        )
    radius = mean_between(run, "hydraulic_radius", start, stop)
    return measured * hydraulic_radius(run.size[2] - surface, run.size[1], run.side_walls) / radius


def transport_rate(run, start=None, stop=np.inf, column="q_star"):
    """Times (s), at equal intervals, and q* of a run between two times (s); from the begin of its means on if no start
    is given.

    column: q_s for the flux in m^2/s, which grains without a fluid have as well. RunFolderError where there is none.
    """
    if column not in run.series:
        raise RunFolderError(
            f"{run.folder / 'series.csv'}: it has no column {column} (analysis.transport_rate in the case)."
        )
    if start is None:
        start = run.averaged_from("transport_rate")
    rows = rows_between(run, start, stop)
    rows = rows[np.isfinite(run.series[column][rows])]
    if not len(rows):
        second = units_of(run).named("s")
        raise RunFolderError(f"{run.folder / 'series.csv'}: there is no measurement from {start:g} {second} on yet.")
    return run.series["time"][rows], run.series[column][rows]
