"""The sections of the page about a run. Each is a text of HTML, empty where the run has nothing to say of it."""
import math
import shlex
from datetime import datetime

import numpy as np

from thalweg.errors import RunFolderError
from thalweg.figures import fluid_profiles, overview, reach, sizes, transport_rate
from thalweg.page import html
from thalweg.page.figures import series_figure
from thalweg.history import command_of, other_case_before, sessions_of, settings_in, warnings_of
from thalweg.sizes import Sizes
from thalweg.sizes import measured as measured_by_size
from thalweg.transport import sentence_of_column, state_of_column, transport
from thalweg.units import units_of

SYSTEMS = {
    "resolved": "resolved flow with grains", "fluid": "fluid alone", "grains": "dry grains",
    "model_fluid": "grains in a model fluid", "continuum": "two-phase continuum",
}
WORDS = {
    "bed_height": "height of the bed", "porosity": "porosity", "flow_depth": "flow above the bed",
    "hydraulic_radius": "hydraulic radius", "bed_stress": "stress on the bed", "shields_number": "Shields number",
}


def page_of(run):
    """The whole page."""
    sessions = sessions_of(run.folder)
    parts = [
        heading(run, sessions), findings(run), pictures(run), transport_section(run), size_section(run),
        reach_section(run), profiles(run), course(run), warning_section(sessions), budget(run), case_section(run, sessions), provenance(run, sessions),
        repetition(run, sessions), footer(run),
    ]
    return html.document(f"{run.name} - Thalweg", "\n".join(part for part in parts if part))


def number(value, digits=4):
    return "-" if value is None or (isinstance(value, float) and not math.isfinite(value)) else f"{value:.{digits}g}"


def last_time(run):
    """s; None before the first row of series.csv."""
    try:
        return float(run.series["time"][-1])
    except RunFolderError:
        return None


def heading(run, sessions):
    summary, time, second = run.summary, last_time(run), units_of(run).named("s")
    if summary is None:
        kind = "unfinished"
        place = "" if time is None else f", at {time:.4g} {second}"
        state = f"Not ended{place}: it is still running, has failed or was killed."
    elif summary["finished"]:
        kind, state = "finished", f"Finished at {number(summary['simulated_time'])} {second}."
    else:
        kind = "unfinished"
        state = (
            f"Not finished, {summary['reason']}: at {number(summary['simulated_time'])} of"
            f" {number(summary['until'])} {second}."
        )
    system = str(run.case.get("system", "resolved"))
    lead = SYSTEMS.get(system, system)
    if sessions and sessions[-1].shape:
        lead += ": " + sessions[-1].shape.partition(" on ")[2]
    return (
        f"<header><h1>{html.escape(run.name)}</h1>"
        + html.paragraph(lead, "lead")
        + html.paragraph(state, f"state {kind}")
        + "</header>"
    )


def findings(run):
    """The bed at the end."""
    bed = (run.summary or {}).get("bed") or {}
    units = (run.summary or {}).get("units") or {}
    rows = [
        (words, number(bed[name]), "" if units.get(name, "1") == "1" else units_of(run).named(units[name]))
        for name, words in WORDS.items()
        if name in bed
    ]
    return html.section("The bed at the end", html.table(rows, numbers=(1,))) if rows else ""


def attempt(draw, caption):
    """A picture, or the sentence that says why there is none."""
    try:
        return html.picture(draw(), caption)
    except RunFolderError as error:
        return html.paragraph(f"Left out: {error}")


def pictures(run):
    if run.case.get("system") == "continuum":
        return ""
    name, draw = overview.side_view_of(run)
    grains = "Side view of the grains, coloured by speed"
    caption = {
        "bed": (
            f"{grains}, in front of the flow in the middle plane, at the last time of which both are stored."
            if len(run.fluid)
            else f"{grains}, in the last stored frame."
        ),
        "flow": "Speed of the fluid in the middle plane, in the last stored frame.",
    }[name]
    return html.section("Picture", attempt(draw, caption))


def caption_of_rates(run):
    """What is drawn against time, q* or without a fluid q_s."""
    volume = "the volume of grains that passes per unit width and time"
    symbol = f"q* is {volume} over sqrt((s - 1) g d^3)" if "q_star" in run.series else f"q_s is {volume}"
    if run.system == "continuum":
        return f"Transport rate against time. {symbol}; the point: the state at the end."
    if transport_rate.mean_transport(run) is None:
        return f"Transport rate against time. {symbol}."
    return f"Transport rate against time. {symbol}; shaded: the time of the mean, with a band of one standard error."


