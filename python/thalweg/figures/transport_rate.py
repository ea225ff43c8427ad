"""The transport rate against time: every measurement, the averaging window, and the mean with its error that run.log
has; of a continuum its last value instead."""
import matplotlib.pyplot as plt
import numpy as np

from thalweg import transport
from thalweg.drawing import name_above
from thalweg.errors import RunFolderError
from thalweg.means import running_mean
from thalweg.units import units_of

RATE_COLOUR, SMOOTH_COLOUR, MEAN_COLOUR = "#9bbfd6", "#14496e", "#c0392b"
LETTERS_A_LINE = 72   # of the legend; more of them stand one below the other
LEAST_SHARE = 0.35   # of the axis that the rates in the averaging window fill; below, a second panel enlarges them


def mean_transport(run):
    """The mean that run.log has, or None before the first measurement that counts, and for a continuum, which has
    none."""
    if run.system == "continuum":
        return None
    try:
        return transport.transport(run)
    except RunFolderError:
        return None


def draw_rates(axes, time, rate, found, units):
    """The measured rates and their running mean over a tenth of the time; behind them the averaging window, with the
    mean in a band of one standard error on either side."""
    second = units.named("s")
    axes.plot(time, rate, color=RATE_COLOUR, linewidth=0.9, zorder=3, label="measured")
    if len(time) > 100:
        window = 0.1 * (time[-1] - time[0])
        axes.plot(time, running_mean(time, rate, window), color=SMOOTH_COLOUR, linewidth=1.6, zorder=4,
                  label=f"running mean over {window:.2g} {second}")
    if found is not None:
        axes.axvspan(found.start, found.stop, color="0.94", lw=0, zorder=0)
        mean, error = found.rate.mean, found.rate.error
        if np.isfinite(error):
            axes.fill_between(
                (found.start, found.stop), mean - error, mean + error, color=MEAN_COLOUR, alpha=0.2, lw=0, zorder=1
            )
        known = f" \u00b1 {error:.2g}" if np.isfinite(error) else ""
        axes.hlines(
            mean, found.start, found.stop, color=MEAN_COLOUR, linewidth=1.4, zorder=5,
            label=f"mean from {found.start:.4g} to {found.stop:.4g} {second}: {mean:.4g}{known}"
            f"{units.mathematical(found.unit)}",
        )
    axes.spines[["top", "right"]].set_visible(False)


def draw_column(axes, time, rate):
    """The rate of a column of two continua, and its last value."""
    axes.plot(time, rate, color=SMOOTH_COLOUR, linewidth=1.6, zorder=3, label="column")
    axes.plot(time[-1], rate[-1], "o", color=MEAN_COLOUR, clip_on=False, zorder=5,
              label=f"at {time[-1]:.4g} s: {rate[-1]:.4g}")
    axes.spines[["top", "right"]].set_visible(False)


def padded(values):
    """Axis limits that show all of the values, and nought."""
    low, high = min(0.0, float(np.min(values))), max(0.0, float(np.max(values)))
    span = (high - low) or 1.0
    return low - (0.05 * span if low < 0.0 else 0.0), high + 0.05 * span


def figure_of(run):
    """All measured q* against time with their running mean, and the mean with its error that run.log has over its time;
    where a start carries so much that this hardly shows, once more below, enlarged. Of a continuum q* and its last
    value."""
    series, units = run.series, units_of(run)
    name, label = "q_star", r"$q^* = q_s\,/\sqrt{(s-1)\,g\,d^3}$"
    if name not in series:
        name, label = "q_s", f"$q_s$ [{units.mathematical('m^2/s')}]"
    if name not in series:
        raise RunFolderError(f"{run.folder / 'series.csv'}: it has no column q_star "
                                     "(analysis.transport_rate in the case).")
    known = np.isfinite(series[name])
    time, rate = series["time"][known], series[name][known]
    if not len(time):
        raise RunFolderError(f"{run.folder / 'series.csv'}: it has no measurement of the transport rate yet.")
    found = mean_transport(run)
    inside = rate[(time >= found.start) & (time <= found.stop)] if found is not None else rate
    enlarged = np.ptp(padded(inside)) < LEAST_SHARE * np.ptp(padded(rate))
    figure, panels = plt.subplots(2 if enlarged else 1, 1, figsize=(6.4, 5.4 if enlarged else 3.6), squeeze=False,
                                  constrained_layout=True)
    for axes, shown in zip(panels[:, 0], (rate, inside)):
        if run.system == "continuum":
            draw_column(axes, time, rate)
        else:
            draw_rates(axes, time, rate, found, units)
        axes.set(ylabel=label, ylim=padded(shown))
    end = time[-1] if time[-1] > time[0] else time[0] + 1.0
    panels[0, 0].set(xlim=(time[0], end))
    if enlarged:
        panels[1, 0].set(xlim=(found.start, max(found.stop, found.start + 1e-3 * end)))
        panels[1, 0].set_title("the averaging window, enlarged", fontsize=10)
    panels[-1, 0].set_xlabel(f"time $t$ [{units.named('s')}]")
    letters = sum(len(label) for label in panels[0, 0].get_legend_handles_labels()[1])
    panels[0, 0].legend(
        frameon=False, fontsize=9, ncol=3 if letters <= LETTERS_A_LINE else 1, loc="lower center",
        bbox_to_anchor=(0.5, 1.0), columnspacing=1.2, handlelength=1.6,
    )
    name_above(figure, run.name)
    figure.align_ylabels()
    return figure
