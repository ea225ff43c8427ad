"""A run folder made up by VTK's own writers, to test what reads run folders without a simulation."""
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter, vtkXMLPolyDataWriter

SPACING = 0.825e-3            # m
CELLS = (72, 13, 90)
DIAMETER = 4.95e-3            # m
BED_HEIGHT = 8 * DIAMETER     # m


def write_grains(path, generator):
    """A loose bed on shaken lattice sites, faster towards the top; returns how many grains."""
    pitch = 1.02 * DIAMETER
    size = np.array(CELLS) * SPACING
    sites = np.stack(np.meshgrid(*[np.arange(0.5 * DIAMETER, top - 0.4 * DIAMETER, pitch)
                                   for top in (size[0], size[1], BED_HEIGHT)], indexing="ij"), -1).reshape(-1, 3)
    sites = sites + generator.uniform(-0.08, 0.08, sites.shape) * DIAMETER
    sites[:, 0] += (sites[:, 2] // pitch % 2) * 0.5 * DIAMETER
    sites[:, 0] %= size[0]
    hopping = sites[generator.choice(len(sites), 4, replace=False)]
    hopping[:, 2] = BED_HEIGHT + generator.uniform(0.3, 2.0, 4) * DIAMETER
    sites = np.vstack([sites, hopping])
    speed = 0.35 * np.exp((np.minimum(sites[:, 2], BED_HEIGHT + DIAMETER) - BED_HEIGHT) / DIAMETER)
    velocity = np.zeros_like(sites)
    velocity[:, 0] = speed
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(sites, deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    for name, values in (("id", np.arange(len(sites))), ("radius", np.full(len(sites), DIAMETER / 2)),
                         ("velocity", velocity)):
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    writer.Write()
    return len(sites)


def write_fluid(path):
    """The middle layer across y with a logarithmic profile above the bed and 40 grain cells in the bottom row."""
    nx, ny, nz = CELLS
    z = (np.arange(nz) + 0.5) * SPACING
    profile = 0.15 * np.log1p(30 * np.maximum(z - BED_HEIGHT, 0.0) / DIAMETER)
    velocity = np.zeros((nz, 1, nx, 3), np.float32)
    wave = 1 + 0.08 * np.sin(6 * np.pi * np.arange(nx) / nx + 200 * z[:, None])
    velocity[..., 0] = (profile[:, None] * wave)[:, None]
    grain_id = np.full((nz, 1, nx), -1, np.int32)
    grain_id[0, 0, :40] = 3
    image = vtkImageData()
    image.SetOrigin(0, ny // 2 * SPACING, 0)
    image.SetSpacing(SPACING, SPACING, SPACING)
    image.SetDimensions(nx + 1, 2, nz + 1)
    for name, values in (("velocity", velocity.reshape(-1, 3)), ("grain_id", grain_id.ravel())):
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        image.GetCellData().AddArray(array)
    writer = vtkXMLImageDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(image)
    writer.Write()


def write_index(path, entries):
    lines = "".join(f'<DataSet timestep="{time}" group="" part="0" file="{file}"/>' for time, file in entries)
    path.write_text(f'<?xml version="1.0"?><VTKFile type="Collection" version="0.1"><Collection>{lines}'
                    "</Collection></VTKFile>")


def write_run(folder):
    """Everything thalweg plot reads; returns the number of grains in the last picture."""
    generator = np.random.default_rng(7)
    (folder / "grains").mkdir(parents=True)
    (folder / "fluid").mkdir()
    grains = [write_grains(folder / f"grains/grains_{step}.vtp", generator) for step in (0, 30000)][-1]
    write_fluid(folder / "fluid/fluid_30000.vti")
    write_index(folder / "grains.pvd", [(0.0, "grains/grains_0.vtp"), (3.0, "grains/grains_30000.vtp")])
    write_index(folder / "fluid.pvd", [(3.0, "fluid/fluid_30000.vti")])
    size = ", ".join(str(n * SPACING) for n in CELLS)
    (folder / "case.yaml").write_text(
        "# Thalweg run:\nname: A made-up flume\n"
        f"domain: {{size: [{size}], spacing: {SPACING}, boundaries: {{x: periodic, y: {{type: law_of_the_wall}}}}}}\n"
        "analysis: {transport_rate: {from: 1.0}}\n")
    time = np.arange(0, 3.005, 0.01)
    rate = 0.06 * (1 - np.exp(-time / 0.4)) * (1 + 0.3 * generator.standard_normal(len(time)))
    rows = "".join(f"{t},0.05,{q}\n" for t, q in zip(time, rate))
    (folder / "series.csv").write_text("time [s],largest_lattice_velocity [1],q_star [1]\n" + rows)
    return grains
