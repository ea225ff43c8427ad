"""What a run says of its sediment: transport, surface, Shields number and profiles between two times, from stored
output.

What a run folder does not hold is left out, with the reason. Averages that the run gathered itself (profiles.h5,
summary.json) are better where they cover the time wanted; this is for other times, and for runs without those
observers.
"""
import csv
import json
import math

import numpy as np

from thalweg import bed, sizes, water
from thalweg.errors import RunFolderError
from thalweg.layers import layer_profiles
from thalweg.means import mean_with_error
from thalweg.transport import column_of, sentence_of_column, state_of_column, symbol_and_units, transport
from thalweg.units import units_of
from thalweg.visible_profiles import visible_profiles

TABLES = "layers", "visible_grains"   # names of profiles
VISIBLE_FRAMES = 20   # the most that are looked at pixel by pixel


class Report:
    """Findings by name as text lines and as numbers, and profiles as columns."""

    def __init__(self, run, start=None, stop=None):
        """start, stop: the times (s) that are wanted, None: those of the run's own means (see window())."""
        self.run, self.wanted = run, (start, stop)
        self.start, self.stop = window(run, start, stop)
        self.lines, self.numbers, self.profiles = [], {"from": self.start, "until": self.stop}, {}

    def say(self, name, text):
        self.lines.append(f"{name:<11}{text}")

    def attempt(self, name, part):
        """part(), or the reason why there is none."""
        try:
            part()
        except RunFolderError as error:
            self.say(name, f"left out: {error}")

    def write(self, folder):
        """summary.json with the numbers (SI units, or grain units where the case has them) and a table for each
        profile; one of other times is removed where there is no new one. Returns the files."""
        folder.mkdir(parents=True, exist_ok=True)
        files = [folder / "summary.json"]
        files[0].write_text(json.dumps(without_nan(self.numbers), indent=2, allow_nan=False) + "\n", encoding="utf-8")
        for name, columns in self.profiles.items():
            files.append(folder / f"{name}.csv")
            write_columns(files[-1], columns, units_of(self.run))
        for name in set(TABLES) - set(self.profiles):
            (folder / f"{name}.csv").unlink(missing_ok=True)
        return files


