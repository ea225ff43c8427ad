"""Means over the height of a run, from profiles.h5 (and, for the stress of the fluid on the grains, the frames), and
their figure, after fig. 7(a) of Zhang et al. (2022)."""
import matplotlib.pyplot as plt
import numpy as np

from thalweg.bed import bed_height, follows_from_slope, more_than_the_bed, surface_by_solid_fraction
from thalweg.drawing import name_above
from thalweg.errors import RunFolderError
from thalweg.layers import layer_profiles
from thalweg.units import units_of

GRID = {"color": "#e5e8ea", "linewidth": 0.8}


def component(group, name, which):
    return group[name][:, group.components[name].index(which)]


def has_grains(run):
    """Whether profiles.h5 has means of the grains."""
    return "grain_profiles" in run.profiles or "stress_balance" in run.profiles


def measured(run):
    """Whether those means are of anything: they begin at a time of their own (`from`)."""
    return bool(np.nansum(grain_means(run)[1]) > 0.0)


def observer_of_grains(run):
    """The analysis whose means of the grains count."""
    for name in ("grain_profiles", "stress_balance"):
        if name in run.profiles:
            return name
    raise RunFolderError(f"{run.folder / 'profiles.h5'}: it has no means of the grains yet "
                         "(analysis.grain_profiles in the case; written with every checkpoint).")


def grain_means(run):
    """Height (m), solid fraction and velocity (m/s) of the grains along x."""
    name = observer_of_grains(run)
    group = run.profiles[name]
    velocity = group["velocity" if name == "grain_profiles" else "grain_velocity"]
    return group["z"], group["solid_fraction"], velocity[:, 0]


def observer_of_fluid(run):
    """The analysis whose means of the fluid count, and its name of the velocity; None where it was not measured."""
    for name, velocity in (("fluid_statistics", "velocity"), ("stress_balance", "fluid_velocity")):
        if name in run.profiles and velocity in run.profiles[name]:
            return name, velocity
    return None


def fluid_velocity(run):
    """Height (m) and mean velocity (m/s) of the fluid along x; None where it was not measured."""
    found = observer_of_fluid(run)
    return found and (run.profiles[found[0]]["z"], run.profiles[found[0]][found[1]][:, 0])


def begins(run):
    """What stands behind the names of means of grains and of fluid: from when on they are, where that differs."""
    fluid = observer_of_fluid(run)
    times = [run.averaged_from(name) for name in (observer_of_grains(run), *(fluid or ())[:1])]
    if len(set(times)) == 1:
        return "", ""
    return tuple(f", from {time:.4g} {units_of(run).named('s')} on" for time in times)


def driving_stress(run, z, fraction):
    """Pa at the middles z (m) of the layers: g_x times the mass of grains, and of water where there is some, above."""
    water = run.case["fluid"]["density"] if run.case.get("fluid") else 0.0
    density = water * (1.0 - fraction) + run.density * fraction
    weight = density * run.gravity[0] * (z[1] - z[0])
    return np.cumsum(weight[::-1])[::-1] - 0.5 * weight


def balanced_stresses(balance):
    """(label, z in m, Pa) of the stresses that make up the balance of momentum along x."""
    xz = {name: component(balance, name, "xz") for name in balance.components if "xz" in balance.components[name]}
    found = [("solid: contacts and motion", xz["contact_stress"] + xz["kinetic_stress"]),
             ("fluid on grains", xz["grain_fluid_stress"]),
             ("fluid: viscous and subgrid", xz["viscous_stress"] + xz["subgrid_stress"]),
             ("fluid: resolved eddies", xz["reynolds_stress"]),
             ("rotation stress", balance["rotation_stress"]),
             ("total", balance["total_stress"]),
             ("driving", balance["driving_stress"])]
    if np.any(xz.get("lubrication_stress", 0.0)):
        found.insert(1, ("lubrication correction", xz["lubrication_stress"]))
    sides = balance.get("side_wall_stress")
    if sides is not None and np.any(sides):
        found += [("driving less side walls", balance["driving_stress"] - sides)]
    return [(label, balance["z"], values) for label, values in found]


def stresses(run):
    """(label, z in m, Pa) of every shear stress that was measured."""
    if "stress_balance" in run.profiles:
        return balanced_stresses(run.profiles["stress_balance"])
    grains = run.profiles["grain_profiles"]
    z, fraction = grains["z"], grains["solid_fraction"]
    solid = component(grains, "contact_stress", "xz") + component(grains, "kinetic_stress", "xz")
    found = [("solid: contacts and motion", z, solid)]
    # Side walls and obstacles would take a share, and of several densities the profiles have no mean by layers.
    alone = follows_from_slope(run, run.averaged_from("grain_profiles")) and not run.side_walls
    if alone and run.has_one_density:
        driving = driving_stress(run, z, fraction)
        found.append(("driving", z, driving))
        if run.case.get("fluid"):
            found.append(("fluid: remainder of the driving stress", z, driving - solid))
    if "fluid_statistics" in run.profiles:
        fluid = run.profiles["fluid_statistics"]
        share = 1.0 - np.interp(fluid["z"], z, fraction)
        reynolds = -run.section("fluid")["density"] * share * component(fluid, "reynolds_stress", "xz")
        found.append((f"fluid: resolved eddies{begins(run)[1]}", fluid["z"], reynolds))
    if len(run.grains) and "fluid_stress" in run.grains[-1].arrays and run.grains[-1].time > 0.0:
        frames = layer_profiles(run, start=run.averaged_from("grain_profiles"))
        found.append(("rotation stress", frames["z"], frames["rotation_stress"]))
    return found


