"""A picture of a run in three dimensions: the grains by radius, coloured by speed, in front of a slice of the flow.

It draws the stored frames of grains and fluid (output.grains and output.fluid in the case), whichever exist, and
solids. The slice is that through the middle of the box, drawn at its far side, where it hides no grain. VTK draws on a
display of its own (Xvfb), so this also works where there is no screen.
"""
import contextlib
import os
import shutil
import subprocess

import numpy as np
import vtkmodules.vtkRenderingFreeType  # noqa: F401  (text)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (what renders)
from matplotlib.colors import to_rgb
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_ID_TYPE, vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkCellDataToPointData
from vtkmodules.vtkFiltersSources import vtkOutlineSource, vtkSphereSource
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import (vtkActor, vtkDataSetMapper, vtkGlyph3DMapper, vtkLightKit, vtkPolyDataMapper,
                                         vtkRenderer, vtkRenderWindow, vtkTextActor, vtkWindowToImageFilter)

from thalweg import drawing
from thalweg.errors import RunFolderError
from thalweg.units import units_of

SCENE_WIDTH = 0.80   # share of the picture; the colour scales take the rest
FILLED = 0.88        # share of the scene that the box may take, which leaves room for the title above it
MOST_PIXELS = 8192   # along a side; larger pictures take minutes, and very large ones never end


@contextlib.contextmanager
def display():
    """Sets DISPLAY to that of an Xvfb while the context lasts; leaves it as it is where there is no Xvfb."""
    if not shutil.which("Xvfb"):
        if not os.environ.get("DISPLAY"):
            raise RunFolderError("there is neither Xvfb (package xvfb on Debian) nor a display to draw on.")
        yield
        return
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24", "-nolisten", "tcp"],
                              pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    try:
        with os.fdopen(read) as answer:
            number = answer.readline().strip()
        if not number:
            raise RunFolderError("Xvfb does not start; try it by hand.")
        os.environ["DISPLAY"] = f":{number}"
        yield
    finally:
        server.terminate()
        server.wait()


def named(values, name):
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    return array


def lookup_table(colours, largest):
    """Colour table of a matplotlib map, from zero to the largest value."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(256)
    table.SetRange(0.0, largest)
    for k in range(256):
        table.SetTableValue(k, *colours(k))
    return table


def grain_actor(frame, per_speed):
    """Spheres coloured by speed, per_speed of which are 1 m/s, and the scale."""
    speed = np.linalg.norm(frame.velocity, axis=1)
    largest = per_speed * drawing.largest_speed_of(speed, np.median(frame.diameter))
    speed, table = per_speed * speed, lookup_table(drawing.GRAIN_COLOURS, largest)
    points, grains = vtkPoints(), vtkPolyData()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(frame.position, float), deep=True))
    grains.SetPoints(points)
    for values, name in ((2.0 * frame.radius, "diameter"), (speed, "speed")):
        grains.GetPointData().AddArray(named(values, name))
    sphere = vtkSphereSource()   # of diameter 1
    sphere.SetThetaResolution(32)
    sphere.SetPhiResolution(24)
    mapper = vtkGlyph3DMapper()
    mapper.SetInputData(grains)
    mapper.SetSourceConnection(sphere.GetOutputPort())
    mapper.SetScaleArray("diameter")
    mapper.SetScaleModeToScaleByMagnitude()
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("speed")
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetSpecular(0.25)
    actor.GetProperty().SetSpecularPower(30)
    return actor, table


def slice_actor(frame, layer, y, per_speed):
    """The fluid's speed in the middle layer across y, drawn at y (m), per_speed of which are 1 m/s, and the scale."""
    speed, box, _ = layer
    values = per_speed * drawing.without_holes(speed)
    table = lookup_table(drawing.FLUID_COLOURS, max(float(values.max()), 1e-12))
    image, points = vtkImageData(), vtkCellDataToPointData()
    image.SetDimensions(values.shape[1] + 1, 1, values.shape[0] + 1)
    image.SetOrigin(box[0], y, box[2])
    image.SetSpacing(*frame.spacing)
    image.GetCellData().SetScalars(named(values.ravel(), "speed"))
    points.SetInputData(image)
    mapper = vtkDataSetMapper()
    mapper.SetInputConnection(points.GetOutputPort())
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    return actor, table


def solid_actor(frame):
    points, triangles, surface = vtkPoints(), vtkCellArray(), vtkPolyData()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(frame.points), deep=True))
    ends = np.arange(0, frame.triangles.size + 1, 3)
    triangles.SetData(numpy_to_vtk(ends, deep=True, array_type=VTK_ID_TYPE),
                      numpy_to_vtk(frame.triangles.ravel(), deep=True, array_type=VTK_ID_TYPE))
    surface.SetPoints(points)
    surface.SetPolys(triangles)
    mapper, actor = vtkPolyDataMapper(), vtkActor()
    mapper.SetInputData(surface)
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*to_rgb(drawing.SOLID_COLOUR))
    return actor


def box_actor(size):
    outline, mapper, actor = vtkOutlineSource(), vtkPolyDataMapper(), vtkActor()
    outline.SetBounds(0.0, size[0], 0.0, size[1], 0.0, size[2])
    mapper.SetInputConnection(outline.GetOutputPort())
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.35, 0.35, 0.35)
    return actor


