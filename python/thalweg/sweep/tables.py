"""What a sweep has found, as CSV: runs.csv, and thresholds.csv of a bisection. Units stand in the heads."""
import csv
import io
import json
import re

from thalweg.sweep.plan import figure_of
from thalweg.sweep.runs import DONE, WAITING
from thalweg.sweep.tasks import result_columns
from thalweg.tables import replace_text


def write_tables(plan, tasks, units, folder):
    """units: of the keys of the case, by their paths. Returns the files."""
    # A bisection needs no more repetitions of a value once enough of them agree.
    runs = [run for task in tasks for run in task.runs if run.state != WAITING or not plan.bisections]
    files = [write(folder / "runs.csv", runs_table(plan, runs, units))]
    if plan.bisections:
        files.append(write(folder / "thresholds.csv", thresholds_table(plan, tasks, units)))
    return files


def runs_table(plan, runs, units):
    keys = list(dict.fromkeys(key for run in runs for key in run.settings))
    columns = result_columns(plan, runs)
    measured = {"simulated_time": "s", "until": "s"}
    for run in runs:
        measured |= (run.summary or {}).get("units", {})
    if plan.in_grain_units:
        measured = those_without_dimension(measured)
    head = (["run"] + [headed(key, units) for key in keys] + ["state", "warnings", "version", "wall_time [s]"] +
            [headed(column, measured, column.rpartition(".")[2]) for column in columns] + ["failure"])
    rows = [head]
    for run in sorted(runs, key=lambda run: [order(run.settings.get(key)) for key in keys]):
        figures = [figure_of(run.summary or {}, column) for column in columns]
        rows.append(
            [run.name]
            + [as_in_case(run.settings, key) for key in keys]
            + [run.state, warning_count(run), run.version, text(run.wall_seconds)]
            + [text(figure) for figure in figures]
            + [run.failure or ""]
        )
    return rows


def warning_count(run):
    return "" if run.state == WAITING else len(run.warnings)


def thresholds_table(plan, tasks, units):
    search, keys = plan.bisections[0], plan.keys
    unit = units.get(without_numbers(search.key), "")
    ending = f" [{unit}]" if unit else ""
    rows = [[headed(key, units) for key in keys] +
            [f"{search.key}{ending}", f"half_width{ending}", f"lower{ending}", f"upper{ending}", "state", "runs"]]
    for task in tasks:
        state, lower, upper, threshold = task.result()
        half = 0.5 * (upper - lower) if state == "found" else None
        rows.append([as_in_case(task.settings, key) for key in keys] +
                    [text(threshold), text(half), text(lower), text(upper), state,
                     sum(run.state == DONE for run in task.runs)])
    return rows


def those_without_dimension(units):
    """In grain units a length is in mean diameters and so on, which the names of the SI units would hide."""
    return {name: unit for name, unit in units.items() if unit == "1"}


def order(value):
    return (0, value, "") if isinstance(value, (int, float)) else (1, 0, str(value))


def text(value):
    return "" if value is None or value != value else f"{value:.9g}"


def as_in_case(settings, key):
    """A value as a case has it, not as Python writes it; empty where the key is not set."""
    value = settings.get(key, "")
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def headed(name, units, measured=None):
    unit = units.get(measured if measured is not None else without_numbers(name), "")
    return f"{name} [{unit}]" if unit else name


def without_numbers(key):
    return re.sub(r"\.\d+(?=\.|$)", "", key)


def units_of_keys(schema, system):
    """Units by key, without the numbers of list entries, from what `thalweg defaults --schema` prints."""
    units = {}

    def walk(node, path):
        if "unit" in node:
            units[".".join(path)] = node["unit"]
        for form in node.get("anyOf", []):   # of a section: its keys, or the value in place of it
            walk(form, path)
        for key, property_of_it in node.get("properties", {}).items():
            walk(property_of_it, [*path, key])
        if isinstance(node.get("items"), dict) and "properties" in node["items"]:
            walk(node["items"], path)

    for one in schema["allOf"]:
        if one["if"]["properties"]["system"]["const"] == system:
            walk(one["then"], [])
    return units


def write(path, rows):
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows(rows)
    path.parent.mkdir(parents=True, exist_ok=True)
    replace_text(path, stream.getvalue())
    return path
