"""Opens the series that io_vtk_test wrote with VTK's own readers, as ParaView would, and compares every number; and
with the reader of python/thalweg, which must find the same.

Usage: check_vtk_series.py FOLDER [OTHER]; the pictures in FOLDER must also be those in OTHER, byte for byte.
"""
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
from thalweg.vtk_files import read_image, read_points, read_triangles

FOLDER, OTHERS = Path(sys.argv[1]), [Path(name) for name in sys.argv[2:]]
CELLS, SPACING, GRAINS = (24, 20, 18), 0.25e-3, 9001
TIMES = [0.0, 0.2, 0.1 * 7]


def pictures(index):
    """(time, path) of every picture a .pvd lists."""
    root = xml.parse(index).getroot()
    assert root.get("type") == "Collection", index
    found = [(float(d.get("timestep")), index.parent / d.get("file")) for d in root.iter("DataSet")]
    assert [time for time, _ in found] == TIMES, f"{index}: times {[time for time, _ in found]}"
    return found


def read(reader, path, time):
    reader.SetFileName(str(path))
    assert reader.CanReadFile(str(path)), path
    reader.Update()
    assert reader.GetErrorCode() == 0, path
    data = reader.GetOutput()
    assert vtk_to_numpy(data.GetFieldData().GetArray("TimeValue")).tolist() == [time], path
    return data


def arrays(data):
    return {data.GetArrayName(n): vtk_to_numpy(data.GetArray(n)) for n in range(data.GetNumberOfArrays())}


def check_grains(
    name, with_fluid, with_stress=False, index="grains", shown=lambda time: np.arange(GRAINS), fields=None
):
    """shown: the ids of the grains in a frame; fields: those of its arrays, None for all."""
    for time, path in pictures(FOLDER / name / f"{index}.pvd"):
        data = read(vtkXMLPolyDataReader(), path, time)
        n = shown(time)
        count = len(n)
        assert np.array_equal(vtk_to_numpy(data.GetVerts().GetConnectivityArray()), np.arange(count))
        zero, one = np.zeros(count), np.ones(count)
        assert data.GetNumberOfPoints() == count and data.GetNumberOfVerts() == count
        points = vtk_to_numpy(data.GetPoints().GetData())
        assert np.array_equal(points, np.stack([0.1 * n, 0.2 * n, 0.3 * n + time], axis=1))
        expected = {
            "id": n,
            "radius": 1e-3 + 1e-5 * n,
            "speed": 5.0 * n,
            "velocity": np.stack([3.0 * n, 4.0 * n, zero], axis=1),
            "angular_velocity": np.stack([n, zero, -n], axis=1),
            "contact_force": np.stack([one, 2 * one, n], axis=1),
        }
        if with_fluid:
            expected["fluid_force"] = np.stack([zero, n, one], axis=1)
        expected["contact_stress"] = np.zeros((count, 9))
        if with_stress:
            expected["fluid_stress"] = np.stack([n] + [k * one for k in range(1, 9)], axis=1)
            # One force of (-1, 0, n) N at the end of the radius along x: F_a r_b over the volume.
            radius = expected["radius"]
            volume = 4.0 / 3.0 * np.pi * radius**3
            expected["contact_stress"][:, 0] = -radius / volume
            expected["contact_stress"][:, 6] = n * radius / volume
        expected["population"] = (n >= 4000).astype(int)
        expected["held"] = n % 4
        expected["density"] = 1.0 / (4.0 / 3.0 * np.pi * expected["radius"]**3)   # of 1 kg
        if fields:
            expected = {name: expected[name] for name in ["radius"] + fields}
        found = arrays(data.GetPointData())
        ours = read_points(path)
        assert np.array_equal(ours[0], points) and ours[1].keys() == found.keys()
        assert all(np.array_equal(ours[1][key], values) for key, values in found.items())
        assert found.keys() == expected.keys(), found.keys()
        for key, values in expected.items():
            same = np.allclose(found[key], values, rtol=1e-14, atol=0) if key in ("contact_stress", "density") \
                else np.array_equal(found[key], values)
            assert same, f"{path}: {key}"