def transport_section(run):
    try:
        series = run.series
    except RunFolderError:
        return ""
    if not {"q_star", "q_s"} & set(series):
        return ""
    parts = [attempt(lambda: transport_rate.figure_of(run), caption_of_rates(run))]
    if run.system == "continuum":
        return html.section("Transport", *parts, html.paragraph(sentence_of_column(state_of_column(run)) + "."))
    try:
        parts += [
            html.paragraph(sentence[:1].upper() + sentence[1:] + ".")
            if not sentence.startswith("q")
            else html.paragraph(sentence + ".")
            for sentence in transport(run).sentences()
        ]
    except RunFolderError as error:
        parts.append(html.paragraph(f"There is no mean: {error}"))
    return html.section("Transport", *parts)


def size_section(run):
    """Transport by size class."""
    if not measured_by_size(run):
        return ""
    caption = (
        "Left: q* of each class by its own size and its share of the surface (Wilcock and Crowe) or of the bed (Parker"
        " and Klingeman); right: gradings of bed, surface and load."
    )
    found = Sizes(run)
    return html.section(
        "Transport by size class", attempt(lambda: sizes.figure_of(run), caption),
        html.paragraph(found.sentence() + "."), html.table(found.rows(), found.headings, range(1, len(found.headings))),
    )


def reach_section(run):
    """Sediment along x."""
    if not reach.measured(run):
        return ""
    caption = (
        "Sediment along x. Above: level of the bed; middle: transport through the sections; below: their means over time,"
        " with a band of one standard error."
    )
    found, parts = (run.summary or {}).get("reach") or {}, []
    if found:
        text = f"The balance of the bins is out by {number(found['balance_residual'])} grains."
        if found["arrived_grains"] or found["left_grains"]:
            stay = found["residence_time_mean"]
            came = f"{found['arrived_grains']:.0f} grains came in and {found['left_grains']:.0f} left"
            if stay is not None:
                came += f"; the mean residence time of those that did both is {number(stay, 3)} {units_of(run).named('s')}"
            text = f"{came}. {text}"
        parts.append(html.paragraph(text))
    return html.section("Along the reach", attempt(lambda: reach.figure_of(run), caption), *parts)


def profiles(run):
    draw = overview.profiles_of(run)
    if draw is not None and run.system == "continuum":
        caption = "The column at the end: solid fraction, velocities and stresses over the height."
        return html.section("Profiles", attempt(draw, caption))
    if draw is None and fluid_profiles.measured(run):
        def draw():
            return fluid_profiles.figure_of(run)
    if draw is None:
        return ""
    caption = "Means over the height"
    balance = run.profiles.get("stress_balance")
    parts = [
        attempt(
            draw,
            (
                f"{caption}, from profiles.h5."
                if balance is None
                else (
                    f"{caption}, from profiles.h5; right: the balance of stresses, where the total (black) comes to the"
                    " driving stress in steady flow."
                )
            ),
        )
    ]
    return html.section(
        "Profiles", *parts, *([html.paragraph(balance_sentence(balance))] if balance is not None else [])
    )


def balance_sentence(balance):
    """How far the total is from the driving stress less what side walls take."""
    driving = balance["driving_stress"] - balance.get("side_wall_stress", 0.0)
    gap, largest = np.abs(balance["total_stress"] - driving), np.nanmax(np.abs(driving))
    if not np.isfinite(gap).any() or not largest > 0.0:
        return "The balance of stresses has not been measured yet."
    return (
        "Balance of stresses: the total differs from the driving"
        f" stress{' less side walls' if 'side_wall_stress' in balance else ''} by {np.nanmax(gap):.2g} Pa at most,"
        f" {100.0 * np.nanmax(gap) / largest:.2g} % of its largest value, and by {np.nanmean(gap):.2g} Pa on average"
        " over the height."
    )


def course(run):
    try:
        figure = series_figure(run)
    except RunFolderError as error:
        return html.section("Course of the run", html.paragraph(f"Left out: {error}"))
    return (
        html.section("Course of the run", html.picture(figure, "Some columns of series.csv against time."))
        if figure
        else ""
    )


def warning_section(sessions):
    warnings = warnings_of(sessions)
    if not sessions:
        return ""
    body = html.listing(warnings, "warning") if warnings else html.paragraph("The run gave none.")
    remarks = sessions[-1].remarks
    return html.section(
        "Warnings", body, *([html.paragraph("At the end: " + "; ".join(remarks) + ".")] if remarks else [])
    )


