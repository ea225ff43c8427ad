"""Profiles of the grains a camera sees, as fig. 5(e, f) of Zhang et al. (2022).

Areal fraction, velocity along x and temperature over the height from the surface of static pixels; thalweg.side_view
and thalweg.visible_profiles say what is visible, what is static, and what the temperature is.
"""
import matplotlib.pyplot as plt
import numpy as np

from thalweg.height_profiles import GRID
from thalweg.units import units_of
from thalweg.visible_profiles import visible_profiles


def positive(values):
    return np.where(values > 0, values, np.nan)


def figure_of(runs, start, stop, most_frames):
    """start, stop: of the means, s."""
    figure, axes = plt.subplots(1, 3, figsize=(10, 4), sharey=True, layout="constrained")
    for run in runs:
        means = visible_profiles(run, start, stop, most_frames=most_frames)
        z = means["z"] / run.diameter
        axes[0].plot(means["areal_fraction"], z, "o-", ms=3, lw=0.8, label=run.name)
        axes[1].semilogx(positive(means["velocity"][:, 0]), z, "o-", ms=3, lw=0.8)
        axes[2].semilogx(positive(means["temperature"]), z, "o-", ms=3, lw=0.8)
    axes[0].set(xlabel="areal fraction", ylabel="height from the surface [d]")
    units = units_of(runs[0])
    axes[1].set(xlabel=f"velocity along x [{units.mathematical('m/s')}]")
    axes[2].set(xlabel=f"temperature [{units.mathematical('m^2/s^2')}]")
    axes[0].legend(fontsize=8)
    for axis in axes:
        axis.axhline(0.0, color="0.6", lw=0.8)
        axis.grid(**GRID)
    return figure
