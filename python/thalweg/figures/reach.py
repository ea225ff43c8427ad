"""Sediment along a reach (`analysis.reach`): level of the bed and transport in x and time, and their means."""
import matplotlib.pyplot as plt
import numpy as np

from thalweg.drawing import name_above
from thalweg.errors import RunFolderError
from thalweg.height_profiles import GRID
from thalweg.records import parts_of
from thalweg.units import units_of

BED, RATE = "#7f6a4d", "#14496e"
Q_STAR = r"$q^* = q_s\,/\sqrt{(s-1)\,g\,d^3}$"


def measured(run):
    """Whether the run has a record yet."""
    return bool(parts_of(run.folder, "reach")) and len(run.reach["time"]) > 0


def edges_of(places):
    """Edges of cells about places at equal distances."""
    half = 0.5 * (places[1] - places[0]) if len(places) > 1 else 0.5 * max(places[0], 1e-3)
    return np.append(places - half, places[-1] + half)


def with_end(places, length, *arrays):
    """Places along a box (m), and arrays [..., place]. Section 0 of a periodic box is its end as well, and stands there
    once more."""
    if places[0] > 0.0:
        return places, *arrays
    return np.append(places, length), *(np.concatenate([values, values[..., :1]], axis=-1) for values in arrays)


def with_gaps(time, interval, values):
    """Edges of the records in time, from their ends and intervals (s), and values [time, place], with a record of none
    wherever the run went on for a time without any."""
    begin = time - interval
    gaps = np.flatnonzero(begin[1:] - time[:-1] > 0.01 * interval[1:]) + 1
    return np.append(begin[0], np.insert(time, gaps, begin[gaps])), np.insert(values, gaps, np.nan, axis=0)


def draw_in_time(figure, axes, run, name, factor, label, units, **colours):
    """An array [time, place] as colours over x and the time of the records."""
    reach = run.reach
    places, values = with_end(reach[reach.dimensions(name)[1]], run.size[0], reach[name])
    times, values = with_gaps(reach["time"], reach["interval"], values)
    values = np.ma.masked_invalid(factor * values)
    drawn = axes.pcolormesh(units.per_length * edges_of(places), times, values, **colours)
    axes.set_facecolor("0.85")
    axes.set_ylabel(f"time $t$ [{units.named('s')}]")
    beyond = "max" if values.count() and values.max() > drawn.get_clim()[1] else "neither"
    figure.colorbar(drawn, ax=axes, label=label, pad=0.01, extend=beyond)


def colours_of(rates):
    """From nought on; about nought where the transport goes upstream somewhere."""
    low, high = float(np.nanmin(rates)), float(np.nanmax(rates))
    if low < 0.0:
        return {"cmap": "RdBu_r", "vmin": -max(-low, high), "vmax": max(-low, high)}
    return {"cmap": "viridis", "vmin": 0.0, "vmax": high or 1.0}


def counted(run, reach):
    """Which records count in the means; all where none does. A start, where a bed settles, may carry far more."""
    found = reach["time"] - reach["interval"] >= run.averaged_from("reach") * (1.0 - 1e-9)
    return found if found.any() else np.ones_like(found)


def draw_means(axes, run, name, label, units):
    """The mean transport of the sections with its error, and at the right the mean level of the bins."""
    means = run.profiles["reach"]
    x, rate, error = with_end(means["section"], run.size[0], means[name], np.nan_to_num(means[f"{name}_error"]))
    x = units.per_length * x
    axes.fill_between(x, rate - error, rate + error, color=RATE, alpha=0.2, lw=0)
    axes.plot(x, rate, color=RATE, lw=1.4)
    axes.set_ylabel(label, color=RATE)
    axes.set_ylim(min(0.0, np.nanmin(rate - error)), None)
    axes.grid(**GRID)
    level = axes.twinx()
    level.plot(units.per_length * means["x"], units.per_length * means["bed_level"], color=BED, lw=1.4)
    level.set_ylabel(f"bed level $z_b$ [{units.length}]", color=BED)
    level.spines["top"].set_visible(False)
    axes.spines["top"].set_visible(False)


def figure_of(run):
    """Above the level of the bed and below it the transport, in x and time; at the bottom their means over time."""
    reach = run.reach
    if not len(reach["time"]):
        raise RunFolderError(
            f"{run.folder}: no record of the reach is complete yet (analysis.reach.record_every in the case)."
        )
    units = units_of(run)
    name, label = ("q_star", Q_STAR) if "q_star" in reach else ("q_s", f"$q_s$ [{units.mathematical('m^2/s')}]")
    means = run.profiles.get("reach")
    has_means = means is not None and bool(np.isfinite(means[name]).any())
    figure, panels = plt.subplots(
        3 if has_means else 2, 1, figsize=(7.2, 7.5 if has_means else 5.4), sharex=True, layout="constrained"
    )
    bed_label = f"bed level $z_b$ [{units.length}]"
    draw_in_time(figure, panels[0], run, "bed_level", units.per_length, bed_label, units, cmap="cividis")
    draw_in_time(figure, panels[1], run, name, 1.0, label, units, **colours_of(reach[name][counted(run, reach)]))
    if has_means:
        draw_means(panels[2], run, name, label, units)
        panels[2].set_title(
            f"means from {run.averaged_from('reach'):.4g} {units.named('s')} on, in a band of one standard error",
            fontsize=9, loc="left",
        )
    panels[-1].set(xlabel=f"x [{units.length}]", xlim=(0.0, units.per_length * run.size[0]))
    name_above(figure, run.name)
    return figure