def plain_text(properties, size):
    properties.SetColor(0.1, 0.1, 0.1)
    properties.SetFontSize(size)
    properties.ItalicOff()
    properties.BoldOff()
    properties.ShadowOff()


def scale_bar(table, title, unit, place, font):
    bar = vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetTitle(f"{title}\n[{unit}]\n")
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.3g")
    bar.UnconstrainedFontSizeOn()
    for properties in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        plain_text(properties, font)
    bar.SetPosition(0.08, 0.53 - 0.48 * place)
    bar.SetWidth(0.55)
    bar.SetHeight(0.42)
    return bar


def scene(run, grains, fluid, direction, font):
    """Two renderers: the scene and its colour scales. direction: from which to look."""
    far_side = run.size[1] if direction[1] < 0.0 else 0.0   # y of the slice, m
    view, margin = vtkRenderer(), vtkRenderer()
    view.SetViewport(0.0, 0.0, SCENE_WIDTH, 1.0)
    margin.SetViewport(SCENE_WIDTH, 0.0, 1.0, 1.0)
    for renderer in (view, margin):
        renderer.SetBackground(1.0, 1.0, 1.0)
    vtkLightKit().AddLightsToRenderer(view)
    view.AddActor(box_actor(run.size))
    time = (fluid if grains is None else grains).time
    solids = run.solids.nearest(time)
    if solids:
        view.AddActor(solid_actor(solids))
    unit = units_of(run)
    shown = [("grain speed", *grain_actor(grains, unit.per_speed))] if grains else []
    layer = drawing.fluid_slice(fluid) if fluid else None
    if layer is not None:
        name = "fluid speed" + drawing.time_of_its_own(run, fluid, time)
        shown.append((name, *slice_actor(fluid, layer, far_side, unit.per_speed)))
    if not shown and grains is None:
        raise RunFolderError(f"{run.folder}: its frames of the fluid hold no velocity in the x-z plane.")
    for place, (title, actor, table) in enumerate(shown):
        view.AddActor(actor)
        margin.AddActor2D(scale_bar(table, title, unit.speed, place, font))
    title = vtkTextActor()
    title.SetInput(drawing.title_of(run, time) + drawing.flow_direction(run, direction[1]))
    plain_text(title.GetTextProperty(), font)
    title.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    title.SetPosition(0.03, 0.955)
    view.AddActor2D(title)
    return view, margin


def look_from(view, size, direction, aspect):
    """Points the camera at the middle of the box from a direction, as near as it can be with all of the box in view
    below the title. aspect: width of the view over its height."""
    camera, middle = view.GetActiveCamera(), 0.5 * np.asarray(size)
    towards = np.asarray(direction) / np.linalg.norm(direction)
    upwards = np.array([0.0, 0.0, 1.0]) if np.hypot(*towards[:2]) > 1e-6 else np.array([0.0, 1.0, 0.0])
    right = np.cross(upwards, towards) / np.linalg.norm(np.cross(upwards, towards))
    corners = (np.indices((2, 2, 2)).reshape(3, -1).T - 0.5) * size
    half = FILLED * np.tan(np.radians(0.5 * camera.GetViewAngle()))   # of the height, at a distance of one
    across = np.maximum(abs(corners @ right) / aspect, abs(corners @ np.cross(towards, right)))
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(middle + np.max(across / half + corners @ towards) * towards))
    camera.SetViewUp(*upwards)
    view.ResetCameraClippingRange()


def picture_of(run, grains, fluid, direction, pixels):
    """The content of a .png."""
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)   # smooth edges
    window.SetSize(*pixels)
    renderers = scene(run, grains, fluid, direction, max(10, pixels[1] // 45))
    for renderer in renderers:
        window.AddRenderer(renderer)
    look_from(renderers[0], run.size, direction, SCENE_WIDTH * pixels[0] / pixels[1])
    window.Render()
    image, writer = vtkWindowToImageFilter(), vtkPNGWriter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer.SetInputConnection(image.GetOutputPort())
    writer.WriteToMemoryOn()
    writer.Write()
    window.Finalize()
    return vtk_to_numpy(writer.GetResult()).tobytes()


def draw(run, path, time, direction, pixels):
    """Writes a .png of the frames nearest to a time (s; None: as in frames_at). direction: from which to look; pixels:
    width and height."""
    if not 0.0 < np.linalg.norm(direction) < np.inf:
        raise RunFolderError(
            f"--view {' '.join(f'{n:g}' for n in direction)}: this is not a direction; give three numbers, not all zero."
        )
    if not all(0 < count <= MOST_PIXELS for count in pixels):
        raise RunFolderError(
            f"--size {pixels[0]} {pixels[1]}: give a width and a height from 1 to {MOST_PIXELS} pixels."
        )
    if path.suffix.lower() != ".png":
        raise RunFolderError(f"--out {path}: a picture is a .png; give a name with this ending.")
    grains, fluid = drawing.frames_at(run, time)
    if grains is None and fluid is None:
        raise RunFolderError(f"{run.folder}: there is no frame of grains or fluid (output.grains.every in the case).")
    path.parent.mkdir(parents=True, exist_ok=True)
    with display():
        picture = picture_of(run, grains, fluid, direction, pixels)
    path.write_bytes(picture)
