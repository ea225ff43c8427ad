"""thalweg plot draws a run folder, and says in one sentence what is missing."""
import contextlib
import csv
import os
import shutil
import subprocess
import sys
import unittest

import matplotlib.image
import matplotlib.pyplot
import numpy as np
from PIL import Image, ImageSequence

import made_up_folder as made_up
from made_up_folder import ROOT

sys.path.insert(0, str(ROOT / "tests/support"))
import made_up_profiles
from thalweg.__main__ import main
from thalweg.figures import relation
from thalweg.tables import read_rows

D = 4.95e-3


class Figures(made_up.MadeUpFolder):
    def setUp(self):
        super().setUp()
        x, y, z = np.meshgrid((np.arange(24) + 0.5) * 5e-3, (2.6e-3, 7.9e-3), (np.arange(6) + 0.5) * D)
        still = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
        frames = [np.vstack([still, [0.02 + 0.01 * n, 5e-3, 7 * D]]) for n in range(8)]
        velocity = np.zeros((8, len(still) + 1, 3))
        velocity[:, -1, 0] = 0.1
        self.write_frames(np.arange(8) * 0.1, frames, velocity=velocity)
        time = np.arange(0, 3, 0.01)
        self.rate = 0.05 + 0.01 * np.random.default_rng(1).normal(size=len(time))
        rows = "".join(f"{t},{q}\n" for t, q in zip(time, self.rate))
        (self.folder / "series.csv").write_text("time [s],q_star [1]\n" + rows)

    def plot(self, kind, *options):
        return subprocess.run([sys.executable, "-B", "-m", "thalweg", "plot", kind, self.folder, *options], text=True,
                              capture_output=True, env=os.environ | {"PYTHONPATH": str(ROOT / "python")})

    def drawn(self, done, out):
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.splitlines()[-1], str(out))
        pixels = matplotlib.image.imread(out)
        self.assertGreater(len(np.unique(pixels.reshape(-1, pixels.shape[2]), axis=0)), 10)

    def refused(self, done, words):
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn(words, done.stderr)

    def write_profiles(self):
        made_up_profiles.write_grain_profiles(self.folder / "profiles.h5", D)

    def test_the_transport_relation(self):
        self.write_profiles()
        out = self.folder / "relation.png"
        done = self.plot("relation", "--out", out)
        self.drawn(done, out)
        name, shields, bed, mean = done.stdout.splitlines()[2].split("|")[1:5]
        # The surface of the made-up profiles is half way from the middle of the sixth layer to that of the seventh.
        depth = 0.1485 - 6 * D
        exact = np.sin(np.arctan(0.0748)) * depth * 0.0105 / (2 * depth + 0.0105) / (1.55 * D)
        self.assertLess(abs(float(shields) - exact), 5.1e-5)   # printed with four decimals
        self.assertLess(abs(float(bed) - 6.0), 5.1e-3)
        self.assertLess(abs(float(mean) - self.rate[100:].mean()), 5.1e-5)   # from 1 s on, as the case says

    def test_the_relation_of_a_single_measurement(self):
        """Which has no error: none is drawn, and neither nan nor a warning is printed."""
        self.write_profiles()
        (self.folder / "series.csv").write_text("time [s],q_star [1]\n0,0.01\n1.5,0.05\n")
        out, table = self.folder / "relation.png", self.folder / "runs.csv"
        for _ in range(2):   # the second time the row is read from the table
            done = self.plot("relation", "--out", out, "--table", table)
            self.drawn(done, out)
            self.assertNotIn("nan", done.stdout)
            self.assertNotIn("Warning", done.stderr)
        self.assertIn("| 0.0500 | single measurement | 0.0000 |", done.stdout)
        with open(table, newline="") as file:
            row, = csv.DictReader(file)
        self.assertEqual((row["q_star [1]"], row["error [1]"]), ("0.0500", ""))

    def test_a_run_in_the_table_has_the_name_of_its_folder_wherever_it_is_drawn_from(self):
        self.write_profiles()
        out, table = self.folder / "relation.png", self.folder / "runs.csv"
        with contextlib.chdir(self.folder):
            self.assertEqual(main(["plot", "relation", ".", "--out", str(out), "--table", str(table)]), 0)
        self.assertEqual([row["run"] for row in read_rows(table)], ["run"])

    def test_what_a_camera_sees(self):
        out = self.folder / "visible.png"
        self.drawn(self.plot("visible", "--out", out), out)

    def test_frames_without_velocities(self):
        for n in range(8):
            made_up.write_points(self.folder / f"grains/grains_{n}.vtp", np.zeros((1, 3)), {"radius": np.full(1, 1e-3)})
        for kind in ("side", "film", "visible"):
            self.refused(self.plot(kind), "the frame has no ")
        self.drawn(self.plot("all"), self.folder / "transport_rate.png")

    def test_bed_profiles(self):
        self.refused(self.plot("profiles"), "no means of grains or fluid yet")
        self.write_profiles()
        self.drawn(self.plot("profiles"), self.folder / "profiles.png")

    def test_bed_profiles_with_the_balance(self):
        self.write_profiles()
        made_up_profiles.add_stress_balance(self.folder / "profiles.h5", D)
        out = self.folder / "figures/balance.png"
        self.drawn(self.plot("profiles", "--out", out), out)

    def test_a_film(self):
        for name in ("film.gif", "film"):
            done = self.plot("film", "--out", self.folder / name, "--every", "0.2", "--width", "300")
            self.assertEqual(done.returncode, 0, done.stderr)
        with Image.open(self.folder / "film.gif") as film:
            self.assertEqual(film.n_frames, 4)   # at 0, 0.2, 0.4, 0.6 s
        # Eight images, 40 a second, are 0.2 s, though each has whole hundredths.
        self.assertEqual(self.plot("film", "--width", "300", "--rate", "40").returncode, 0)
        with Image.open(self.folder / "film.gif") as film:
            self.assertEqual(sum(picture.info["duration"] for picture in ImageSequence.Iterator(film)), 200)
        names = [f"image_{n:05d}.png" for n in range(4)]
        self.assertEqual(sorted(path.name for path in (self.folder / "film").iterdir()), names)
        (self.folder / "film/image_of_mine.png").touch()   # a shorter film leaves none of the images of the longer one
        done = self.plot("film", "--out", self.folder / "film", "--every", "0.4", "--width", "300")
        self.assertEqual(done.returncode, 0)
        self.assertEqual(
            sorted(path.name for path in (self.folder / "film").iterdir()), names[:2] + ["image_of_mine.png"]
        )
        self.refused(self.plot("film", "--from", "5"), "no frame of the grains in this time")
        for option, value, words in (("--rate", "0", "above 0"), ("--rate", "60", "at most 50 images"),
                                     ("--width", "0", "100 to 10000 pixels")):
            self.refused(self.plot("film", option, value), words)
        self.refused(self.plot("film", "--out", self.folder / "film.webm"), "give a .gif, an .mp4 or a folder")

    def test_figures_of_several_runs_go_into_their_folders(self):
        other = self.folder.parent / "other"
        shutil.copytree(self.folder, other)
        done = self.plot("q", other)
        self.assertEqual(done.stdout.split(), [str(folder / "transport_rate.png") for folder in (self.folder, other)])
        self.refused(self.plot("q", other, "--out", self.folder / "both"), "each of 2 runs has a figure of its own")

    def test_a_run_off_the_axes_is_drawn_or_told(self):
        rows = [{"run": name, "Shields number [1]": shields, "q_star [1]": rate, "error [1]": "0.1", "steady": "yes"}
                for name, shields, rate in (("wild", "0.4", "7.0"), ("still", "0.03", "0.0"))]
        figure = relation.figure_of(rows)
        self.addCleanup(matplotlib.pyplot.close, figure)
        axes = figure.axes[0]
        self.assertGreater(axes.get_xlim()[1], 0.4)
        self.assertGreater(axes.get_ylim()[1], 7.1)
        self.assertEqual(axes.get_title(loc="left"), "drawn at 0.001, because q* is less: still")


if __name__ == "__main__":
    unittest.main()
