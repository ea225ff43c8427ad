"""thalweg plot all draws a run folder, and says in one sentence what is wrong with one it cannot draw."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import h5py
import matplotlib.image
import matplotlib.pyplot
import numpy as np
from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/support")]
import made_up_folder  # noqa: E402
import made_up_profiles  # noqa: E402
import made_up_run  # noqa: E402
import thalweg  # noqa: E402
from thalweg import drawing, height_profiles, transport  # noqa: E402
from thalweg.figures import overview, scene, transport_rate  # noqa: E402

# Stands in for ffmpeg: the size of a frame follows -s; what arrives is counted into the film.
FFMPEG = """#!{python}
import sys
width, height = map(int, sys.argv[sys.argv.index("-s") + 1].split("x"))
frames, rest = divmod(len(sys.stdin.buffer.read()), 3 * width * height)
open(sys.argv[-1], "w").write(f"{{frames}} frames and {{rest}} bytes")
"""


class Plot(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name) / "run"
        self.grains = made_up_run.write_run(self.folder)

    def plot(self, *options, kind="all", **environment):
        return subprocess.run(
            [sys.executable, "-B", "-m", "thalweg", "plot", kind, self.folder, *options], text=True,
            capture_output=True, env={**os.environ, "PYTHONPATH": str(ROOT / "python"), **environment},
        )

    def film(self, out, **environment):
        return self.plot("--out", out, kind="film", **environment)

    def assert_drawn(self, path):
        """A picture of more than 400 pixels each way and of more than ten colours."""
        pixels = matplotlib.image.imread(path)
        self.assertGreater(min(pixels.shape[:2]), 400)
        self.assertGreater(len(np.unique((pixels * 15).astype(int).reshape(-1, pixels.shape[2]), axis=0)), 10)

    def test_draws_both_pictures_and_names_them(self):
        done = self.plot()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        names = [self.folder / "bed.png", self.folder / "transport_rate.png"]
        self.assertEqual(done.stdout.split(), [str(name) for name in names])
        for name in names:
            self.assert_drawn(name)

    def test_profiles_of_a_bed(self):
        profiles, case = self.folder / "profiles.h5", self.folder / "case.yaml"
        case.write_text(case.read_text() + "fluid: {density: 1000}\ngravity: {magnitude: 9.8, slope: 0.06}\n"
                        f"grains: [{{diameter: {made_up_run.DIAMETER}, density: 2550}}]\n")
        for write in (made_up_profiles.write_grain_profiles, made_up_profiles.add_stress_balance):
            write(profiles, made_up_run.DIAMETER)
            done = self.plot()
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout.split()[-1], str(self.folder / "profiles.png"))
            self.assert_drawn(self.folder / "profiles.png")
        figure = height_profiles.figure_of(thalweg.Run(self.folder))
        labels = [[line.get_label() for line in axes.lines] for axes in figure.axes]
        self.assertEqual(labels[1][:2], ["grains", "fluid"])
        for label in (
            "lubrication correction", "total", "driving", "driving less side walls",
            r"$\rho\, g \sin\alpha\, (z_{top} - z)$",
        ):
            self.assertIn(label, labels[2])
        # The weight of the water alone: rho g sin(alpha) times the height of the box at the floor, nothing at the top.
        line = figure.axes[2].lines[labels[2].index(r"$\rho\, g \sin\alpha\, (z_{top} - z)$")]
        weight = 9800.0 * np.sin(np.arctan(0.06)) * made_up_run.CELLS[2] * made_up_run.SPACING
        np.testing.assert_allclose(line.get_xdata(), (weight, 0.0), rtol=1e-12)
        # The surface of six diameters of bed in layers of half a diameter.
        np.testing.assert_allclose(line.get_ydata()[0], -6.0, atol=0.01)

    def test_profiles_of_grains_and_fluid_from_different_times_tell_them(self):
        profiles, case = self.folder / "profiles.h5", self.folder / "case.yaml"
        made_up_profiles.write_grain_profiles(profiles, made_up_run.DIAMETER)
        with h5py.File(profiles, "a") as file:
            group = file.create_group("fluid_statistics")
            group["z"] = file["grain_profiles/z"][()]
            made_up_profiles.add_ones(group, {"velocity": "x y z", "reynolds_stress": made_up_profiles.HALF}, 30)
        text = case.read_text() + ("fluid: {density: 1000}\ngravity: {magnitude: 9.8, slope: 0.06}\n"
                                   f"grains: [{{diameter: {made_up_run.DIAMETER}, density: 2550}}]\n")
        for begin, grains, fluid in (("1", "", ""), ("2.5", ", from 1 s on", ", from 2.5 s on")):
            observers = f"grain_profiles: {{from: 1}}, fluid_statistics: {{from: {begin}}}"
            case.write_text(text.replace("{transport_rate: {from: 1.0}}", f"{{{observers}}}"))
            figure = height_profiles.figure_of(thalweg.Run(self.folder))
            self.addCleanup(matplotlib.pyplot.close, figure)
            labels = [[line.get_label() for line in axes.lines] for axes in figure.axes]
            self.assertEqual(labels[1][:2], [f"grains{grains}", f"fluid{fluid}"])
            self.assertIn(f"fluid: resolved eddies{fluid}", labels[2])

    def test_profiles_that_have_not_begun_are_left_out(self):
        made_up_profiles.write_grain_profiles(self.folder / "profiles.h5", made_up_run.DIAMETER)
        with h5py.File(self.folder / "profiles.h5", "a") as file:
            file["grain_profiles/solid_fraction"][...] = 0.0
        done = self.plot()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertFalse((self.folder / "profiles.png").exists())

    def test_a_film_has_every_frame(self):
        film = self.folder / "films" / "film.gif"
        done = self.film(film)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.split()[-1], str(film))
        with Image.open(film) as pictures:
            self.assertEqual(pictures.n_frames, 2)
            sizes, colours = set(), []
            for number in range(pictures.n_frames):
                pictures.seek(number)
                sizes.add(pictures.size)
                colours.append(len(set(pictures.convert("RGB").getdata())))
        self.assertEqual(len(sizes), 1)
        self.assertGreater(min(colours), 10)

    def test_a_film_of_a_fluid_alone(self):
        (self.folder / "grains.pvd").unlink()
        case = self.folder / "case.yaml"
        case.write_text("system: fluid\n" + case.read_text())
        self.assertEqual(self.film(self.folder / "film").returncode, 0)
        self.assertEqual(len(list((self.folder / "film").glob("*.png"))), 1)

    def test_a_film_by_ffmpeg(self):
        ffmpeg, film = self.folder / "bin" / "ffmpeg", self.folder / "film.mp4"
        ffmpeg.parent.mkdir()
        done = self.film(film, PATH=str(ffmpeg.parent))
        self.assertEqual(done.returncode, 2)
        self.assertIn("ffmpeg is not installed", done.stderr)
        ffmpeg.write_text(FFMPEG.format(python=sys.executable))
        ffmpeg.chmod(0o755)
        done = self.film(film, PATH=str(ffmpeg.parent))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(film.read_text(), "2 frames and 0 bytes")
        ffmpeg.write_text("#!/bin/sh\nexit 7\n")   # before it has read a frame
        done = self.film(film, PATH=str(ffmpeg.parent))
        self.assertEqual(done.returncode, 2)
        self.assertIn("ffmpeg ended with exit code 7", done.stderr)

    def test_draws_a_fluid_alone(self):
        case = self.folder / "case.yaml"
        text = case.read_text().replace("transport_rate: {from: 1.0}", "fluid_statistics: {from: 0}")
        case.write_text("system: fluid\n" + text)
        z = np.linspace(0.0, 0.07, 20)
        with h5py.File(self.folder / "profiles.h5", "w") as file:
            file["fluid_statistics/z"] = z
            file["fluid_statistics/velocity"] = np.stack([z, 0 * z, 0 * z], axis=1)
            file["fluid_statistics/reynolds_stress"] = np.outer(z, np.arange(6))
        done = self.plot()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.split(), [str(self.folder / name) for name in ("flow.png", "profiles.png")])

    def test_the_slice_behind_the_grains(self):
        flow, box, solid = drawing.fluid_slice(thalweg.Run(self.folder).fluid[0])
        self.assertFalse(solid.any())
        self.assertEqual(flow.shape, (90, 72))
        self.assertEqual(flow.mask.sum(), 40)
        self.assertTrue(flow.mask[0, :40].all())
        np.testing.assert_allclose(box, (0, 72 * made_up_run.SPACING, 0, 90 * made_up_run.SPACING), rtol=1e-12)

    def test_the_slice_tells_solids_from_grains(self):
        class Frame:   # one row: water, a grain, and the second solid
            arrays = {"velocity": np.ones((2, 1, 3, 3)), "grain_id": np.array([[[-1, 5, -3]], [[-1, -1, -3]]])}
            corner, spacing = np.zeros(3), np.ones(3)
        flow, _, solid = drawing.fluid_slice(Frame)
        self.assertEqual(flow.mask.tolist(), [[False, True, True], [False, False, True]])
        self.assertEqual(solid.tolist(), [[False, False, True], [False, False, True]])

    def test_a_sphere_covers_its_disk(self):
        # Radius 20 pixels about the middle of the image; the error of counting pixels is below their border, 2 pi r.
        image = drawing.render_spheres(np.array([[0.5, 0.0, 0.5]]), np.array([0.2]), np.array([1.0]),
                                        np.array([0.0, 1.0, 0.0, 1.0]), 100.0, lambda v: v)
        self.assertLess(abs(image[..., 3].sum() - np.pi * 20**2), 2 * np.pi * 20 / 4)
        self.assertEqual(image[50, 50, 3], 1.0)
        self.assertEqual(image[50, 20, 3], 0.0)

    def test_the_nearer_of_two_spheres_is_seen(self):
        extent, place = np.array([0.0, 1.0, 0.0, 1.0]), lambda y: [0.5, y, 0.5]
        radius = np.array([0.2, 0.2])
        alone = drawing.render_spheres(np.array([place(0.1)]), radius[:1], np.array([0.9]), extent, 100.0, lambda v: v)
        for order in (slice(None), slice(None, None, -1)):
            both = drawing.render_spheres(np.array([place(0.1), place(0.6)])[order], radius,
                                           np.array([0.9, 0.1])[order], extent, 100.0, lambda v: v)
            np.testing.assert_array_equal(both, alone)

    def test_a_grain_in_a_corner_of_a_periodic_box_is_seen_in_all(self):
        size, corner = np.array([1.0, 2.0, 3.0]), np.array([[0.1, 1.0, 2.9]])
        for periodic, places in (((True, True, True), 4), ((True, True, False), 2), ((False, True, False), 1)):
            position, radius, speed = drawing.with_periodic_images(corner, np.array([0.2]), np.array([5.0]), size, periodic)
            self.assertEqual((len(position), set(radius), set(speed)), (places, {0.2}, {5.0}))
            self.assertEqual(len(np.unique(position, axis=0)), places)
        np.testing.assert_allclose((position - corner) % size, 0.0)

    def test_holes_take_the_mean_of_their_neighbours(self):
        layer = np.ma.array([[1.0, 2.0, 3.0, 4.0, 5.0]] * 5, mask=np.zeros((5, 5), bool))
        layer[2, 2] = np.ma.masked
        filled = drawing.without_holes(layer)
        np.testing.assert_allclose(filled, [[1.0, 2.0, 3.0, 4.0, 5.0]] * 5, atol=1e-15)
        layer.mask[:] = True
        self.assertEqual(drawing.without_holes(layer).shape, (5, 5))
        # The lowest layer of cells is not beside the highest, nor the first column beside the last.
        layer = np.ma.array(np.ones((5, 5)), mask=False)
        layer[-1], layer[:, -1] = 9.0, 5.0
        layer[0, :2] = layer[1, 0] = np.ma.masked
        np.testing.assert_array_equal(drawing.without_holes(layer)[:2, :2], 1.0)

    def test_figures_of_a_case_in_grain_units(self):
        (self.folder / "fluid.pvd").unlink()
        case = self.folder / "case.yaml"
        text = case.read_text().replace("name: A made-up flume", "name: " + 20 * "long " + "name")
        case.write_text(text + "model_fluid: {units: grain}\n")
        series = self.folder / "series.csv"
        series.write_text(series.read_text().replace("q_star [1]", "q_s [m^2/s]"))
        run = thalweg.Run(self.folder)
        figure = drawing.bed_figure(run, run.grains[-1])
        self.addCleanup(matplotlib.pyplot.close, figure)
        view, bar = figure.axes   # one colour bar, and room for one only
        self.assertEqual((view.get_xlabel(), view.get_ylabel()), ("x [D]", "z [D]"))
        self.assertEqual(bar.get_ylabel(), "grain speed [sqrt(g'D)]")
        np.testing.assert_allclose(view.get_ylim(), (0.0, run.size[2]))
        figure.canvas.draw()
        title = figure.texts[0].get_window_extent()
        self.assertGreater(title.x0, 0.0)
        self.assertLess(title.x1, figure.bbox.x1)
        self.assertGreater(title.y0, view.get_window_extent().y1)
        self.assertGreater(bar.get_tightbbox().x1, 0.9 * figure.bbox.x1)
        rates = transport_rate.figure_of(run)
        self.addCleanup(matplotlib.pyplot.close, rates)
        self.assertEqual(rates.axes[0].get_ylabel(), "$q_s$ [sqrt(g'D$^3$)]")
        self.assertEqual(rates.axes[-1].get_xlabel(), "time $t$ [sqrt(D/g')]")
        self.assertIn(" sqrt(g'D^3), deviation", transport.transport(run).sentences()[0])

    def test_grains_and_flow_of_different_times(self):
        """There are grains at 0 and 3 s; the flow tells its time where the grains have another one."""
        for flow, wanted, title, when in (
            (3.0, None, "t = 3 s", ""), (3.0, 0.0, "t = 0 s", "\nat t = 3 s"), (2.99999, None, "t = 3 s", ""),
            (1.25, None, "t = 0 s", "\nat t = 1.25 s"),
        ):
            made_up_run.write_index(self.folder / "fluid.pvd", [(flow, "fluid/fluid_30000.vti")])
            run = thalweg.Run(self.folder)
            figure = overview.bed_figure(run, wanted)
            self.addCleanup(matplotlib.pyplot.close, figure)
            self.assertTrue(figure.texts[0].get_text().replace("\u00a0", " ").endswith(title))
            self.assertEqual(figure.axes[2].get_ylabel(), f"fluid speed [cm/s]{when}")
            figure.canvas.draw()
            self.assertLess(figure.axes[2].get_tightbbox().x1, figure.bbox.x1)
            with unittest.mock.patch("thalweg.figures.scene.scale_bar", return_value=scene.vtkScalarBarActor()) as bar:
                scene.scene(run, run.grains.nearest(wanted), run.fluid[0], (0.0, -1.0, 0.0), 10)
            self.assertEqual(bar.call_args_list[1].args[1], f"fluid speed{when}")

    def test_the_cut_of_solids_without_a_slice_of_the_fluid(self):
        (self.folder / "fluid.pvd").unlink()
        size = thalweg.Run(self.folder).size
        # A tetrahedron about the middle plane, which cuts it at half its height: half as wide as at its foot.
        points = np.array([[0.25, 0, 0], [0.75, 0, 0], [0.5, 0, 1], [0.5, 1, 0]]) * size
        triangles = np.array([[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
        (self.folder / "solids").mkdir()
        made_up_folder.write_triangles(self.folder / "solids/solids_0.vtp", points, triangles,
                                       {"solid": np.zeros(4, np.int32)})
        made_up_folder.write_index(self.folder / "solids.pvd", [(0.0, "solids/solids_0.vtp")])
        x, z = np.linspace(0, size[0], 401), np.array([0.001, 0.25, 0.499, 0.51]) * size[2]
        inside = drawing.inside_cut(points[triangles], 0.5 * size[1], x, z)
        np.testing.assert_allclose(inside.mean(axis=1), (0.25, 0.125, 0.0, 0.0), atol=4e-3)   # a pixel and a half
        np.testing.assert_allclose(x[inside[0]].mean(), 0.5 * size[0])
        run = thalweg.Run(self.folder)
        with unittest.mock.patch("thalweg.drawing.fill_solid") as fill:
            figure = drawing.bed_figure(run, run.grains[-1])
        self.addCleanup(matplotlib.pyplot.close, figure)
        self.assertAlmostEqual(fill.call_args[0][1].mean(), 0.5 * 0.25 * 0.5, delta=2e-3)   # a triangle

    def test_which_way_the_flow_goes(self):
        case, right, left = self.folder / "case.yaml", ", flow to the right", ", flow to the left"
        text = case.read_text()
        down, water, wall = "{vector: [0, 0, -9.8]}", "{density: 1000}", "{{type: moving, velocity: [{}, 0, 0]}}".format
        held = "{{density: 1000, mean_velocity: {{velocity: {}, response_time: 0.1}}}}".format
        for gravity, sides, fluid, expected in (
            ("{magnitude: 9.8, slope: 0.1}", "law_of_the_wall", water, right),
            ("{vector: [-0.1, 0, -9.8]}", "law_of_the_wall", water, left), (down, "law_of_the_wall", water, ""),
            (down, wall(0.1), water, right), (down, wall(-0.1), water, left), (down, wall(0), water, ""),
            ("{vector: [0.1, 0, -9.8]}", wall(-0.1), water, ""), (down, "law_of_the_wall", held(-0.3), left),
            ("{vector: [-0.1, 0, -9.8]}", "law_of_the_wall", held(0.3), right), (down, wall(0.1), "{}", ""),
        ):
            case.write_text(text.replace("{type: law_of_the_wall}", sides) + f"gravity: {gravity}\nfluid: {fluid}\n")
            self.assertEqual(drawing.flow_direction(thalweg.Run(self.folder)), expected)
        case.write_text(text + f"gravity: {{magnitude: 9.8, slope: 0.1}}\nfluid: {water}\n")
        run = thalweg.Run(self.folder)
        self.assertEqual([drawing.flow_direction(run, from_y) for from_y in (-0.1, 0.0, 0.1)], [right, "", left])

    def rate_panels(self, early):
        """The panels of transport_rate.png of three seconds about 0.05, of which the first 20 measurements are `early`,
        the rates and the mean from 1 s on."""
        case = self.folder / "case.yaml"
        case.write_text("name: rates\nsystem: resolved\nanalysis: {transport_rate: {from: 1.0}}\n")
        rate = 0.05 + 0.01 * np.random.default_rng(1).normal(size=300)
        rate[:20] = early
        (self.folder / "series.csv").write_text("time [s],q_star [1]\n" +
                                                "".join(f"{0.01 * n:g},{value}\n" for n, value in enumerate(rate)))
        run = thalweg.Run(self.folder)
        figure = transport_rate.figure_of(run)
        self.addCleanup(matplotlib.pyplot.close, figure)
        return figure.axes, rate, transport.transport(run)

    def test_the_transport_rate_is_drawn_whole_with_its_averaging_window(self):
        for early, panels in ((0.05, 1), (1.58, 2), (-0.3, 2)):   # a start that carries thirty times as much
            axes, rate, found = self.rate_panels(early)
            self.assertEqual(len(axes), panels)
            self.assertEqual(axes[0].get_xlim(), (0.0, 2.99))
            low, high = axes[0].get_ylim()
            self.assertGreater(high, rate.max())
            self.assertLessEqual(low, rate.min())
            self.assertEqual((found.start, found.stop), (1.0, 2.99))
            self.assertIn(f"mean from 1 to 2.99 s: {found.rate.mean:.4g} \u00b1 {found.rate.error:.2g}",
                          [text.get_text() for text in axes[0].get_legend().get_texts()])
            if panels == 2:
                self.assertEqual(axes[1].get_xlim(), (1.0, 2.99))
                low, high = axes[1].get_ylim()
                self.assertTrue(low <= rate[100:].min() and rate[100:].max() < high < 0.2)

    def test_the_legend_of_the_rates_is_not_clipped(self):
        for units, column in (("", "q_star [1]"), ("", "q_s [m^2/s]"), ("model_fluid: {units: grain}\n", "q_s [m^2/s]")):
            (self.folder / "case.yaml").write_text(f"name: rates\n{units}analysis: {{transport_rate: {{from: 30}}}}\n")
            rows = "".join(f"{n},{1.2345e-5 * (1 + 0.1 * (-1) ** n):g}\n" for n in range(300))
            (self.folder / "series.csv").write_text(f"time [s],{column}\n{rows}")
            figure = transport_rate.figure_of(thalweg.Run(self.folder))
            self.addCleanup(matplotlib.pyplot.close, figure)
            figure.canvas.draw()
            legend = figure.axes[0].get_legend().get_window_extent()
            self.assertGreaterEqual(legend.x0, 0.0)
            self.assertLessEqual(legend.x1, figure.bbox.width)
            self.assertGreater(figure.axes[0].get_window_extent().width, 0.7 * figure.bbox.width)

    def test_a_long_name_is_not_clipped(self):
        name = "Wide bed, cost $5_ and $6^, second series after the repair of the pump, " * 2   # dollars begin no formula
        (self.folder / "case.yaml").write_text(f"name: '{name}'\nsystem: resolved\n")
        figure = transport_rate.figure_of(thalweg.Run(self.folder))
        self.addCleanup(matplotlib.pyplot.close, figure)
        figure.canvas.draw()
        title = figure._suptitle
        self.assertEqual(title.get_text().split(), name.split())
        extent = title.get_window_extent()
        self.assertTrue(0.0 <= extent.x0 < extent.x1 <= figure.bbox.width)

    def test_of_a_continuum_the_last_rate_counts(self):
        (self.folder / "case.yaml").write_text("name: column\nsystem: continuum\n")
        (self.folder / "series.csv").write_text("time [s],q_star [1]\n0,0\n5,0.06\n10,0.08\n")
        figure = transport_rate.figure_of(thalweg.Run(self.folder))
        self.addCleanup(matplotlib.pyplot.close, figure)
        self.assertEqual([text.get_text() for text in figure.axes[0].get_legend().get_texts()],
                         ["column", "at 10 s: 0.08"])

    def test_a_figure_has_a_name_that_can_be_drawn(self):
        for name in ("a.txt", "a"):
            for kind in ("side", "q", "relation", "visible", "two_phases"):
                done = self.plot("--out", self.folder / name, kind=kind)
                self.assertEqual(done.returncode, 2)
                self.assertIn(f"{name}: a figure ends in ", done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1)

    def test_axes_of_nothing(self):
        self.assertEqual(transport_rate.padded(np.zeros(3)), (0.0, 0.05))

    def test_a_run_without_a_fluid_or_grain_pictures(self):
        (self.folder / "fluid.pvd").unlink()
        self.assertEqual(self.plot().returncode, 0)
        (self.folder / "grains.pvd").unlink()
        done = self.plot()   # what there is
        self.assertEqual(done.returncode, 0)
        self.assertIn("transport_rate.png", done.stdout)
        self.assertIn("left out", done.stderr)
        self.assertIn("no picture of the grains", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1)

    def test_the_page_has_a_row_of_every_kind(self):
        helped = subprocess.run(
            [sys.executable, "-B", "-m", "thalweg", "plot", "--help"], text=True, capture_output=True,
            env={**os.environ, "PYTHONPATH": str(ROOT / "python"), "COLUMNS": "100"},
        )
        kinds = re.findall(r"^    (\w+)", helped.stdout, re.MULTILINE)
        self.assertGreater(len(kinds), 10)
        rows = re.findall(r"^\| (`.*?) \|", (ROOT / "python/README.md").read_text(), re.MULTILINE)
        for kind in set(kinds) - {"KIND"}:
            self.assertTrue(any(f"`{kind}`" in row for row in rows), kind)

    def test_a_folder_that_is_no_run(self):
        (self.folder / "case.yaml").unlink()
        done = self.plot()
        self.assertEqual(done.returncode, 2)
        self.assertIn("no case.yaml", done.stderr)


if __name__ == "__main__":
    unittest.main()
