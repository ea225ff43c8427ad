"""What the tests of the package thalweg share: the package's place and run folders made up by VTK's own writers."""
import pathlib
import sys
import tempfile
import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter, vtkXMLPolyDataWriter

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))

CASE = """# Thalweg run: this is the case as it was run.
system: resolved
name: Made up
domain: {size: [0.12, 0.0105, 0.1485], spacing: 0.5e-3,
         boundaries: {x: periodic, y: {type: law_of_the_wall}, bottom: no_slip, top: free_slip}}
fluid: {density: 1000, kinematic_viscosity: 1e-06}
gravity: {magnitude: 9.8, slope: 0.0748}
grains: [{count: 969, diameter: 4.95e-3, density: 2550}]
analysis: {transport_rate: {from: 1.0}}
"""


def write_array(file, path, values, unit, axes="", components=None):
    """An array in an HDF5 file, labelled as the program does; without axes, as older versions did."""
    data = file.create_dataset(path, data=values)
    data.attrs["units" if axes else "unit"] = unit
    if components:
        data.attrs["components"] = components
    for dimension, axis in zip(data.dims, axes.split()):
        if data.name.endswith(f"/{axis}"):
            data.make_scale(axis)
            continue
        if axis not in data.parent:
            length = data.shape[axes.split().index(axis)]
            data.parent[axis] = np.arange(length)
            data.parent[axis].make_scale(f"This is a netCDF dimension but not a netCDF variable.{length:10}")
        dimension.attach_scale(data.parent[axis])


class MadeUpFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name) / "run"
        (self.folder / "grains").mkdir(parents=True)
        (self.folder / "fluid").mkdir()
        (self.folder / "case.yaml").write_text(CASE)

    def write_frames(self, times, places, **arrays):
        """grains.pvd and its frames: positions, and arrays by name, at each time."""
        names = []
        for n, time in enumerate(times):
            names.append((time, f"grains/grains_{n}.vtp"))
            count = len(places[n])
            values = {"id": np.arange(count), "radius": np.full(count, 2.475e-3), "velocity": np.zeros((count, 3))}
            values.update({name: series[n] for name, series in arrays.items()})
            write_points(self.folder / names[-1][1], places[n], values)
        write_index(self.folder / "grains.pvd", names)


def write_points(path, places, arrays, adapt=lambda writer: None):
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(places, float), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    add_arrays(data.GetPointData(), arrays)
    write(vtkXMLPolyDataWriter(), data, path, adapt)


def write_triangles(path, points, triangles, arrays):
    cells = vtkCellArray()
    for triangle in triangles:
        cells.InsertNextCell(3, triangle)
    places = vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points, float), deep=True))
    data = vtkPolyData()
    data.SetPoints(places)
    data.SetPolys(cells)
    add_arrays(data.GetCellData(), arrays)
    write(vtkXMLPolyDataWriter(), data, path, lambda writer: None)


def write_image(path, extent, spacing, arrays, adapt=lambda writer: None):
    """extent: of the points, six numbers; arrays as [z, y, x] and perhaps a component."""
    image = vtkImageData()
    image.SetExtent(*extent)
    image.SetSpacing(spacing, spacing, spacing)
    add_arrays(image.GetCellData(), {name: values.reshape(-1, *values.shape[3:]) for name, values in arrays.items()})
    write(vtkXMLImageDataWriter(), image, path, adapt)


def add_arrays(section, arrays):
    for name, values in arrays.items():
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        section.AddArray(array)


def write(writer, data, path, adapt):
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    adapt(writer)
    writer.Write()


def write_index(path, entries):
    lines = "".join(f'<DataSet timestep="{time}" part="0" file="{file}"/>' for time, file in entries)
    path.write_text(f'<?xml version="1.0"?><VTKFile type="Collection"><Collection>{lines}</Collection></VTKFile>')
