"""A resolved bed beside the two-phase continuum, after figs. 8, 10(b) and 11 of Zhang et al. (2022), and the drag of
its layers.

The resolved run has `analysis.stress_balance`; the continuum is a run with `system: continuum`, best with `creep: {}`,
of the same slope, grains and fluid. Heights are from the surface by solid fraction of each.
"""
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import LogFormatter

from thalweg.bed import surface_by_solid_fraction
from thalweg.drawing import name_above
from thalweg.errors import RunFolderError
from thalweg.height_profiles import GRID, component
from thalweg.literature import beetstra_drag
from thalweg.rheology import FlowState, flow_state, mixed_fraction, mixed_friction, solid_stress

GRAINS, FLUID = "#c0392b", "#14496e"
CREEP_FIT = 2.0, 7.0          # diameters below the surface: where the decay of the creep is taken
SHEARED = 1e-3                # of sqrt(g/d): a layer with less shear has no flow rule to show
DILUTE = 0.02                 # solid fraction below which too few grains pass for a stress or a drag


@dataclass
class Bed:
    """Layers of a resolved run; height in diameters over the surface, velocities in m/s and stresses in Pa (xz) along
    `axis`, downstream."""
    axis: str                         # "x" or "-x"
    height: np.ndarray
    solid_fraction: np.ndarray
    grain_velocity: np.ndarray
    fluid_velocity: np.ndarray
    temperature: np.ndarray           # m^2/s^2
    solid_stress: np.ndarray
    fluid_stress: np.ndarray          # viscous, subgrid and Reynolds
    state: FlowState                  # of the grains, by layers
    drag_function: np.ndarray         # over Stokes' drag
    drag_reynolds_number: np.ndarray


def resolved_bed(run):
    """The layers of a run; RunFolderError where it has no stress balance."""
    if "stress_balance" not in run.profiles:
        raise RunFolderError(f"{run.folder / 'profiles.h5'}: it has no stresses by layers yet "
                             "(analysis.stress_balance in the case; written with every checkpoint).")
    layers = run.profiles["stress_balance"]
    z, phi, diameter = layers["z"], layers["solid_fraction"], run.diameter
    stress, fluid = solid_stress(layers), run.section("fluid")
    velocity = layers["grain_velocity"][:, 0]
    viscosity = float(fluid["density"]) * float(fluid["kinematic_viscosity"])
    state = flow_state(phi, stress, np.gradient(velocity, z), diameter, run.density_ratio * float(fluid["density"]),
                       viscosity)
    of_fluid = sum(component(layers, name, "xz") for name in ("viscous_stress", "subgrid_stress", "reynolds_stress"))
    of_water = layers["fluid_velocity"][:, 0]
    axis, way = ("-x", -1.0) if np.nansum((1.0 - phi) * of_water) < 0.0 else ("x", 1.0)
    return Bed(axis, (z - surface_by_solid_fraction(z, phi, diameter)) / diameter, phi, way * velocity, way * of_water,
               layers["granular_temperature"], way * stress[:, 0, 2], way * of_fluid, state, layers["drag_function"],
               layers["drag_reynolds_number"])


def decay_length(height, velocity):
    """Diameters in which the velocity of the grains falls by a factor e below the surface: from a straight line through
    its logarithm from 2 to 7 diameters deep, or as deep as the grains still move downhill. NaN with fewer than three
    layers."""
    deep = np.flatnonzero((height < -CREEP_FIT[0]) & (height > -CREEP_FIT[1]))[::-1]      # from the top down
    stopped = np.flatnonzero(~(velocity[deep] > 0.0))
    deep = deep[:stopped[0]] if len(stopped) else deep
    if len(deep) < 3:
        return np.nan
    return 1.0 / np.polyfit(height[deep], np.log(velocity[deep]), 1)[0]


def e_fold(height, velocity, before=""):
    """The decay length in words, with what stands before them; empty where it cannot be fitted."""
    length = decay_length(height, velocity)
    return f"{before}e-fold {length:.2f} d" if np.isfinite(length) else ""


