"""Data of a run as pandas tables and xarray data sets, with units and named axes; and what is said of a name that is
not there."""
import importlib.util
import unittest
import unittest.mock

import h5py
import numpy as np

import made_up_folder as made_up
import thalweg
from thalweg.layers import layer_profiles

HAS_XARRAY = importlib.util.find_spec("xarray") is not None
HAS_PANDAS = importlib.util.find_spec("pandas") is not None
GRAINS = np.array([3, 17])


class Labelled(made_up.MadeUpFolder):
    def setUp(self):
        super().setUp()
        self.write_frames(
            [0.0, 0.5], [np.arange(6.0).reshape(2, 3), 1 + np.arange(6.0).reshape(2, 3)], id=[GRAINS, GRAINS],
            contact_stress=[np.arange(18.0).reshape(2, 9)] * 2,
        )
        (self.folder / "series.csv").write_text("time [s],q_star [1],bed_stress [Pa]\n0,1,2\n1,3,4\n")
        with h5py.File(self.folder / "profiles.h5", "w") as file:
            made_up.write_array(file, "fluid_statistics/z", np.arange(4.0), "m", "z")
            made_up.write_array(file, "fluid_statistics/y", np.arange(5.0), "m", "y")
            made_up.write_array(
                file, "fluid_statistics/velocity", np.arange(12.0).reshape(4, 3), "m/s", "z axis", "x y z"
            )
            made_up.write_array(
                file, "fluid_statistics/section_velocity", np.arange(60.0).reshape(4, 5, 3), "m/s", "z y axis", "x y z"
            )
            made_up.write_array(file, "transport_rate/hop_length_count", np.arange(4.0), "1", "hop_length_bin")
            made_up.write_array(file, "old/z", np.arange(4.0), "m")
            made_up.write_array(file, "old/velocity", np.arange(12.0).reshape(4, 3), "m/s", components="x y z")
        (self.folder / "tracks").mkdir()
        with h5py.File(self.folder / "tracks/part_000000000.h5", "w") as file:
            made_up.write_array(file, "id", GRAINS, "1", "id")
            made_up.write_array(file, "time", np.arange(3.0), "s", "time")
            made_up.write_array(file, "position", np.arange(18.0).reshape(3, 2, 3), "m", "time id axis", "x y z")
        (self.folder / "probes").mkdir()
        with h5py.File(self.folder / "probes/part_000000000.h5", "w") as file:
            for n, axis in enumerate("xyz"):
                made_up.write_array(file, f"cell_{axis}", np.array([n, 2 * n]), "1", "point")
            made_up.write_array(file, "time", np.arange(3.0), "s", "time")
            made_up.write_array(file, "pressure", np.arange(6.0).reshape(3, 2), "Pa", "time point")
        (self.folder / "entrainment").mkdir()
        with h5py.File(self.folder / "entrainment/part_000000000.h5", "w") as file:
            for n in (1, 2):
                group = file.create_group(f"event_{n}")
                group.attrs["time"], group.attrs["time_units"], group.attrs["speed"] = float(n), "s", 0.1 * n
                made_up.write_array(file, f"event_{n}/time", np.arange(2.0), "s", "time")
                made_up.write_array(
                    file, f"event_{n}/fluid_torque", np.arange(6.0).reshape(2, 3) * n, "N m", "time axis", "x y z"
                )
        (self.folder / "fluid").mkdir(exist_ok=True)
        self.velocity = np.arange(2 * 3 * 4 * 3.0).reshape(2, 3, 4, 3)
        made_up.write_image(self.folder / "fluid/fluid_0.vti", (0, 4, 0, 3, 0, 2), 0.5, {"velocity": self.velocity})
        made_up.write_index(self.folder / "fluid.pvd", [(0.25, "fluid/fluid_0.vti")])
        self.run_folder = thalweg.Run(self.folder)

    def test_a_wrong_name_says_the_near_ones_and_all(self):
        run = self.run_folder
        for data, name, words in (
            (
                run.series, "qstar",
                r"series\.csv: there is no 'qstar'; did you mean q_star\? There are: time, q_star, bed_stress\.",
            ),
            (run.profiles["fluid_statistics"], "Velocity", r"profiles\.h5/fluid_statistics: .*did you mean velocity"),
            (
                run.profiles, "grain_profile",
                r"There are: fluid_statistics, old, transport_rate\. analysis\.grain_profile in the case",
            ), (run.tracks, "positions", r"tracks: there is no 'positions'; did you mean position\?"),
            (run.entrainment, "event_9", "did you mean event_1 or event_2|did you mean event_2 or event_1"),
            (run.fluid[0].arrays, "xyz", r"fluid_0\.vti: there is no 'xyz'\. There are: velocity\."),
        ):
            with self.assertRaisesRegex(KeyError, words):
                data[name]
            self.assertNotIn(name, data)

    def test_the_names_of_axes(self):
        profiles = self.run_folder.profiles
        self.assertEqual(profiles["fluid_statistics"].dimensions("section_velocity"), ("z", "y", "axis"))
        self.assertEqual(profiles["fluid_statistics"].dimensions("y"), ("y",))
        self.assertEqual(profiles["transport_rate"].dimensions("hop_length_count"), ("hop_length_bin",))
        self.assertEqual(set(profiles["transport_rate"]), {"hop_length_count"})
        self.assertEqual(
            (profiles["old"].dimensions("velocity"), profiles["old"].units["velocity"]), (("velocity_0", "axis"), "m/s")
        )
        self.assertEqual(self.run_folder.tracks.dimensions("position"), ("time", "id", "axis"))
        self.assertEqual(self.run_folder.tracks.dimensions("id"), ("id",))
        self.assertEqual(self.run_folder.probes.dimensions("position"), ("point", "axis"))

    def test_without_the_packages(self):
        for name, call in (
            ("pandas", self.run_folder.series.to_pandas), ("xarray", self.run_folder.fluid[0].to_xarray),
        ):
            with unittest.mock.patch.dict("sys.modules", {name: None}), self.assertRaisesRegex(
                thalweg.RunFolderError, f"pip install {name}"
            ):
                call()

    @unittest.skipUnless(HAS_XARRAY, "needs xarray")
    def test_xarray(self):
        run = self.run_folder
        series = run.series.to_xarray()
        self.assertEqual(float(series.q_star.sel(time=1.0)), 3.0)
        self.assertEqual(series.bed_stress.attrs["units"], "Pa")
        section = run.profiles["fluid_statistics"].to_xarray().section_velocity
        self.assertEqual(float(section.sel(z=2.0, y=3.0, axis="z")), 2 * 15 + 3 * 3 + 2)
        self.assertEqual(float(run.tracks.to_xarray().position.sel(time=1.0, axis="y", id=17)), 6 + 3 + 1)
        self.assertEqual(run.probes.to_xarray().sizes, {"time": 3, "point": 2, "axis": 3})
        self.assertEqual(float(run.entrainment["event_2"].to_xarray().fluid_torque.sel(time=1.0, axis="x")), 6.0)
        grains = run.grains[0].to_xarray()
        self.assertEqual(float(grains.contact_stress.sel(tensor="zx", id=17)), 9 + 6)
        fluid = run.fluid[0].to_xarray()
        self.assertEqual(float(fluid.velocity.sel(z=0.75, y=0.25, x=1.25, axis="y")), self.velocity[1, 0, 2, 1])
        self.assertEqual((fluid.time, fluid.x.attrs["units"], fluid.velocity.attrs["units"]), (0.25, "m", "m/s"))

    @unittest.skipUnless(HAS_PANDAS, "needs pandas")
    def test_pandas(self):
        run = self.run_folder
        series = run.series.to_pandas()
        self.assertEqual(series.loc[1.0, "bed_stress"], 4.0)
        self.assertEqual(series.attrs["units"]["bed_stress"], "Pa")
        profile = run.profiles["fluid_statistics"].to_pandas()
        self.assertEqual(list(profile.columns), ["velocity_x", "velocity_y", "velocity_z"])
        self.assertEqual(profile.loc[2.0, "velocity_y"], 7.0)
        grains = run.grains[1].to_pandas()
        self.assertEqual((grains.loc[17, "position_z"], grains.loc[17, "contact_stress_xy"]), (6.0, 10.0))
        events = run.entrainment.to_pandas()
        self.assertEqual(events.loc["event_2", "speed"], 0.2)
        self.assertEqual(run.entrainment["event_2"].to_pandas().loc[1.0, "fluid_torque_z"], 10.0)
        tracks = run.tracks.to_pandas()
        self.assertEqual(tracks.loc[(1.0, 17), "position_y"], 10.0)
        self.assertEqual(run.fluid[0].to_pandas().loc[(0.75, 0.25, 1.25), "velocity_y"], self.velocity[1, 0, 2, 1])

    @unittest.skipUnless(HAS_PANDAS, "needs pandas")
    def test_profiles_from_frames_are_a_row_for_each_layer(self):
        run = thalweg.Run(self.folder)
        profiles = layer_profiles(run, thickness=run.size[2] / 3)
        frame = profiles.to_pandas()
        np.testing.assert_allclose(frame.index, run.size[2] * np.array([1, 3, 5]) / 6)
        self.assertEqual(frame.index.name, "z")
        for name in ("solid_fraction", "velocity_x", "flux_z", "granular_temperature"):
            self.assertIn(name, frame.columns)
        np.testing.assert_array_equal(frame["flux_z"], profiles["flux"][:, 2])


if __name__ == "__main__":
    unittest.main()