def budget(run):
    """Where the time of the last session went."""
    summary = run.summary or {}
    phases = summary.get("phases")
    if not phases:
        return ""
    largest = max(phase["share"] for phase in phases.values()) or 1.0
    rows = [
        (
            name, f"{phase['mean_seconds']:.2f}", f"{phase['largest_seconds']:.2f}", f"{100.0 * phase['share']:.1f} %",
            html.bar(phase["share"] / largest),
        )
        for name, phase in sorted(phases.items(), key=lambda item: -item[1]["share"])
        if phase["share"] >= 0.0005
    ]
    table = html.table(rows, ("phase", "mean [s]", "slowest rank [s]", "share", ""), (1, 2, 3)).replace(
        "<td><span class=\"bar\"", "<td class=wide><span class=\"bar\""
    )
    words = [f"{summary['steps_in_this_session']} steps in {summary['wall_seconds']:.4g} s on {summary['ranks']} "
             f"rank{'' if summary['ranks'] == 1 else 's'}: {summary['steps_per_second']:.4g} steps/s"]
    if summary.get("mlups"):
        words.append(f"{summary['mlups']:.3g} million cell updates/s")
    if summary.get("memory_bytes"):
        words.append(f"{summary['memory_bytes'] / 1e6:.0f} MB of memory on all ranks")
    return html.section("Where the time went", html.paragraph("Of the last session: " + ", ".join(words) + "."), table)


def case_section(run, sessions):
    parts = []
    settings = settings_in(command_of(run))
    if settings:
        parts += [
            html.paragraph("Set on the command line, in place of what the case file says:"), html.listing(settings),
        ]
    for session in sessions:
        if session.changes:
            parts += [html.paragraph(f"Changed when it continued from {session.origin}:"), html.listing(session.changes)]
    text = (run.folder / "case.yaml").read_text(encoding="utf-8-sig")
    return html.section("Case, as it was run", *parts, html.preformatted(text))


def provenance(run, sessions):
    summary = run.summary or {}
    rows = [("folder", str(run.folder.resolve())), ("command", command_of(run) or "not known")]
    version = summary.get("version") or (sessions[-1].version if sessions else "not known")
    rows.append(("version", version))
    others = [other for other in dict.fromkeys(session.version for session in sessions) if other != version]
    if others:
        rows.append(("versions before", ", ".join(others)))
    rows += facts(summary.get("provenance") or {})
    log = run.folder / "run.log"
    if log.exists():
        rows.append(
            ("last written", datetime.fromtimestamp(log.stat().st_mtime).astimezone().strftime("%Y-%m-%d %H:%M:%S %z"))
        )
    checkpoint = run.latest_checkpoint
    rows.append(("last checkpoint", checkpoint.name if checkpoint else "none"))
    if len(sessions) > 1:
        rows += [
            (
                f"session {n}",
                f"{session.shape}{f'; from {session.origin}' if session.origin else ''}"
                f"{f'; {session.outcome}' if session.outcome else ''}",
            )
            for n, session in enumerate(sessions, 1)
        ]
    return html.section("Provenance", html.table(rows))


def facts(found):
    """Rows of what summary.json says under `provenance`; older versions have none."""
    rows = [
        (name, found[key])
        for name, key in (
            ("last session began", "started"), ("host", "host"), ("processor", "processor"), ("compiler", "compiler"),
            ("compiler flags", "compiler_flags"), ("MPI", "mpi"), ("HDF5", "hdf5"),
        )
        if found.get(key)
    ]
    return rows + [
        (file["key"], f"{file['path']}, SHA-256 {file['sha256'] or 'not known'}") for file in found.get("inputs", ())
    ]


def repetition(run, sessions):
    summary, folder = run.summary or {}, shlex.quote(str(run.folder))
    ranks = summary.get("ranks", 1)
    start = f"mpirun -n {ranks} " if ranks > 1 else ""
    other = other_case_before(sessions)
    first = "the last case from its start" if other else "the same run once more"
    lines = [f"# {first}, in a new folder, from the case as it was run",
             f"{start}thalweg run {folder}/case.yaml --out NEW_FOLDER"]
    if not summary.get("finished"):
        lines += [
            "# this run, on from its last checkpoint",
            f"{start}thalweg run {folder}/case.yaml --out {folder} --resume",
        ]
    lines += ["# its figures and this page", f"thalweg plot all {folder}", f"thalweg report {folder}"]
    words = (
        "With the same version on the same kind of processor the state has the same bits, on any number of ranks. Beds"
        " and surfaces that the case names, with paths from its folder, are needed as well, and the run or checkpoint"
        " that it begins from: move them with the folder."
    )
    if other:
        words = (
            "The case was changed where the run went on, so that this is another run. To repeat this one, run each"
            " case_until_step_N.yaml of the folder to the time of its change, and go on with the next by --resume. "
        ) + words
    return html.section("How to repeat it", html.preformatted("\n".join(lines)), html.paragraph(words))


def footer(run):
    sources = [
        name
        for name in ("case.yaml", "run.log", "series.csv", "summary.json", "profiles.h5")
        if (run.folder / name).exists()
    ]
    return f"<footer>{html.paragraph('Made by thalweg report from ' + ', '.join(sources) + '.')}</footer>"