def different_materials(run, column):
    """What two runs should share and do not, as text; empty if they are the same."""
    def values(of):
        return {"slope": of.section("gravity").get("slope"), "diameter of the grains": of.diameter,
                "density of the grains": of.density,
                "kinematic viscosity": of.section("fluid")["kinematic_viscosity"]}
    one, other = values(run), values(column)
    return ", ".join(
        f"{name} {one[name]} and {other[name]}"
        for name in one
        if not (one[name] == other[name] or np.isclose(float(one[name] or 0), float(other[name] or 0), rtol=1e-3))
    )


def draw_profiles(axes, bed, column):
    """Solid fraction, velocities and stresses over the height; the continuum dashed, where a column is given."""
    fraction, velocity, stress = axes
    fraction.plot(bed.solid_fraction, bed.height, "k-")
    velocity.plot(bed.fluid_velocity, bed.height, color=FLUID, label="fluid")
    velocity.plot(
        np.where(bed.solid_fraction > 1e-4, bed.grain_velocity, np.nan), bed.height, color=GRAINS, label="grains"
    )
    stress.plot(bed.solid_stress, bed.height, color=GRAINS, label="grains")
    stress.plot(bed.fluid_stress, bed.height, color=FLUID, label="fluid")
    if column is not None:
        of = column.profiles["continuum"]
        height = (of["z"] - surface_by_solid_fraction(of["z"], of["solid_fraction"], column.diameter)) / column.diameter
        fraction.plot(of["solid_fraction"], height, "k--")
        velocity.plot(of["fluid_velocity"][:, 0], height, "--", color=FLUID)
        velocity.plot(of["grain_velocity"][:, 0], height, "--", color=GRAINS)
        stress.plot(of["grain_shear_stress"], height, "--", color=GRAINS)
        stress.plot(of["fluid_shear_stress"], height, "--", color=FLUID)
    top = min(bed.height[-1], 6.0)
    fraction.set(xlabel="solid fraction [1]", ylim=(-4.0, top), ylabel="height over the bed surface [d]")
    velocity.set(
        xlabel=f"velocity along {bed.axis} [m/s]", ylim=(-4.0, top), xlim=(-0.02, 1.05 * np.interp(top, bed.height, bed.fluid_velocity))
    )
    stress.set(xlabel="shear stress [Pa]", ylim=(-4.0, top))
    velocity.legend(frameon=False, fontsize=8)
    stress.legend(frameon=False, fontsize=8)


def draw_flow_rule(friction, fraction, bed, diameter):
    """mu(I_m) and phi(I_m) of every sheared layer below the dilute top, coloured by height, and eqs. 20 and 21. Layers
    less than a diameter above the floor are left out."""
    state = bed.state
    shown = (
        (state.shear_rate > SHEARED * np.sqrt(9.81 / diameter))
        & (bed.solid_fraction > DILUTE)
        & np.isfinite(state.friction)
    )
    shown &= bed.height > bed.height[0] + 1.0
    mixed, order = state.mixed_number[shown], np.argsort(state.mixed_number[shown])
    if not len(mixed):
        return
    points = {"c": bed.height[shown], "cmap": "viridis", "s": 22}
    friction.scatter(mixed, state.friction[shown], label="layers of the run", **points)
    rule = mixed_friction(bed.solid_fraction[shown], state.viscous_number[shown], mixed)
    friction.plot(mixed[order], rule[order], "k-", lw=1.2, label="eq. 20")
    friction.set(xscale="log", xlabel="mixed inertial number $I_m$", ylabel=r"stress ratio $\mu$", ylim=(0, None))
    drawn = fraction.scatter(mixed, bed.solid_fraction[shown], label="layers of the run", **points)
    curve = np.logspace(np.log10(mixed.min()), np.log10(mixed.max()), 100)
    fraction.plot(curve, mixed_fraction(curve), "k-", lw=1.2, label="eq. 21")
    fraction.set(xscale="log", xlabel="mixed inertial number $I_m$", ylabel="solid fraction")
    fraction.figure.colorbar(drawn, ax=fraction, label="height [d]")
    for axes in (friction, fraction):
        axes.legend(frameon=False, fontsize=8)