def without_nan(value):
    """JSON has no word for what is not finite: None in its place, as in the summary of a run."""
    if isinstance(value, dict):
        return {name: without_nan(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def write_columns(path, columns, units):
    """A table of columns over z, with a column for each component, headed by the names of units."""
    headings, values = [], []
    for name, array in columns.items():
        flat = array.reshape(len(array), -1)
        parts = {1: [""], 2: ["_x", "_z"], 3: ["_x", "_y", "_z"],
                 9: ["_" + a + b for a in "xyz" for b in "xyz"]}[flat.shape[1]]
        headings += [f"{name}{part} [{units.named(columns.units[name])}]" for part in parts]
        values.append(flat)
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headings)
        writer.writerows([f"{value:.9g}" for value in row] for row in np.hstack(values))


def window(run, start=None, stop=None):
    """Times (s) to average over, within those of series.csv: from the begin of the run's means of transport, or, where
    it has none, the middle of the time until then, to its end."""
    times, second = run.series["time"], units_of(run).named("s")
    stop = float(times[-1]) if stop is None else stop
    if start is None:
        has_means = "transport_rate" in (run.case.get("analysis") or {})
        start = run.averaged_from("transport_rate") if has_means else 0.5 * min(stop, float(times[-1]))
    if not start < stop or start >= times[-1] or stop <= times[0]:
        raise RunFolderError(
            f"{run.folder}: there is nothing to average from {start:g} to {stop:g} {second}: the run has rows from "
            f"{times[0]:g} to {times[-1]:g} {second}. Give other times."
        )
    return max(start, float(times[0])), min(stop, float(times[-1]))


def end_of(run):
    """Time (s) that the run has come to, which may be after the last row of series.csv."""
    return max(float(run.series["time"][-1]), float((run.summary or {}).get("simulated_time") or 0.0))


def plain(number, digits):
    """A number with so many significant digits and, up to a million, without an exponent: 100, not 1e+02."""
    return f"{float(f'{number:.{digits}g}'):g}"


def describe_transport(report):
    found = transport(report.run, *report.wanted)
    mean, verdict = found.rate, found.verdict
    report.numbers[column_of(report.run)] = mean._asdict() | {
        "error_holds": mean.error_holds, "steady": verdict.steady, "trend": verdict.trend, "drift": verdict.drift,
        "drift_error": verdict.error, "measurements": found.measurements}
    for sentence in found.sentences():
        report.say("transport", sentence)
    if found.moving is not None:
        moving, error = found.moving
        report.numbers["moving_grains"] = {"mean": moving, "error": error}
        known = f" +- {plain(error, 2)}" if math.isfinite(error) else ""
        report.say("moving", f"{plain(moving, 4)}{known} grains faster than the threshold")


def times_of_means(run, observer):
    """Begin and end (s) of the means that a run has gathered itself, whatever times are asked for; the end is that of
    the last checkpoint, None while the run is going."""
    return {"from": run.averaged_from(observer), "until": (run.summary or {}).get("simulated_time")}


def in_words(times, second):
    """Begin and end of means. second: the name of the unit."""
    if times["until"] is None:
        return f"from {times['from']:g} {second} on"
    return f"from {times['from']:g} to {times['until']:g} {second}"


def describe_sizes(report):
    found = sizes.sizes_of(report.run)
    times = times_of_means(report.run, "fractional_transport")
    report.numbers["fractional_transport"] = times | found.numbers()
    report.say("sizes", f"{found.sentence()}; means of the run {in_words(times, units_of(report.run).named('s'))}")


def describe_reach(report):
    found = (report.run.summary or {}).get("reach")
    if found is None:
        raise RunFolderError("the means along x are in summary.json, which the run writes at its end.")
    times = times_of_means(report.run, "reach")
    report.numbers["reach"] = times | found
    name, units = column_of(report.run), units_of(report.run)
    label, unit, second = symbol_and_units(report.run, name)
    mean, error = found[f"{name}_mean"], found[f"{name}_error"]
    if mean is None:
        raise RunFolderError("nothing was measured before the end of the run.")
    known = "" if error is None else f" +- {error:.2g}"
    few = "" if found.get("q_s_error_holds", 1.0) else " (too few records, the error is larger)"
    report.say(
        "reach",
        f"{label} = {mean:.4g}{known}{unit}, mean of all sections and of the run {in_words(times, second)}{few}",
    )
    trend = found["bed_level_trend"]
    if trend is not None:
        way = "falling" if trend < 0.0 else "rising"
        error = found.get("bed_level_trend_error")
        known = "" if error is None else f" +- {error:.2g}"
        report.say(
            "reach", f"bed at {found['bed_level_mean']:.4g} {units.named('m')},"
            f" {way} by {abs(trend):.2g}{known} {units.named('m/s')}"
        )
    if found["arrived_grains"] or found["left_grains"]:
        stay = found["residence_time_mean"]
        report.say("reach", f"{found['arrived_grains']:g} grains came in, {found['left_grains']:g} left"
                   + ("" if stay is None else f"; those that did both stayed for {stay:.3g} {second}"))


def describe_surface(report, name, title, surface):
    run = report.run
    depth = float(run.size[2] - surface)
    report.numbers[name] = {"bed_height": surface, "depth": depth}
    place = f"at {surface:.4g} m ({surface / run.diameter:.3g} d), {depth:.4g} m of water above"
    how = "by the forces on the water, as measured"
    if bed.follows_from_slope(run, report.start):
        how = f"by {'hydraulic radius' if run.side_walls else 'depth'} at slope {run.slope:.4g}"
        share = bed.share_of_gravity(run, report.start, report.stop)
        if share < 1.0:
            how += f", with {100.0 * share:.3g} % of gravity on average during its ramp"
    try:
        shields = float(
            bed.shields_number(run, surface, report.start, report.stop, name == "surface_by_solid_fraction")
        )
    except RunFolderError as error:
        report.say(title, f"{place}; Shields number left out: {error}")
        return
    report.numbers[name]["shields"] = shields
    report.say(title, f"{place}: Shields number {shields:.4g} {how}")


def describe_profiles(report):
    part = report.run, report.start, report.stop, 0.25 * report.run.diameter
    profiles = layer_profiles(*part)
    report.profiles["layers"] = profiles
    if report.run.case.get("fluid"):
        profiles = layer_profiles(*part, bed_only=True) if bed.any_float(report.run) else profiles
        surface = bed.surface_by_solid_fraction(profiles["z"], profiles["solid_fraction"], report.run.diameter)
        describe_surface(report, "surface_by_solid_fraction", "surface", surface)
        report.attempt("water", lambda: describe_water(report, surface))


def describe_water(report, surface):
    """Between side walls transport follows the speed of the water steeply, so a run says whether it has the right
    one."""
    run, expected = report.run, water.expected_speeds(report.run)
    if expected is None:
        return
    above = surface + water.FAR * run.size[1]
    speeds, times = water.measured_speeds(run, above), times_of_means(run, "fluid_statistics")
    report.numbers["water"] = times | {"above": above, "mean_speed": speeds.mean, "middle_speed": speeds.middle,
                                       "law_of_the_wall": expected._asdict()}
    mean, middle = (f"{value:.4g} m/s ({100 * (value / right - 1):+.1f} %" for value, right in zip(speeds, expected))
    report.say(
        "water",
        f"above {above:.4g} m, {in_words(times, 's')}: {mean} from the law of the wall at the side walls), "
        f"half-way between them {middle})",
    )


def describe_camera(report):
    run = report.run
    if run.side_walls < 2:
        return
    static = bed.static_bed_height(run, report.start, report.stop)
    describe_surface(report, "surface_by_static_pixels", "static", static)
    report.profiles["visible_grains"] = visible_profiles(run, report.start, report.stop, most_frames=VISIBLE_FRAMES)


def describe_column(report):
    """Of a column of two continua, its state at the end of the time wanted."""
    state = state_of_column(report.run, report.stop)
    report.numbers = {"from": state["time"], "until": state["time"], "continuum": state}
    report.say("transport", sentence_of_column(state))
    report.say("surface", f"at {state['surface_height']:.4g} m, {1e3 * state['moving_depth']:.3g} mm of grains in "
               f"motion: Shields number {state['shields_number']:.4g}")


def describe_flow(report):
    """Of a fluid without grains."""
    series = report.run.series
    if "mean_velocity_x" not in series:
        raise RunFolderError(f"{report.run.folder / 'series.csv'}: it has no column mean_velocity_x.")
    speeds = series["mean_velocity_x"][bed.rows_between(report.run, report.start, report.stop)]
    mean = mean_with_error(speeds)
    report.numbers["mean_velocity_x"] = mean._asdict()
    known = f" +- {mean.error:.2g}" if math.isfinite(mean.error) else ""
    few = "" if mean.error_holds else " (too few values, the error is larger)"
    report.say("flow", f"mean velocity {mean.mean:.4g}{known} m/s along x{few}")
    report.attempt("water", lambda: describe_water(report, 0.0))


def describe_sediment(report):
    run = report.run
    report.attempt("transport", lambda: describe_transport(report))
    if "fractional_transport" in (run.case.get("analysis") or {}):
        report.attempt("sizes", lambda: describe_sizes(report))
    if "reach" in (run.case.get("analysis") or {}):
        report.attempt("reach", lambda: describe_reach(report))
    report.attempt("surface", lambda: describe_profiles(report))
    if run.case.get("fluid"):
        report.attempt("static", lambda: describe_camera(report))


def report_of(run, start=None, stop=None):
    """Report of a run between two times (s); see window() for what counts where none are given."""
    report = Report(run, start, stop)
    times = f"{report.stop:g}" if run.system == "continuum" else f"{report.start:g} to {report.stop:g}"
    second = units_of(run).named("s")
    report.say("run", f"{run.name}: {times} {second} of {end_of(run):g} {second}")
    if (start is not None and start < report.start) or (stop is not None and stop > report.stop):
        report.say("window", "shorter than wanted: series.csv has no rows of the rest")
    if run.system == "continuum":
        report.attempt("transport", lambda: describe_column(report))
    elif run.system == "fluid":
        report.attempt("flow", lambda: describe_flow(report))
    else:
        describe_sediment(report)
    return report
