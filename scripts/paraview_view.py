#!/usr/bin/env pvpython
"""A run in ParaView: grains by radius and speed in front of a slice of the flow, as a picture and as a state to open.

    pvpython scripts/paraview_view.py RUN_FOLDER [--state FILE] [--out FILE] [--time SECONDS] [--size WIDTH HEIGHT]

The state (RUN_FOLDER/view.pvsm) is what File > Load State opens in ParaView, with all times of the run to step through.
It is made for ParaView 5.11 or later. Where there is no screen: xvfb-run -a -s -noreset pvpython ... Without ParaView,
thalweg plot picture draws a similar picture.
"""
import argparse
import os
import sys
from pathlib import Path

try:
    from paraview import simple
except ModuleNotFoundError:
    sys.exit("paraview_view: this Python has no ParaView; start the script with pvpython, or use thalweg plot picture.")

OF_GRAINS, OF_FLUID = "Viridis (matplotlib)", "Blues"
DARK, GREY = [0.1, 0.1, 0.1], [0.55, 0.55, 0.55]
ZOOM = 1.1   # ParaView leaves room around what it shows
RESOLUTION = 24   # of a sphere, around and from pole to pole


def series(folder, name):
    """What is stored in RUN_FOLDER/NAME.pvd; None where there is nothing."""
    path = folder / f"{name}.pvd"
    return simple.PVDReader(registrationName=name, FileName=str(path.resolve())) if path.exists() else None


def arrays(information):
    return [information.GetArray(number).Name for number in range(information.GetNumberOfArrays())]


def bounds(source):
    return source.GetDataInformation().GetBounds()


def colour(shown, view, where, name, title, colours):
    """Colours by the magnitude of a vector, or by a number, over its range at the time shown."""
    simple.ColorBy(shown, (where, name, "Magnitude") if name == "velocity" else (where, name))
    table = simple.GetColorTransferFunction(name if where == "POINTS" else f"fluid {name}")
    shown.LookupTable = table
    table.ApplyPreset(colours, True)
    shown.RescaleTransferFunctionToDataRange(False, True)
    bar = simple.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = DARK
    bar.WindowLocation = "Lower Right Corner" if where == "POINTS" else "Upper Right Corner"
    shown.SetScalarBarVisibility(view, True)


def show_grains(grains, view):
    spheres = simple.Glyph(registrationName="spheres", Input=grains, GlyphType="Sphere")
    spheres.ScaleArray = ["POINTS", "radius"]
    spheres.ScaleFactor = 2.0          # the glyph is a sphere of diameter 1
    spheres.OrientationArray = ["POINTS", "No orientation array"]
    spheres.GlyphMode = "All Points"
    spheres.GlyphType.ThetaResolution = spheres.GlyphType.PhiResolution = RESOLUTION
    shown = simple.Show(spheres, view)
    simple.Hide(grains, view)
    name = "speed" if "speed" in arrays(grains.PointData) else "velocity"
    if name in arrays(grains.PointData):
        colour(shown, view, "POINTS", name, "speed of the grains [m/s]", OF_GRAINS)


def show_fluid(fluid, view):
    """The slice that is stored or, of the whole fluid, the one at the far side of the box, where it hides no grain."""
    low, high = bounds(fluid)[2:4]
    source = fluid
    if high - low > 0.0 and fluid.GetDataInformation().GetExtent()[3] > fluid.GetDataInformation().GetExtent()[2] + 1:
        source = simple.Slice(registrationName="slice", Input=fluid, SliceType="Plane")
        source.SliceType.Normal = [0.0, 1.0, 0.0]
        source.SliceType.Origin = [0.0, high - 1e-3 * (high - low), 0.0]
        simple.Hide(fluid, view)
    shown = simple.Show(source, view)
    if source is fluid:
        shown.Representation = "Surface"
        shown.Position = [0.0, high, 0.0]   # behind the grains
    if "velocity" in arrays(fluid.CellData):
        colour(shown, view, "CELLS", "velocity", "speed of the fluid [m/s]", OF_FLUID)


def show_solids(solids, view):
    shown = simple.Show(solids, view)
    simple.ColorBy(shown, None)
    shown.AmbientColor = shown.DiffuseColor = GREY


def look_from_the_side(view):
    simple.ResetCamera(view)
    camera = simple.GetActiveCamera()
    middle, away = camera.GetFocalPoint(), camera.GetDistance()
    camera.SetPosition(middle[0] + 0.35 * away, middle[1] - 0.9 * away, middle[2] + 0.25 * away)
    camera.SetViewUp(0.0, 0.0, 1.0)
    simple.ResetCamera(view)
    camera.Zoom(ZOOM)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run_folder", type=Path)
    parser.add_argument(
        "--state", type=Path, metavar="FILE", help="state for ParaView (default: view.pvsm in the run folder)"
    )
    parser.add_argument("--out", type=Path, metavar="FILE", help="picture (default: paraview.png in the run folder)")
    parser.add_argument(
        "--time", type=float, help="simulated time in s of the picture (default: the last that is stored)"
    )
    parser.add_argument("--size", type=int, nargs=2, default=(1280, 720), metavar=("WIDTH", "HEIGHT"), help="pixels")
    arguments = parser.parse_args()
    folder = arguments.run_folder
    grains, fluid, solids = series(folder, "grains"), series(folder, "fluid"), series(folder, "solids")
    if not grains and not fluid:
        print(
            (
                f"paraview_view: {folder} has neither grains.pvd nor fluid.pvd (output.grains and output.fluid of the"
                " case)."
            ), file=sys.stderr,
        )
        return 1
    view = simple.GetActiveViewOrCreate("RenderView")
    view.ViewSize = list(arguments.size)
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesLabelColor = DARK
    times = (grains or fluid).TimestepValues
    view.ViewTime = times[-1] if arguments.time is None else min(times, key=lambda time: abs(time - arguments.time))
    for source, show in ((grains, show_grains), (fluid, show_fluid), (solids, show_solids)):
        if source:
            source.UpdatePipeline(view.ViewTime)
            show(source, view)
    look_from_the_side(view)
    simple.Render(view)
    picture, state = arguments.out or folder / "paraview.png", arguments.state or folder / "view.pvsm"
    simple.SaveScreenshot(str(picture), view, ImageResolution=list(arguments.size))
    simple.SaveState(str(state))
    print(picture)
    print(state)
    return 0


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    os._exit(code)   # ParaView 5.11 closes its window when the display has gone already, and fails
