"""The column of a continuum over the height."""
import matplotlib.pyplot as plt

from thalweg.drawing import name_above
from thalweg.height_profiles import GRID


def measured(run):
    """Whether the run has written it, which it does at its end."""
    return "continuum" in run.profiles


def figure_of(run):
    """Solid fraction, velocities and shear stresses over the height."""
    column = run.profiles["continuum"]
    z = 1e3 * column["z"]
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(9.0, 3.8), sharey=True, layout="constrained")
    left.plot(column["solid_fraction"], z, "k-")
    left.set(xlabel="solid fraction [1]", ylabel="z [mm]", xlim=(0.0, None))
    for name, label, colour in (("grain_velocity", "grains", "#c0392b"), ("fluid_velocity", "fluid", "#14496e")):
        middle.plot(column[name][:, 0], z, color=colour, label=label)
    middle.set(xlabel="velocity along x [m/s]")
    for name, label, style in (
        ("grain_shear_stress", "grains", {"color": "#c0392b"}),
        ("fluid_shear_stress", "fluid", {"color": "#14496e"}),
        ("total_stress", "total", {"color": "k", "lw": 2.0}),
        ("driving_stress", "driving", {"color": "#e08e79", "ls": "--"}),
    ):
        right.plot(column[name], z, label=label, **style)
    right.set(xlabel="shear stress [Pa]")
    for axes in (left, middle, right):
        axes.grid(**GRID)
    for axes in (middle, right):
        axes.legend(fontsize=8, frameon=False)
    name_above(figure, run.name)
    return figure
