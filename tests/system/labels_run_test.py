#!/usr/bin/env python3
"""HDF5 files of a run name their units and dimensions by the conventions of netCDF-4: seen with h5py, and with xarray
where it is installed.

Called by ctest: labels_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import importlib.util
import sys
import unittest
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import entrainment_run_test
import program
import thalweg
from program import ProgramTest

HAS = {name: importlib.util.find_spec(name) is not None for name in ("xarray", "h5netcdf", "netCDF4")}
NO_VARIABLE = b"This is a netCDF dimension but not a netCDF variable."
# Of each file that a run leaves (without the step): groups, in them dimensions of an array, and the unit of one.
ARRAYS = {
    "profiles.h5": {
        "fluid_statistics": {
            "velocity": ("m/s", "z axis"), "reynolds_stress": ("m^2/s^2", "z symmetric"), "z": ("m", "z"),
        }, "grain_profiles": {"contact_stress": ("Pa", "z tensor"), "solid_fraction": ("1", "z")},
        "stress_balance": {"viscous_stress": ("Pa", "z symmetric"), "thickness": ("m", "z")},
        "transport_rate": {
            "velocity_density": ("s/m", "velocity_bin axis"), "hop_time_count": ("1", "hop_time_bin"),
            "hop_length_edges": ("m", "hop_length_edges"),
        }, "bed_surface": {"static_surface": ("m", "x")},
        "reach": {"q_s_error": ("m^2/s", "section"), "deposition_rate": ("m/s", "x")},
    }, "tracks": {"/": {"position": ("m", "time id axis"), "time": ("s", "time"), "id": ("1", "id")}},
    "probes": {
        "/": {"velocity": ("m/s", "time point axis"), "pressure": ("Pa", "time point"), "cell_y": ("1", "point")}
    },
    "reach": {
        "/": {
            "bed_level": ("m", "time x"), "q_s": ("m^2/s", "time section"), "x": ("m", "x"),
            "section": ("m", "section"), "interval": ("s", "time"),
        }
    },
    "entrainment": {
        "event_000001": {
            "fluid_force": ("N", "time axis"), "fluid_torque": ("N m", "time"), "contact_sample": ("1", "contact"),
            "contact_point": ("m", "contact axis"), "hinge_points": ("m", "hinge_partner axis"),
            "rest_position": ("m", "axis"), "id": ("1", "id"),
        }
    }, "bed.h5": {"grains": {"position": ("m", "id axis"), "radius": ("m", "id")}, "bed": {"periodic": ("1", "axis")}},
}


class LabelsRun(ProgramTest):
    CASE = entrainment_run_test.EntrainmentRun.CASE + """
  tracks: {grains: [24, 25], every: 0.01}
  probes: {points: [[0.001, 0.002, 0.014], [0.002, 0.002, 0.014]], every: 0.01}
  fluid_statistics: {from: 0.1}
  grain_profiles: {from: 0.1}
  stress_balance: {from: 0.1}
  transport_rate: {from: 0.1}
  bed_surface: {from: 0.1}
  reach: {from: 0.1, every: 0.01, record_every: 0.05}
"""

    def setUp(self):
        super().setUp()
        self.run_well("run", self.case, "--out", "run")

    def paths(self, name):
        """Files of a run that hold what ARRAYS has under a name."""
        found = self.folder / "run" / name
        return [found] if found.is_file() else sorted(found.iterdir())[1:]   # the first part holds no row

    def groups(self):
        for name, groups in ARRAYS.items():
            for group, arrays in groups.items():
                holding = []
                for path in self.paths(name):
                    with h5py.File(path) as file:
                        if group in file:
                            holding.append(path)
                self.assertTrue(holding, (name, group))
                for path in holding:
                    yield path, group, arrays

    def dimensions(self, data):
        """Names of the dimensions, whose scales must be as long as they are and know the array."""
        names = []
        if data.attrs.get("CLASS") == b"DIMENSION_SCALE":
            self.assertEqual(data.ndim, 1)
            return [data.name.rpartition("/")[2]]
        for number, (scales, length) in enumerate(zip(data.dims, data.shape)):
            self.assertEqual(len(scales), 1, data.name)
            self.assertEqual((scales[0].parent, scales[0].shape), (data.parent, (length,)))
            self.assertIn(
                (data.name, number),
                [(data.file[place].name, where) for place, where in scales[0].attrs["REFERENCE_LIST"]],
            )
            names.append(scales[0].name.rpartition("/")[2])
        return names

    def test_every_dimension_has_a_scale_and_every_array_its_unit(self):
        for path, group, arrays in self.groups():
            with h5py.File(path) as file:
                for name, data in file[group].items():
                    if isinstance(data, h5py.Group):
                        continue
                    dimensions = " ".join(self.dimensions(data))
                    if data.attrs.get("NAME", b"").startswith(NO_VARIABLE):
                        self.assertNotIn("units", data.attrs)
                        continue
                    units = data.attrs["units"].decode("utf-8")
                    self.assertEqual(h5py.check_string_dtype(data.attrs.get_id("units").dtype).encoding, "utf-8")
                    if name in arrays:
                        self.assertEqual((units, dimensions), arrays[name], f"{path} {group} {name}")
                self.assertLessEqual(set(arrays), set(file[group]), path)

    def test_python_has_the_names_of_the_file(self):
        run = thalweg.Run(self.folder / "run")
        read = {
            "tracks": {"/": run.tracks}, "probes": {"/": run.probes}, "reach": {"/": run.reach},
            "entrainment": run.entrainment, "profiles.h5": run.profiles,
        }
        for name, groups in read.items():
            for group, arrays in ARRAYS[name].items():
                for array, (unit, dimensions) in arrays.items():
                    self.assertEqual(
                        (groups[group].units[array], " ".join(groups[group].dimensions(array))), (unit, dimensions)
                    )
        self.assertNotIn("axis", run.tracks)
        self.assertEqual(run.entrainment["event_000001"].attributes.keys() & {"time", "time_units"}, {"time"})

    @unittest.skipUnless(HAS["xarray"] and (HAS["h5netcdf"] or HAS["netCDF4"]), "needs xarray with h5netcdf or netCDF4")
    def test_xarray_opens_every_file(self):
        import xarray
        for engine in [
            engine for engine, package in (("h5netcdf", "h5netcdf"), ("netcdf4", "netCDF4")) if HAS[package]
        ]:
            for path, group, arrays in self.groups():
                with xarray.open_dataset(path, group=group, engine=engine) as found, h5py.File(path) as file:
                    for name, (unit, dimensions) in arrays.items():
                        self.assertEqual(
                            (found[name].attrs["units"], " ".join(found[name].dims)), (unit, dimensions),
                            f"{engine} {path} {name}",
                        )
                        numpy.testing.assert_array_equal(found[name].values, file[group][name][()])
                        self.assertEqual(
                            set(found[name].coords),
                            {
                                axis
                                for axis in dimensions.split()
                                if axis in file[group] and not file[group][axis].attrs["NAME"].startswith(NO_VARIABLE)
                            },
                        )
        with xarray.open_dataset(self.paths("tracks")[-1]) as tracks:
            self.assertEqual(tracks.position.sel(id=25).dims, ("time", "axis"))

    def test_the_same_bytes_on_any_ranks(self):
        self.run_well("run", self.case, "--out", "two", ranks=2)
        for path in [path for name in ARRAYS for path in self.paths(name)]:
            self.assertEqual(
                path.read_bytes(), (self.folder / "two" / path.relative_to(self.folder / "run")).read_bytes(), path
            )


if __name__ == "__main__":
    program.main()
