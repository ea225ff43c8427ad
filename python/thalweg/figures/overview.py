"""Which figures a run calls for."""
from thalweg import drawing, height_profiles
from thalweg.errors import RunFolderError
from thalweg.figures import column, fluid_profiles, reach, sizes, transport_rate
from thalweg.sizes import measured as measured_by_size


def bed_figure(run, time=None):
    """The grains, coloured by speed, in front of the fluid's speed in the middle plane, at a time (s)."""
    grains, fluid = drawing.frames_at(run, time)
    if grains is None:
        raise RunFolderError(f"{run.folder}: no picture of the grains yet (output.grains.every in the case).")
    return drawing.bed_figure(run, grains, fluid)


def side_view_of(run, time=None):
    """Name and function of the side view: of the grains, or of a fluid alone."""
    if run.case.get("system") == "fluid":
        return "flow", lambda: drawing.flow_figure(run, run.fluid.nearest(time))
    return "bed", lambda: bed_figure(run, time)


def profiles_of(run):
    """The function that draws the means over the height, of a continuum its column; None where the run has none
    yet."""
    if run.system == "continuum":
        return (lambda: column.figure_of(run)) if column.measured(run) else None
    if run.case.get("system") == "fluid":
        return (lambda: fluid_profiles.figure_of(run)) if fluid_profiles.measured(run) else None
    if height_profiles.has_grains(run) and height_profiles.measured(run):
        return lambda: height_profiles.figure_of(run)
    return None


def figures_of(run, time=None):
    """Names of the figures that the system and the case call for, and the functions that draw them. time: of the side
    view, s."""
    system, analysis = run.case.get("system"), run.case.get("analysis") or {}
    figures = [] if system == "continuum" else [side_view_of(run, time)]
    if system == "continuum" or (system != "fluid" and "transport_rate" in analysis):
        figures.append(("transport_rate", lambda: transport_rate.figure_of(run)))
    if measured_by_size(run):
        figures.append(("sizes", lambda: sizes.figure_of(run)))
    if reach.measured(run):
        figures.append(("reach", lambda: reach.figure_of(run)))
    profiles = profiles_of(run)
    return figures + ([("profiles", profiles)] if profiles else [])
