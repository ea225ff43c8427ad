"""Transport by size class: q* of each class against its size, and the gradings of bed, surface and load."""
import matplotlib.pyplot as plt
import numpy as np

from thalweg.drawing import name_above
from thalweg.height_profiles import GRID
from thalweg.sizes import sizes_of
from thalweg.units import units_of

BED, SURFACE, LOAD = "#7f6a4d", "#14496e", "#c0392b"


def draw_rates(axes, sizes, units):
    """q*_i over the class's share of the surface and of the bed, against d_i over the d50 of the bed. Without a fluid
    the rates."""
    place = sizes.diameter / sizes.bed_d50
    if sizes.q_star is None:
        axes.errorbar(place, sizes.q_s, np.nan_to_num(sizes.q_s_error), fmt="o", color=SURFACE, capsize=2)
        label = f"$q_{{si}}$ [{units.mathematical('m^2/s')}]"
        axes.set(xlabel="$d_i\\,/\\,d_{50}$ of the bed", ylabel=label, xscale="log")
        return
    drawn = 0
    for (rate, error), label, style in (
        (sizes.q_star_by_bed(), "by share of the bed $f_i$", {"mfc": "white", "color": BED}),
        ((sizes.q_star, sizes.q_star_error), "by share of the surface $F_i$", {"color": SURFACE}),
    ):
        rate = sizes.downstream * rate
        shown = np.isfinite(rate) & (rate > 0.0)
        above = np.nan_to_num(error)[shown]
        below = np.minimum(above, 0.99 * rate[shown])   # that the axis can show
        axes.errorbar(place[shown], rate[shown], np.array([below, above]), fmt="o-", lw=0.8, capsize=2, label=label, **style)
        drawn += shown.sum()
    axes.set(
        xlabel="$d_i\\,/\\,d_{50}$ of the bed", ylabel=r"$q^*_i = q_{si}\,/\,(F_i \sqrt{(s_i-1)\,g\,d_i^3})$",
        xscale="log",
    )
    if drawn:
        axes.set_yscale("log")
        axes.legend(fontsize=8, frameon=False)
    else:
        axes.text(0.5, 0.5, "no class moves downstream", ha="center", transform=axes.transAxes)


def draw_gradings(axes, sizes, units):
    for share, d50, colour, name in (
        (sizes.bed_share, sizes.bed_d50, BED, "bed"), (sizes.surface_share, sizes.surface_d50, SURFACE, "surface"),
        (sizes.load_share, sizes.load_d50, LOAD, "load"),
    ):
        if np.isfinite(share).all():
            axes.plot(units.per_length * sizes.edges, 100.0 * sizes.finer(share), "o-", ms=3, lw=1.2, color=colour,
                      label=f"{name}, $d_{{50}}$ {units.per_length * d50:.3g} {units.length}")
    axes.set(xlabel=f"$d$ [{units.length}]", ylabel="finer [%]", xscale="log")
    axes.set_title(f"armouring ratio {sizes.armouring_ratio:.3g}", fontsize=10)
    axes.legend(fontsize=8, frameon=False)


def figure_of(run):
    """The rates at the left, the gradings at the right."""
    sizes = sizes_of(run)
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.8), layout="constrained")
    draw_rates(left, sizes, units_of(run))
    draw_gradings(right, sizes, units_of(run))
    for axes in (left, right):
        axes.xaxis.set_major_formatter("{x:.3g}")
        axes.xaxis.set_minor_formatter("{x:.3g}")
        axes.tick_params(axis="x", which="minor", labelsize=7)
        axes.grid(**GRID)
        axes.spines[["top", "right"]].set_visible(False)
    name_above(figure, run.name)
    return figure