def draw_creep(axes, bed, column):
    """The velocity of the grains below the surface; the continuum's creep has no scale and is drawn through the run's
    at 2 d."""
    moving = (bed.height < 1.0) & (bed.grain_velocity > 0.0)
    axes.semilogx(bed.grain_velocity[moving], bed.height[moving], color=GRAINS,
                  label="run" + e_fold(bed.height, bed.grain_velocity, ", "))
    if column is not None and "creep_velocity" in column.profiles["continuum"]:
        of = column.profiles["continuum"]
        height, creep = -of["creep_depth"] / column.diameter, of["creep_velocity"]
        at_two = np.exp(np.interp(-CREEP_FIT[0], bed.height[moving], np.log(bed.grain_velocity[moving])))
        order = np.argsort(height)
        creep = creep * at_two / np.interp(-CREEP_FIT[0], height[order], creep[order])
        shown = creep > 0.0
        axes.semilogx(
            creep[shown], height[shown], "k--", label="granular fluidity" + e_fold(height, creep, ", ")
        )
    slowest = np.min(bed.grain_velocity[moving & (bed.height > -10.0)], initial=np.inf)
    fastest = np.max(bed.grain_velocity[moving], initial=0.0)
    if slowest < fastest:
        axes.set_xlim(0.5 * slowest, 2.0 * fastest)
    axes.set(xlabel="velocity of the grains [m/s]", ylabel="height over the bed surface [d]", ylim=(-10.0, 1.0))
    axes.legend(frameon=False, fontsize=8)


def draw_drag(axes, bed):
    """Drag of the layers over Stokes', beside Beetstra's law at each layer's solid fraction and Reynolds number."""
    shown = (bed.solid_fraction > DILUTE) & (bed.drag_function > 0.0) & (bed.height > -2.0)
    phi, height = bed.solid_fraction[shown], bed.height[shown]
    axes.semilogx(bed.drag_function[shown], height, "o", ms=4, color=FLUID, label="layers of the run")
    axes.semilogx(
        beetstra_drag(phi, bed.drag_reynolds_number[shown]), height, "k-", lw=1.2, label="Beetstra et al. (2007)"
    )
    axes.xaxis.set_minor_formatter(LogFormatter(labelOnlyBase=False, minor_thresholds=(2.0, 0.5)))   # 30, not 3 x 10^1
    axes.set(xlabel="drag over Stokes' drag [1]", ylabel="height over the bed surface [d]")
    axes.legend(frameon=False, fontsize=8, ncol=2, loc="lower center", bbox_to_anchor=(0.5, 1.0))


def draw_temperature(axes, bed):
    shown = (bed.temperature > 0.0) & (bed.height > -4.0)
    axes.semilogx(bed.temperature[shown], bed.height[shown], color=GRAINS)
    axes.set(xlabel="granular temperature [m²/s²]", ylabel="height over the bed surface [d]")


def comparison_figure(run, column=None):
    """Eight panels: profiles, creep, flow rule, drag and granular temperature of a resolved bed, and a continuum column
    beside them, which has no granular temperature."""
    bed = resolved_bed(run)
    figure, axes = plt.subplots(2, 4, figsize=(15, 8), layout="constrained")
    draw_profiles(axes[0, :3], bed, column)
    draw_creep(axes[0, 3], bed, column)
    draw_flow_rule(axes[1, 0], axes[1, 1], bed, run.diameter)
    draw_drag(axes[1, 2], bed)
    draw_temperature(axes[1, 3], bed)
    for panel in axes.flat:
        panel.grid(**GRID)
    lines = "resolved" + (f"; dashed: {column.name}, two-phase continuum" if column is not None else "")
    name_above(figure, f"{run.name}, d = {1e3 * run.diameter:.3g} mm (lines: {lines})")
    return figure