def check_fluid(name, fields, lower, upper, strides=(1, 1, 1), real=np.float32):
    """lower, upper: of the cells that are shown, every so many of them along each axis; real: type of the numbers."""
    for time, path in pictures(FOLDER / name / "fluid.pvd"):
        data = read(vtkXMLImageDataReader(), path, time)
        shown = [np.arange(lower[a], upper[a], strides[a]) for a in range(3)]
        extent, bounds = np.reshape(data.GetExtent(), (3, 2)), np.reshape(data.GetBounds(), (3, 2))
        for a in range(3):
            assert extent[a, 1] - extent[a, 0] == len(shown[a]), data.GetExtent()
            # The middle of the first and of the last cell of the picture is that of a cell of the fluid.
            width = strides[a] * SPACING
            ends = SPACING * (shown[a][[0, -1]] + 0.5) + 0.5 * width * np.array([-1, 1])
            assert np.allclose(bounds[a], ends, rtol=1e-12, atol=1e-12 * SPACING), (data.GetBounds(), ends)
            assert np.isclose(data.GetSpacing()[a], width, rtol=1e-14)
        if max(strides) == 1:
            assert extent.ravel().tolist() == [bound for pair in zip(lower, upper) for bound in pair], data.GetExtent()
            assert data.GetOrigin() == (0.0, 0.0, 0.0)
        k, j, i = np.meshgrid(*[shown[a] for a in (2, 1, 0)], indexing="ij")
        i, j, k = i.ravel(), j.ravel(), k.ravel()
        expected = {
            "velocity": np.stack([i, j, k], axis=1) + 0.5,
            "pressure": (i + 100 * j + 10000 * k + time).astype(real),
            "grain_id": (i + j + k) % 5 - 1,
        }
        found = arrays(data.GetCellData())
        ours = read_image(path)[2]
        assert ours.keys() == found.keys()
        assert all(np.array_equal(ours[key].reshape(values.shape), values) for key, values in found.items())
        assert list(found) == fields, list(found)
        for key, values in found.items():
            assert np.array_equal(values, expected[key]), f"{path}: {key}"
            assert values.dtype == (np.int32 if key == "grain_id" else real), f"{path}: {key}"


def check_solids():
    """A strip of 5000 triangles, and one alone."""
    n = np.arange(5000)
    corners = np.vstack([np.stack([n, n + 1, n + 2], axis=1), [[5002, 5003, 5004]]])
    k = np.arange(5002)
    for time, path in pictures(FOLDER / "solid/solids.pvd"):
        data = read(vtkXMLPolyDataReader(), path, time)
        points = np.vstack([np.stack([0.5 * k, k % 2, 0.0 * k + time], axis=1), [[0, 0, 0], [1, 0, 0], [0, 1, time]]])
        assert np.array_equal(vtk_to_numpy(data.GetPoints().GetData()), points)
        assert np.array_equal(vtk_to_numpy(data.GetPolys().GetConnectivityArray()), corners.ravel())
        assert np.array_equal(vtk_to_numpy(data.GetPolys().GetOffsetsArray()), 3 * np.arange(5002))
        assert arrays(data.GetCellData())["solid"].tolist() == 5000 * [0] + [1]
        ours = read_triangles(path)
        assert np.array_equal(ours[0], points) and np.array_equal(ours[1], corners)
        assert ours[2]["solid"].tolist() == 5000 * [0] + [1]


check_solids()
check_grains("wet", True)
check_grains("stressed", True, True)
check_grains("dry", False)
check_grains("some", True, True, "part", lambda time: np.array([0, 7, 4096, 9000]))
check_grains("second", True, True, "part", lambda time: np.arange(4000, GRAINS), ["id", "population"])
check_grains(
    "boxed", True, True, "part", lambda time: np.arange(3, 8 if time < 0.1 else 7 if time < 0.5 else 6), ["id", "held"]
)
check_grains("nobody", True, True, "part", lambda time: np.arange(0), ["velocity"])
check_fluid("whole", ["velocity", "pressure", "grain_id"], (0, 0, 0), CELLS)
check_fluid("slice_x", ["velocity"], (12, 0, 0), (13, 20, 18))
check_fluid("slice_y", ["pressure", "velocity"], (0, 10, 0), (24, 11, 18))
check_fluid("slice_z", ["grain_id"], (0, 0, 9), (24, 20, 10))
check_fluid("sparse", ["velocity", "grain_id"], (4, 5, 3), (21, 20, 9), (3, 3, 3))
check_fluid("precise", ["pressure", "grain_id"], (0, 0, 9), (24, 20, 10), real=np.float64)
check_fluid("plane", ["pressure"], (0, 0, 10), (24, 20, 11), (4, 4, 1))

# One file a picture, and the same one on any number of ranks.
files = sorted(path.relative_to(FOLDER) for path in FOLDER.rglob("*") if path.is_file())
assert {path.suffix for path in files} == {".pvd", ".vtp", ".vti"}, files
assert sum(path.suffix == ".vti" for path in files) == 7 * 3, files   # two of the five frames have been removed
for other in OTHERS:
    assert files == sorted(path.relative_to(other) for path in other.rglob("*") if path.is_file()), other
    for path in files:
        assert (FOLDER / path).read_bytes() == (other / path).read_bytes(), path
print(f"{FOLDER}: every array, extent and time as written")
