"""A run folder read into numpy: every kind of file, finished or half written."""
import tracemalloc
import unittest

import h5py
import numpy as np

import made_up_folder as made_up
import thalweg
from thalweg import film, layers
from thalweg.vtk_files import read_image, read_points, read_triangles


def raw(writer):
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()


def uncompressed(writer):
    raw(writer)
    writer.SetCompressorTypeToNone()


def plain_base64(writer):
    writer.SetCompressorTypeToNone()


def wide_headers(writer):
    raw(writer)
    writer.SetHeaderTypeToUInt64()


def small_blocks(writer):
    writer.SetBlockSize(4096)   # many blocks an array



def peak_of(call):
    """The most memory (bytes) of Python's and numpy's objects that a call takes at a time, and what it returns."""
    tracemalloc.start()
    try:
        result = call()
        return tracemalloc.get_traced_memory()[1], result
    finally:
        tracemalloc.stop()


class VtkFiles(made_up.MadeUpFolder):
    def test_points_by_every_encoding(self):
        generator = np.random.default_rng(1)
        places, stress = generator.normal(size=(700, 3)), generator.normal(size=(700, 9))
        number = generator.integers(0, 1 << 40, 700)
        for adapt in (lambda writer: None, raw, uncompressed, plain_base64, wide_headers, small_blocks):
            path = self.folder / "points.vtp"
            made_up.write_points(path, places, {"id": number, "contact_stress": stress}, adapt)
            position, arrays = read_points(path)
            np.testing.assert_array_equal(position, places)
            np.testing.assert_array_equal(arrays["id"], number)
            np.testing.assert_array_equal(arrays["contact_stress"], stress)

    def test_an_array_in_the_wrong_format_is_refused(self):
        path = self.folder / "points.vtp"
        made_up.write_points(path, np.zeros((1, 3)), {}, lambda writer: writer.SetDataModeToAscii())
        with self.assertRaisesRegex(thalweg.RunFolderError, "only appended is read"):
            read_points(path)

    def test_a_file_that_ends_too_soon_is_said_in_a_sentence(self):
        points, image = self.folder / "points.vtp", self.folder / "image.vti"
        made_up.write_points(points, np.ones((100, 3)), {"id": np.arange(100)})
        made_up.write_image(image, (0, 9, 0, 9, 0, 9), 0.5, {"pressure": np.arange(729.0).reshape(9, 9, 9)})
        for path, read in ((points, read_points), (points, read_triangles), (image, read_image)):
            whole = path.read_bytes()
            start = whole.index(b"<AppendedData")
            for length in (40, start // 2, start + 60, start + 90):
                path.write_bytes(whole[:length])
                with self.assertRaisesRegex(thalweg.RunFolderError, f"{path.name} is damaged"):
                    read(path)
            path.write_bytes(whole)
        made_up.write_points(points, np.ones((100, 3)), {"id": np.arange(100)}, uncompressed)
        whole = points.read_bytes()
        for rest in range(600, 624):   # bytes that are missing, in the middle of the positions
            points.write_bytes(whole[:-rest])
            with self.assertRaisesRegex(thalweg.RunFolderError, "points.vtp is damaged"):
                read_points(points)

    def test_an_image_and_its_pieces(self):
        generator = np.random.default_rng(2)
        velocity = generator.normal(size=(4, 2, 6, 3)).astype(np.float32)
        pressure = generator.normal(size=(4, 2, 6)).astype(np.float32)
        whole = {"velocity": velocity, "pressure": pressure}
        made_up.write_image(self.folder / "whole.vti", (0, 6, 3, 5, 0, 4), 0.5, whole, raw)
        for name, first, last in (("left", 0, 4), ("right", 4, 6)):
            made_up.write_image(self.folder / f"{name}.vti", (first, last, 3, 5, 0, 4), 0.5,
                                {key: values[:, :, first:last] for key, values in whole.items()})
        (self.folder / "both.pvti").write_text(
            '<VTKFile type="PImageData"><PImageData WholeExtent="0 6 3 5 0 4" Origin="0 0 0" Spacing="0.5 0.5 0.5">'
            '<Piece Extent="0 4 3 5 0 4" Source="left.vti"/><Piece Extent="4 6 3 5 0 4" Source="right.vti"/>'
            "</PImageData></VTKFile>")
        for name in ("whole.vti", "both.pvti"):
            corner, spacing, arrays = read_image(self.folder / name)
            np.testing.assert_array_equal(corner, (0.0, 1.5, 0.0))
            np.testing.assert_array_equal(spacing, (0.5, 0.5, 0.5))
            np.testing.assert_array_equal(arrays["velocity"], velocity)
            np.testing.assert_array_equal(arrays["pressure"], pressure)


class RunFolder(made_up.MadeUpFolder):
    def test_means_that_a_restart_has_begun_anew_while_the_run_is_going(self):
        # There is no summary.json yet; the case says from = 0 by default.
        (self.folder / "run.log").write_text(
            "Thalweg 0.1.0 (abc): first\nresolved on 1 rank\n"
            "Thalweg 0.1.0 (abc): again\nresolved on 1 rank\nresuming from run/checkpoints/step_9.h5 at 2.5 s\n"
            "analysis.transport_rate: averaging starts at 2.5 s\n")
        run = thalweg.Run(self.folder)
        self.assertEqual(run.averaged_from("transport_rate"), 2.5)
        self.assertEqual(run.averaged_from("stress_balance"), 0.0)
        (self.folder / "summary.json").write_text('{"transport_rate": {"mean_from": 3.0}}')
        self.assertEqual(thalweg.Run(self.folder).averaged_from("transport_rate"), 3.0)

    def test_the_case_as_numbers(self):
        run = thalweg.Run(self.folder)
        self.assertEqual(run.case["fluid"]["kinematic_viscosity"], 1e-6)   # written 1e-06
        self.assertEqual(run.name, "Made up")
        self.assertEqual(run.periodic, (True, False, False))
        self.assertEqual(run.faces("y"), ("law_of_the_wall", "law_of_the_wall"))
        self.assertEqual(run.faces("z"), ("no_slip", "free_slip"))
        self.assertEqual(run.side_walls, 2)
        self.assertEqual(run.diameter, 4.95e-3)
        self.assertAlmostEqual(run.density_ratio, 2.55, 12)
        self.assertAlmostEqual(run.slope, 0.0748, 12)
        self.assertAlmostEqual(np.linalg.norm(run.gravity), 9.8, 12)

    def with_case(self, old, new):
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace(old, new))
        return thalweg.Run(self.folder)

    def test_the_reference_grain_does_not_depend_on_the_order_of_the_populations(self):
        fixed, small = (
            "{count: 50, diameter: 9e-3, density: 5000, fixed: true}", "{count: 60, diameter: 1e-3, density: 2000}",
        )
        large, before = "{count: 8, diameter: 2e-3, density: 3000}", "[{count: 969, diameter: 4.95e-3, density: 2550}]"
        for order in ((fixed, small, large), (large, small, fixed), (small, fixed, large)):
            now = "[" + ", ".join(order) + "]"
            run = self.with_case(before, now)
            before = now
            # Volumes are as 60 to 64: half of it is finer than 2 mm, and the mean density is (60 * 2000 + 64 *
            # 3000)/124.
            self.assertEqual(run.diameter, 2e-3)
            self.assertAlmostEqual(run.density_ratio, 312.0 / 124.0, 12)

    def test_the_reference_grain_of_disks_is_by_their_area(self):
        two_sizes = "[{count: 5, diameter: 1e-3, density: 2000}, {count: 2, diameter: 1.4e-3, density: 3000}]"
        run = self.with_case("[{count: 969, diameter: 4.95e-3, density: 2550}]", two_sizes)
        # Volumes are as 5 to 5.488, areas as 5 to 3.92.
        self.assertEqual(run.diameter, 1.4e-3)
        self.assertAlmostEqual(run.density_ratio, (5 * 2.0 + 5.488 * 3.0) / 10.488, 12)
        run = self.with_case("grains:", "disks: {thickness: 1e-3}\ngrains:")
        self.assertEqual(run.diameter, 1e-3)
        self.assertAlmostEqual(run.density_ratio, (5 * 2.0 + 3.92 * 3.0) / 8.92, 12)

    def test_the_reference_grain_is_the_one_in_the_series(self):
        (self.folder / "series.csv").write_text(
            "time [s],reference_diameter [m],reference_density [kg/m^3]\n0,3e-3,2650\n"
        )
        run = thalweg.Run(self.folder)
        self.assertEqual(run.diameter, 3e-3)
        self.assertAlmostEqual(run.density_ratio, 2.65, 12)

    def test_what_drives_the_fluid(self):
        self.assertTrue(thalweg.Run(self.folder).driven_by_slope)
        self.assertFalse(self.with_case("top: free_slip", "top: {type: moving, velocity: [0.1, 0, 0]}").driven_by_slope)
        self.assertFalse(
            self.with_case("fluid: {density", "fluid: {mean_velocity: {velocity: 0.1}, density").driven_by_slope
        )

    def test_side_walls_that_move_drive_the_fluid_where_they_move_along_it(self):
        along, across = ("y: {type: moving, velocity: [0.1, 0, 0]}", "y: {type: moving, velocity: [0, 0, 0.1]}")
        self.assertFalse(self.with_case("y: {type: law_of_the_wall}", along).driven_by_slope)
        self.assertTrue(self.with_case(along, across).driven_by_slope)

    def test_a_flow_through_open_faces_or_without_a_slope_is_not_driven_by_it(self):
        inlet = "x_low: {type: velocity_inlet, velocity: [0.1, 0, 0]}, x_high: pressure_outlet"
        self.assertFalse(self.with_case("x: periodic", inlet).driven_by_slope)
        self.assertTrue(self.with_case(inlet, "x: periodic").driven_by_slope)
        self.assertFalse(self.with_case("x: periodic", "x: no_slip").driven_by_slope)   # a closed tank
        self.assertTrue(self.with_case("x: no_slip", "x: periodic").driven_by_slope)
        self.assertFalse(self.with_case("slope: 0.0748", "slope: 0").driven_by_slope)
        upstream = self.with_case("slope: 0", "slope: -0.02")
        self.assertTrue(upstream.driven_by_slope)
        self.assertAlmostEqual(upstream.slope, -0.02, 12)

    def test_gravity_along_the_bed_alone_is_no_slope(self):
        run = self.with_case("{magnitude: 9.8, slope: 0.0748}", "{vector: [0.5, 0, 0]}")
        self.assertFalse(run.driven_by_slope)
        with self.assertRaisesRegex(thalweg.RunFolderError, "no slope"):
            run.slope

    def test_a_run_without_a_series_says_why(self):
        (self.folder / "series.csv").unlink(missing_ok=True)
        case = self.folder / "case.yaml"
        case.write_text(case.read_text() + "output: {series: {every: 0}}\n")
        with self.assertRaisesRegex(thalweg.RunFolderError, "output.series.every: 0"):
            thalweg.Run(self.folder).series

    def test_side_walls_are_counted(self):
        for faces, count in (
            ("y_low: no_slip, y_high: free_slip", 1), ("y: free_slip", 0), ("y: periodic", 0),
            ("y: {type: slip_law_of_the_wall, of_first_cell: true}", 2),
            ("y_low: {type: navier_slip, slip_length: 1e-3}, y_high: {type: moving, velocity: [1, 0, 0]}", 2),
        ):
            case = self.folder / "case.yaml"
            case.write_text(made_up.CASE.replace("y: {type: law_of_the_wall}", faces))
            self.assertEqual(thalweg.Run(self.folder).side_walls, count, faces)

    def test_the_series_with_its_units(self):
        (self.folder / "series.csv").write_text("time [s],fast_cell_fraction [1],q_s [m^2/s],nothing\n"
                                                "0,0,1e-3,5\n0.5,1,2e-3,6\n")
        series = thalweg.Run(self.folder).series
        np.testing.assert_array_equal(series["q_s"], (1e-3, 2e-3))
        self.assertEqual(series.units, {"time": "s", "fast_cell_fraction": "1", "q_s": "m^2/s", "nothing": "1"})

    def test_a_row_that_is_being_written_does_not_count(self):
        for rest in ("1.0,", "1.0,0.0", "1.0,0.04"):   # the row will be 1.0,0.042
            (self.folder / "series.csv").write_text("time [s],q_star [1]\n0,1\n0.5,2\n" + rest)
            series = thalweg.Run(self.folder).series
            np.testing.assert_array_equal(series["time"], (0.0, 0.5), rest)
            np.testing.assert_array_equal(series["q_star"], (1.0, 2.0), rest)

    def test_damaged_text_is_said_in_a_sentence(self):
        series = self.folder / "series.csv"
        for damage, words in ((b"0,1\n0.5x,2\n", "damaged: could not convert string to float: '0.5x'"),
                              (b"0,\xff\n", "damaged: could not convert"), (b"0\n1,2,3\n", "no measurement in it yet")):
            series.write_bytes(b"time [s],q_star [1]\n" + damage)
            with self.assertRaisesRegex(thalweg.RunFolderError, words):
                thalweg.Run(self.folder).series
        for damage in (b"", b"a: [1, 2\n", b"\xff\n", b"- 1\n"):
            (self.folder / "case.yaml").write_bytes(damage)
            with self.assertRaisesRegex(thalweg.RunFolderError, "case.yaml is damaged"):
                thalweg.Run(self.folder).case

    def test_what_is_not_there_yet(self):
        run = thalweg.Run(self.folder)
        self.assertEqual(len(run.grains), 0)
        self.assertEqual(len(run.fluid), 0)
        self.assertIsNone(run.grains.nearest(None))
        self.assertEqual(run.profiles, {})
        self.assertIsNone(run.summary)
        self.assertIsNone(run.latest_checkpoint)
        with self.assertRaisesRegex(thalweg.RunFolderError, "is this the folder of a run"):
            run.series
        (self.folder / "series.csv").write_text("time [s],q_star [1]\n")
        with self.assertRaisesRegex(thalweg.RunFolderError, "no measurement in it yet"):
            thalweg.Run(self.folder).series
        with self.assertRaisesRegex(thalweg.RunFolderError, "no case.yaml"):
            thalweg.Run(self.folder / "grains")

    def write_part(self, path, times, places):
        """A file of the tracks of grains 3 and 17."""
        path.parent.mkdir(exist_ok=True)
        with h5py.File(path, "w") as file:
            for name, values, unit in (
                ("id", np.array([3, 17]), "1"), ("time", np.array(times, float), "s"),
                ("position", np.array(places, float), "m"), ("velocity", -np.array(places, float), "m/s"),
            ):
                file.create_dataset(name, data=values).attrs["unit"] = unit
            file["position"].attrs["components"] = "x y z"

    def test_tracks(self):
        """Parts in the order of their numbers, behind the single file of an older version, of which a restart has
        outdated a row."""
        with self.assertRaisesRegex(
            thalweg.RunFolderError, r"it has no tracks because its case has no analysis\.tracks, which records them"
        ):
            thalweg.Run(self.folder).tracks
        places = np.arange(90.0).reshape(15, 2, 3)
        self.write_part(self.folder / "tracks/part_000000000.h5", [], np.zeros((0, 2, 3)))
        self.write_part(self.folder / "tracks/part_000000009.h5", np.arange(3, 9), places[3:9])
        self.write_part(self.folder / "tracks/part_1000000000.h5", np.arange(9, 15), places[9:])
        self.assertEqual(len(thalweg.Run(self.folder).tracks["time"]), 12)
        self.write_part(self.folder / "tracks.h5", np.arange(4), np.append(places[:3], [[[7, 7, 7]] * 2], 0))
        tracks = thalweg.Run(self.folder).tracks
        np.testing.assert_array_equal(tracks["id"], (3, 17))
        np.testing.assert_array_equal(tracks["time"], np.arange(15))
        np.testing.assert_array_equal(tracks["position"], places)
        np.testing.assert_array_equal(dict(tracks)["velocity"], -places)
        self.assertEqual(tracks.units, {"id": "1", "time": "s", "position": "m", "velocity": "m/s"})
        self.assertEqual(tracks.components, {"position": ["x", "y", "z"]})
        self.assertIn("position [m] (15, 2, 3)", repr(tracks))
        self.assertNotIn("force", tracks)
        (self.folder / "tracks/part_000000009.h5").write_bytes(b"damaged")
        with self.assertRaisesRegex(
            thalweg.RunFolderError, "part_000000009.h5 cannot be read: a restart has replaced it"
        ):
            thalweg.Run(self.folder).tracks

    def test_of_tracks_only_what_is_asked_for_is_read(self):
        for part in range(20):
            self.write_part(
                self.folder / f"tracks/part_{part}.h5", 1000 * part + np.arange(1000), np.zeros((1000, 2, 3))
            )
        peak, tracks = peak_of(lambda: thalweg.Run(self.folder).tracks)
        self.assertLess(peak, 1e6)   # the times are 160 kB
        peak, position = peak_of(lambda: tracks["position"])
        self.assertEqual(position.nbytes, 960000)
        self.assertLess(peak, 1.3 * position.nbytes)   # it, and a part

    def test_entrainment(self):
        (self.folder / "case.yaml").write_text(made_up.CASE.replace("analysis: {", "analysis: {entrainment: {}, "))
        with self.assertRaisesRegex(
            thalweg.RunFolderError, "it has no entrainment yet; they are written with the first checkpoint"
        ):
            thalweg.Run(self.folder).entrainment
        (self.folder / "entrainment").mkdir()
        for part, events in (
            (0, ()), (5, ((8, 0.4), (9, 0.1))), (9, ((8, 0.7), (9, 0.8))),
        ):  # the last part watched otherwise
            with h5py.File(self.folder / f"entrainment/part_{part}.h5", "w") as file:
                for number, time in events:
                    group = file.create_group(f"event_00000{number}")
                    group.attrs["time"], group.attrs["time_unit"] = time, "s"
                    group.create_dataset("fluid_force", data=[time, 2 * time]).attrs["unit"] = "N"
        events = thalweg.Run(self.folder).entrainment
        self.assertEqual(
            [(name, event.attributes) for name, event in events.items()],
            [
                ("event_000009", {"time": 0.1}), ("event_000008", {"time": 0.4}), ("event_000010", {"time": 0.7}),
                ("event_000011", {"time": 0.8}),
            ],
        )
        np.testing.assert_array_equal(events["event_000011"]["fluid_force"], (0.8, 1.6))
        self.assertEqual(events["event_000011"].units, {"fluid_force": "N"})

    def test_an_index_whose_end_is_being_written(self):
        self.write_frames((0.0, 0.1, 0.2), np.zeros((3, 2, 3)))
        path = self.folder / "grains.pvd"
        whole = path.read_text()
        for torn in (
            whole[:-30], whole[: whole.rindex("grains_2")], whole[: whole.rindex("grains_2")] + "ion></VTKFile>",
        ):
            path.write_text(torn)
            self.assertEqual(list(thalweg.Run(self.folder).grains.times), [0.0, 0.1, 0.2][:torn.count("/>")])
        path.write_text(whole[:40] + "<" + whole[40:])
        with self.assertRaisesRegex(thalweg.RunFolderError, "grains.pvd is damaged; a restart"):
            thalweg.Run(self.folder).grains

    def test_a_frame_is_not_held_twice(self):
        values = np.random.default_rng(1).random((60, 50, 40))
        made_up.write_image(
            self.folder / "fluid/a.vti", (0, 40, 0, 50, 0, 60), 1e-3, {"pressure": values, "density": values}, raw
        )
        peak, image = peak_of(lambda: read_image(self.folder / "fluid/a.vti"))
        np.testing.assert_array_equal(image[2]["pressure"], values)
        self.assertLess(peak, 2.5 * values.nbytes)   # two arrays, and a block on its way into them

    def test_a_film_holds_one_frame_at_a_time(self):
        def look_at_all(count):
            run = thalweg.Run(self.folder)
            frames = film.chosen_frames(run, stop=0.1 * count - 0.05)
            film.scales(run, frames)   # of a dozen of them
            return sum(len(frame.velocity) == len(places) for frame in frames)
        places = np.random.default_rng(1).random((2000, 3))
        self.write_frames(0.1 * np.arange(96), 96 * [places], velocity=96 * [places])
        few, many = (peak_of(lambda: look_at_all(count)) for count in (24, 96))
        self.assertEqual((few[1], many[1]), (24, 96))
        self.assertLess(many[0], few[0] + 3 * places.nbytes)   # of 72 frames more

    def test_frames_of_grains(self):
        places = np.arange(18.0).reshape(3, 2, 3)
        stress = np.arange(54.0).reshape(3, 2, 9)
        self.write_frames((0.0, 0.1, 0.2), places, velocity=10 * places, contact_stress=stress)
        grains = thalweg.Run(self.folder).grains
        self.assertEqual(len(grains), 3)
        np.testing.assert_array_equal(grains.times, (0.0, 0.1, 0.2))
        self.assertEqual(grains.nearest(0.13).time, 0.1)
        self.assertEqual(grains.nearest(None).time, 0.2)
        self.assertEqual([frame.time for frame in grains.between(0.05)], [0.1, 0.2])
        self.assertEqual([frame.time for frame in grains[:2]], [0.0, 0.1])
        frame = grains[-1]
        np.testing.assert_array_equal(frame.position, places[2])
        np.testing.assert_array_equal(frame.velocity, 10 * places[2])
        self.assertEqual(frame.contact_stress[1, 0, 2], stress[2, 1, 2])   # xz: the force's component first
        self.assertEqual(frame.arrays.units["contact_stress"], "Pa")
        np.testing.assert_allclose(frame.volume, np.pi / 6 * frame.diameter**3, rtol=1e-15)
        self.assertFalse(hasattr(frame, "fluid_stress"))
        with self.assertRaisesRegex(thalweg.RunFolderError, "the frame has no fluid_stress"):
            frame.fluid_stress

    def test_the_volume_of_disks(self):
        """Their layers hold as much."""
        places = np.column_stack([0.01 + 0.005 * np.arange(8), np.full(8, 5e-3), 0.02 + 0.002 * np.arange(8)])
        self.write_frames((0.0,), [places])
        run = self.with_case("grains:", "disks: {thickness: 2e-3}\ngrains:")
        frame = run.grains[0]
        np.testing.assert_allclose(frame.volume, np.pi * frame.radius**2 * 2e-3, rtol=1e-15)
        profiles = layers.layer_profiles(run, thickness=2.475e-3)   # sixty layers
        of_layer = run.size[0] * 2e-3 * run.size[2] / len(profiles["z"])
        self.assertAlmostEqual(profiles["solid_fraction"].sum() * of_layer / frame.volume.sum(), 1.0, 12)

    def test_a_part_of_the_grains_may_show_none(self):
        (self.folder / "grain_parts/tracers").mkdir(parents=True)
        for n, count in enumerate((2, 0)):
            arrays = {
                "radius": np.full(count, 1e-3), "contact_stress": np.ones((count, 9)),
                "orientation": np.ones((count, 4)),
            }
            made_up.write_points(self.folder / f"grain_parts/tracers/{n}.vtp", np.zeros((count, 3)), arrays)
        made_up.write_index(self.folder / "grain_parts/tracers.pvd", [(0.1 * n, f"tracers/{n}.vtp") for n in (0, 1)])
        frames = thalweg.Run(self.folder).grain_part("tracers")
        self.assertEqual([len(frame) for frame in frames], [2, 0])
        self.assertEqual(frames[0].contact_stress.shape, (2, 3, 3))
        self.assertEqual(frames[0].arrays.units["orientation"], "1")
        with self.assertRaisesRegex(KeyError, "no 'others'"):
            thalweg.Run(self.folder).grain_part("others")
        self.write_frames((0.0,), [np.zeros((0, 3))])
        self.assertEqual(thalweg.Run(self.folder).grains[0].position.shape, (0, 3))   # all have left

    def test_a_grain_on_its_way(self):
        places = np.arange(18.0).reshape(3, 2, 3)
        self.write_frames((0.0, 0.1, 0.2), places, velocity=10 * places)
        from thalweg.frames import trajectory
        times, positions, velocities = trajectory(thalweg.Run(self.folder).grains, 1)
        np.testing.assert_array_equal(times, (0.0, 0.1, 0.2))
        np.testing.assert_array_equal(positions, places[:, 1])
        np.testing.assert_array_equal(velocities, 10 * places[:, 1])

    def test_a_slice_of_the_fluid(self):
        pressure = np.arange(24.0, dtype=np.float32).reshape(4, 1, 6)
        made_up.write_image(self.folder / "fluid/fluid_0.vti", (0, 6, 3, 4, 0, 4), 0.5, {"pressure": pressure})
        made_up.write_index(self.folder / "fluid.pvd", [(0.5, "fluid/fluid_0.vti")])
        frame = thalweg.Run(self.folder).fluid[0]
        np.testing.assert_array_equal(frame.arrays["pressure"], pressure)
        self.assertEqual(frame.arrays.units["pressure"], "Pa")
        np.testing.assert_array_equal(frame.centres(1), (1.75,))
        np.testing.assert_array_equal(frame.centres(2), (0.25, 0.75, 1.25, 1.75))
        np.testing.assert_array_equal(frame.centres("z"), frame.centres(2))

    def test_profiles_with_units_and_components(self):
        with h5py.File(self.folder / "profiles.h5", "w") as file:
            data = file.create_dataset("grain_profiles/velocity", data=np.ones((4, 3)))
            data.attrs["unit"], data.attrs["components"] = "m/s", "x y z"
        group = thalweg.Run(self.folder).profiles["grain_profiles"]
        self.assertEqual(group["velocity"].shape, (4, 3))
        self.assertEqual(group.units["velocity"], "m/s")
        self.assertEqual(group.components["velocity"], ["x", "y", "z"])

    def test_a_damaged_file_is_said_in_a_sentence(self):
        for name in ("tracks", "probes", "profiles", "bed"):
            path = self.folder / f"{name}.h5"
            with h5py.File(path, "w") as file:
                file["time"] = np.arange(1000.0)
            whole = path.read_bytes()
            for content in (b"", b"no HDF5", whole[:len(whole) // 2], whole[:8] + b"\xa5" * 200 + whole[208:]):
                path.write_bytes(content)
                with self.assertRaisesRegex(thalweg.RunFolderError, f"{name}.h5 cannot be read: .* restart the run"):
                    getattr(thalweg.Run(self.folder), name)

    def test_the_bed_at_the_end(self):
        self.assertIsNone(thalweg.Run(self.folder).bed)
        with h5py.File(self.folder / "bed.h5", "w") as file:
            file["grains/radius"] = np.array([1.0, 2.0])
            file["grains/radius"].attrs["unit"] = "m"
        bed = thalweg.Run(self.folder).bed
        np.testing.assert_array_equal(bed["radius"], (1.0, 2.0))
        self.assertEqual(bed.units, {"radius": "m"})


if __name__ == "__main__":
    unittest.main()
