"""The grains of a run folder as its pictures show them; for the comparisons beside this file."""
import xml.etree.ElementTree as xml
from pathlib import Path

from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def pictures(run):
    """Time (s) and grains (vtkPolyData) of every picture of the series."""
    for entry in xml.parse(Path(run) / "grains.pvd").getroot().iter("DataSet"):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(Path(run) / entry.get("file")))
        reader.Update()
        yield float(entry.get("timestep")), reader.GetOutput()


def trajectory(run):
    """Times (s), heights of the centre (m), velocities upwards (m/s) of the only grain."""
    times, heights, velocities = [], [], []
    for time, grain in pictures(run):
        times.append(time)
        heights.append(grain.GetPoint(0)[2])
        velocities.append(grain.GetPointData().GetArray("velocity").GetTuple3(0)[2])
    return times, heights, velocities