def weight_of_water(run):
    """Heights (m) and rho g sin(alpha) (z_top - z) in Pa: what the driving stress is where there are no grains above.
    None where the slope is not all that drives the flow, or a restart changed it within the means."""
    known = run.driven_by_slope and run.driven_alike_since <= run.averaged_from(observer_of_grains(run))
    if not known or not run.case.get("fluid"):
        return None
    z = np.array([0.0, run.size[2]])
    return z, run.section("fluid")["density"] * run.gravity[0] * (run.size[2] - z)


def style_of(label):
    """How the line of a stress is drawn: the sums black and dashed, so that one lies visibly on the other in steady
    flow."""
    return {"total": {"color": "k", "lw": 2.2}, "driving": {"color": "#c0392b", "ls": "--", "lw": 1.5},
            "driving less side walls": {"color": "#e08e79", "ls": "--", "lw": 1.5}}.get(label, {"lw": 1.3})


def draw_velocities(axes, run, scaled):
    """Of grains and fluid, on a logarithmic scale, which shows the creep inside the bed as well."""
    z, fraction, velocity = grain_means(run)
    fluid, (grains_from, fluid_from) = fluid_velocity(run), begins(run)
    to_the_left = np.nansum(fraction * velocity if fluid is None else fluid[1]) < 0.0

    def on_the_way(values):
        downstream = -values if to_the_left else values
        return np.where(downstream > 0, downstream, np.nan)

    curves = [(f"grains{grains_from}", "#c0392b", z, on_the_way(np.where(fraction > 0, velocity, 0.0)))]
    if fluid is not None:
        curves.append((f"fluid{fluid_from}", "#14496e", fluid[0], on_the_way(fluid[1])))
    curves = [curve for curve in curves if np.isfinite(curve[3]).any()]
    for label, colour, height, values in curves:
        axes.plot(values, scaled(height), color=colour, label=label)
    if curves:
        shown = np.concatenate([values for *_, values in curves])
        axes.set_xscale("log")
        axes.set_xlim(0.5 * max(np.nanmin(shown), 1e-5 * np.nanmax(shown)), 2.0 * np.nanmax(shown))
        axes.legend(fontsize=8, frameon=False, ncol=2, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    axes.set(xlabel=f"mean velocity along {'-x' if to_the_left else 'x'} [{units_of(run).mathematical('m/s')}]")


def draw_stresses(axes, run, scaled):
    for label, height, values in stresses(run):
        axes.plot(values, scaled(height), label=label, **style_of(label))
    water = weight_of_water(run)
    if water is not None:
        axes.plot(
            water[1], scaled(water[0]), color="0.45", ls=":", lw=1.5, label=r"$\rho\, g \sin\alpha\, (z_{top} - z)$"
        )
    axes.set(xlabel=f"shear stress [{units_of(run).mathematical('Pa')}]")


def surface_or_floor(run, z, fraction):
    """Height (m) from which heights count, and its name: the surface of the bed, or the floor where there is none,
    because the grains reach the top, or up to less than a diameter below it, as in a shear cell."""
    try:
        surface = (
            bed_height(run, run.averaged_from(observer_of_grains(run)))
            if more_than_the_bed(run)
            else surface_by_solid_fraction(z, fraction, run.diameter)
        )
    except RunFolderError:
        return 0.0, "floor"
    return (surface, "bed surface") if run.size[2] - surface >= run.diameter else (0.0, "floor")


def figure_of(run):
    """Solid fraction, velocities and shear stresses; heights in diameters from the surface by solid fraction, or from the
    floor."""
    z, fraction, _ = grain_means(run)
    surface, above = surface_or_floor(run, z, fraction)
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12.5, 4.6), sharey=True, layout="constrained",
                                                 width_ratios=(0.8, 1, 1.2))

    def scaled(height):
        return (height - surface) / run.diameter

    left.plot(fraction, scaled(z), "k-")
    left.set(xlabel="solid fraction [1]", ylabel=f"height above the {above} [d]", xlim=(0, None),
             ylim=(scaled(0.0), scaled(run.size[2])))
    draw_velocities(middle, run, scaled)
    draw_stresses(right, run, scaled)
    for axes in (left, middle, right):
        axes.axhline(0.0, color="0.6", lw=0.8)
        axes.grid(**GRID)
    right.legend(fontsize=8, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    units = units_of(run)
    name_above(figure, f"{run.name}, d = {units.per_length * run.diameter:.3g} {units.length}")
    return figure
