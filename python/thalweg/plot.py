"""The command `thalweg plot KIND RUN...`."""
import importlib
import math
import sys
from pathlib import Path

from thalweg.errors import RunFolderError
from thalweg.run import Run


def module(name):
    """A module that draws, loaded when it is needed: matplotlib, and for scenes VTK, are not needed by other
    commands."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as missing:
        package = {"vtkmodules": "vtk", "PIL": "Pillow"}.get((missing.name or "").partition(".")[0], missing.name)
        raise RunFolderError(f"this figure needs the Python package {package}; install it, or set THALWEG_PYTHON to an "
                             "interpreter that has it.") from None


def saved(figure, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=150)
    module("matplotlib.pyplot").close(figure)
    return path


def refuse_suffix(path):
    """Names of figures end as one of the formats that can be drawn."""
    formats = module("matplotlib.backend_bases").FigureCanvasBase.get_supported_filetypes()
    if path.suffix[1:].lower() not in formats:
        raise RunFolderError(f"--out {path}: a figure ends in .{', .'.join(sorted(formats))}.")


def refuse_one_name(wanted):
    """The figures of several runs would have the same name."""
    if wanted.out and len(wanted.runs) > 1:
        raise RunFolderError(
            f"--out {wanted.out}: each of {len(wanted.runs)} runs has a figure of its own; give one run, or leave out"
            " --out to write them to the folders of the runs."
        )


def draw_of_each_run(wanted, figure_of):
    """figure_of(run): name and function of its figure, which goes to --out or into the folder of the run."""
    refuse_one_name(wanted)
    if wanted.out:
        refuse_suffix(wanted.out)
    for folder in wanted.runs:
        name, draw = figure_of(Run(folder))
        yield saved(draw(), wanted.out or folder / f"{name}.png")


def time_of(wanted):
    if wanted.time is not None and not math.isfinite(wanted.time):
        raise RunFolderError(f"--time {wanted.time}: give a time in s.")
    return wanted.time


def draw_all(wanted):
    overview, time = module("thalweg.figures.overview"), time_of(wanted)
    refuse_one_name(wanted)
    for folder in wanted.runs:
        figures = overview.figures_of(Run(folder), time)
        missing = []
        for name, draw in figures:
            try:
                yield saved(draw(), (wanted.out or folder) / f"{name}.png")
            except RunFolderError as error:
                missing.append(error)
        if missing and len(missing) == len(figures):
            raise missing[0]
        for error in missing:
            print(f"thalweg: left out: {error}", file=sys.stderr)


def draw_side_view(wanted):
    overview, time = module("thalweg.figures.overview"), time_of(wanted)
    return draw_of_each_run(wanted, lambda run: overview.side_view_of(run, time))


def draw_transport_rate(wanted):
    rate = module("thalweg.figures.transport_rate")
    return draw_of_each_run(wanted, lambda run: ("transport_rate", lambda: rate.figure_of(run)))


def draw_profiles(wanted):
    overview = module("thalweg.figures.overview")

    def figure_of(run):
        draw = overview.profiles_of(run)
        if draw is None and run.system == "continuum":
            raise RunFolderError(
                f"{run.folder / 'profiles.h5'}: there are no profiles of the column yet; the run writes them at its end."
            )
        if draw is None:
            raise RunFolderError(
                f"{run.folder / 'profiles.h5'}: it has no means of grains or fluid yet (analysis.grain_profiles, "
                "stress_balance or fluid_statistics in the case; written with every checkpoint)."
            )
        return "profiles", draw
    return draw_of_each_run(wanted, figure_of)


def draw_sizes(wanted):
    by_size = module("thalweg.figures.sizes")
    return draw_of_each_run(wanted, lambda run: ("sizes", lambda: by_size.figure_of(run)))


def draw_reach(wanted):
    reach = module("thalweg.figures.reach")
    return draw_of_each_run(wanted, lambda run: ("reach", lambda: reach.figure_of(run)))


def draw_relation(wanted):
    refuse_suffix(wanted.out)
    yield saved(
        module("thalweg.figures.relation").draw(wanted.runs, wanted.start, wanted.stop, wanted.surface, wanted.table),
        wanted.out,
    )


def draw_visible(wanted):
    refuse_suffix(wanted.out)
    start, stop = -math.inf if wanted.start is None else wanted.start, math.inf if wanted.stop is None else wanted.stop
    if wanted.frames < 1:
        raise RunFolderError(f"--frames {wanted.frames}: give at least one.")
    visible = module("thalweg.figures.visible")
    yield saved(visible.figure_of([Run(folder) for folder in wanted.runs], start, stop, wanted.frames), wanted.out)


def draw_two_phases(wanted):
    refuse_suffix(wanted.out)
    yield saved(module("thalweg.figures.two_phases").draw(wanted.run, wanted.continuum), wanted.out)


def draw_film(wanted):
    film, run = module("thalweg.film"), Run(wanted.run)
    module("thalweg.figures")
    start, stop = -math.inf if wanted.start is None else wanted.start, math.inf if wanted.stop is None else wanted.stop
    path = wanted.out or wanted.run / "film.gif"
    film.write_film(run, film.chosen_frames(run, start, stop, wanted.every), path, wanted.rate, wanted.width)
    yield path


def draw_picture(wanted):
    run, path = Run(wanted.run), wanted.out or wanted.run / "picture.png"
    module("thalweg.figures.scene").draw(run, path, time_of(wanted), wanted.direction, wanted.size)
    yield path


def add_window(parser):
    parser.add_argument("--from", dest="start", type=float, metavar="SECONDS", help="Start of the time window")
    parser.add_argument("--until", dest="stop", type=float, metavar="SECONDS", help="End of the time window")


def add_time(parser):
    parser.add_argument(
        "--time", type=float, metavar="SECONDS",
        help="Simulated time of the picture (default: the last of which grains and flow are stored)",
    )


def add_kind(kinds, name, draw, text, of_one=False, several=False):
    """several: the figure shows all runs together, else each has its own."""
    kind = kinds.add_parser(name, help=text, description=text + ".")
    kind.set_defaults(draw=draw)
    if of_one:
        kind.add_argument("run", type=Path, metavar="RUN", help="Run folder")
    else:
        kind.add_argument(
            "runs", type=Path, nargs="*" if name == "relation" else "+", metavar="RUN", help="Run folders"
        )
    if several:
        kind.add_argument(
            "--out", type=Path, metavar="FILE", default=Path(f"{several}.png"), help="The figure (default: %(default)s)"
        )
    elif name == "all":
        kind.add_argument(
            "--out", type=Path, metavar="FOLDER", help="Folder for the figures of one run (default: the run folder)"
        )
    elif not of_one:
        kind.add_argument("--out", type=Path, metavar="FILE", help="The figure of one run (default: in the run folder)")
    return kind


def add_to(commands):
    plot = commands.add_parser(
        "plot",
        description="Figures of runs, finished or in progress. thalweg plot KIND --help shows the "
        "options of each kind.",
    )
    kinds = plot.add_subparsers(dest="kind", required=True, metavar="KIND", title="kinds")
    add_time(add_kind(kinds, "all", draw_all, "Side view, transport rate and profiles, as far as a run has them"))
    add_time(
        add_kind(
            kinds, "side", draw_side_view,
            "Side view of the grains in front of the flow (bed.png), or without grains of the flow (flow.png)",
        )
    )
    add_kind(
        kinds, "q", draw_transport_rate,
        "Transport rate against time, with the averaging window, the mean and its error",
    )
    add_kind(
        kinds, "profiles", draw_profiles,
        "Means over the height: solid fraction, velocities, stresses and their balance",
    )
    add_kind(kinds, "sizes", draw_sizes, "Transport by size class, and gradings of bed, surface and load")
    add_kind(
        kinds, "reach", draw_reach, "Sediment along x: level of the bed and transport in x and time, and their means"
    )
    relation = add_kind(
        kinds, "relation", draw_relation, "q* against the Shields number, beside relations and data of the literature",
        several="transport_relation",
    )
    add_window(relation)
    relation.add_argument("--surface", choices=("fraction", "static"), default="fraction",
                          help="Bed surface: at half the solid fraction, or by the static pixels of Zhang et al.")
    relation.add_argument(
        "--table", metavar="FILE", help="Table of the points, which is updated; all its points are drawn"
    )
    visible = add_kind(
        kinds, "visible", draw_visible, "Profiles of the grains that a camera sees beside the flume",
        several="visible_grains",
    )
    add_window(visible)
    visible.add_argument(
        "--frames", type=int, default=50, metavar="N", help="Largest number of frames (default: %(default)s)"
    )
    phases = add_kind(
        kinds, "two_phases", draw_two_phases, "A resolved bed beside the two-phase continuum", of_one=True,
        several="two_phases",
    )
    phases.add_argument("continuum", type=Path, metavar="CONTINUUM", nargs="?", help="Run folder of a continuum")
    add_film(add_kind(kinds, "film", draw_film, "A film of the side view", of_one=True))
    picture = add_kind(
        kinds, "picture", draw_picture, "Grains and flow in three dimensions, drawn by VTK without a screen",
        of_one=True,
    )
    picture.add_argument("--out", type=Path, metavar="FILE", help="A .png (default: picture.png in the run folder)")
    add_time(picture)
    picture.add_argument(
        "--view", dest="direction", type=float, nargs=3, default=(-0.45, -1.0, 0.4), metavar=("X", "Y", "Z"),
        help="Direction from which to look at the middle of the box",
    )
    picture.add_argument(
        "--size", type=int, nargs=2, default=(1400, 1000), metavar=("WIDTH", "HEIGHT"), help="Size in pixels"
    )


def add_film(film):
    film.add_argument(
        "--out", type=Path, metavar="FILE",
        help="A .gif, an .mp4 (where ffmpeg is installed) or a folder of images (default: film.gif in the run folder)",
    )
    add_window(film)
    film.add_argument("--every", type=float, default=0.0, metavar="SECONDS", help="Time between frames (default: all frames)")
    film.add_argument("--rate", type=float, default=20.0, metavar="N", help="Images a second (default: %(default)g)")
    film.add_argument("--width", type=int, default=900, metavar="PIXELS", help="Width of the images (default: %(default)s)")


def plot(wanted):
    for path in wanted.draw(wanted):
        print(path, flush=True)
    return 0
