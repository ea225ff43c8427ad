"""Figures that only the page has."""
import matplotlib.pyplot as plt
import numpy as np

from thalweg.height_profiles import GRID
from thalweg.units import units_of

# Columns of series.csv and what they are called, in the order in which they count.
COURSE = {
    "moving_grains": "moving grains", "largest_grain_speed": "largest grain speed",
    "grain_kinetic_energy": "kinetic energy of the grains", "contacts": "contacts",
    "mean_velocity_x": "mean velocity of the fluid", "largest_fluid_speed": "largest fluid speed",
    "bed_stress": "stress on the bed", "surface_height": "height of the bed",
    "largest_overlap": "largest overlap",
}
MOST = 4   # panels


def series_figure(run):
    """Some columns of series.csv that change; None where there are none."""
    series = run.series
    if len(series["time"]) < 2:
        return None
    names = [
        name
        for name in COURSE
        if name in series and np.isfinite(series[name]).sum() > 1 and np.nanmax(np.abs(series[name])) > 0.0
    ][:MOST]
    if not names:
        return None
    rows, units = (len(names) + 1) // 2, units_of(run)
    figure, panels = plt.subplots(
        rows, min(2, len(names)), figsize=(9.0 if len(names) > 1 else 5.0, 2.3 * rows), squeeze=False, sharex=True,
        layout="constrained",
    )
    for axes in panels.flat[len(names):]:
        axes.remove()
    for axes, name in zip(panels.flat, names):
        axes.plot(series["time"], series[name], color="#14496e", lw=1.0)
        axes.set_title(f"{COURSE[name]} [{units.mathematical(series.units[name])}]", fontsize=9, loc="left")
        axes.set(xlabel=f"time [{units.named('s')}]", ylim=(0.0, None) if np.nanmin(series[name]) >= 0.0 else None)
        axes.grid(**GRID)
        axes.spines[["top", "right"]].set_visible(False)
    return figure
