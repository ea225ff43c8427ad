"""Pictures of the fluid, read back."""
from vtk import vtkXMLImageDataReader
from vtk.util.numpy_support import vtk_to_numpy


def cell_data(path):
    """Arrays of a picture by name, each with the axes z, y, x (, component)."""
    reader = vtkXMLImageDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    nx, ny, nz = (n - 1 for n in image.GetDimensions())
    data = image.GetCellData()
    arrays = {}
    for a in range(data.GetNumberOfArrays()):
        values = vtk_to_numpy(data.GetArray(a))
        arrays[data.GetArrayName(a)] = values.reshape((nz, ny, nx) + values.shape[1:])
    return arrays
