"""Means of a fluid alone over the height."""
import matplotlib.pyplot as plt
import numpy as np

from thalweg.drawing import name_above
from thalweg.height_profiles import GRID


def measured(run):
    """Whether there are means of the fluid: they begin at a time of their own (`from`)."""
    return "fluid_statistics" in run.profiles and bool(np.any(run.profiles["fluid_statistics"]["velocity"]))


def figure_of(run):
    """Mean velocity along x and Reynolds stresses against height."""
    means = run.profiles["fluid_statistics"]
    z, velocity, stress = 1e3 * means["z"], means["velocity"][:, 0], means["reynolds_stress"]
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.8), sharey=True, constrained_layout=True)
    left.plot(velocity, z, color="#14496e")
    left.set(xlabel="mean velocity along x [m/s]", ylabel="z [mm]")
    for column, label in ((0, "$u'u'$"), (1, "$v'v'$"), (2, "$w'w'$"), (4, "$u'w'$")):
        right.plot(stress[:, column], z, label=label)
    right.xaxis.set_major_locator(plt.MaxNLocator(5))   # whose labels have five digits
    right.set(xlabel=r"Reynolds stress [m$^2$/s$^2$]")
    right.legend(frameon=False, fontsize=9)
    for axes in (left, right):
        axes.grid(**GRID)
    name_above(figure, run.name)
    return figure
