"""thalweg plot picture draws grains and flow in three dimensions without a screen, and says in one sentence what is
missing."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import matplotlib.image
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import made_up_run  # noqa: E402


def share(pixels, condition):
    """Of the pixels of the scene, left of the scales, the share that shows a colour."""
    scene = pixels[:, :int(0.8 * pixels.shape[1]), :3]
    return float(condition(*np.moveaxis(scene, 2, 0)).mean())


def bluish(red, green, blue):
    return blue > red + 0.08


def yellowish(red, green, blue):
    return red > blue + 0.08


class Picture(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name) / "run"
        made_up_run.write_run(self.folder)

    def draw(self, *options):
        environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"} | {
            "PYTHONPATH": str(ROOT / "python")
        }
        return subprocess.run(
            [sys.executable, "-B", "-m", "thalweg", "plot", "picture", self.folder, *options], text=True,
            capture_output=True, env=environment,
        )

    def pixels(self, *options):
        out = self.folder / "pictures" / "three.png"
        done = self.draw("--out", out, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.split(), [str(out)])
        return matplotlib.image.imread(out)

    def test_shows_grains_and_flow(self):
        pixels = self.pixels("--size", "700", "500")
        self.assertEqual(pixels.shape[:2], (500, 700))
        # The bed fills half of the box and the water the rest of it; the box takes more than a fifth of the scene.
        self.assertGreater(share(pixels, yellowish), 0.1)
        self.assertGreater(share(pixels, bluish), 0.1)
        for corner in (pixels[-1, 0], pixels[-1, -1]):
            np.testing.assert_array_equal(corner[:3], 1.0)   # white around it

    def test_one_of_the_two_is_enough(self):
        (self.folder / "fluid.pvd").rename(self.folder / "fluid.kept")
        pixels = self.pixels()
        self.assertGreater(share(pixels, yellowish), 0.1)
        self.assertEqual(share(pixels, bluish), 0.0)
        (self.folder / "fluid.kept").rename(self.folder / "fluid.pvd")
        (self.folder / "grains.pvd").unlink()
        pixels = self.pixels()
        self.assertEqual(share(pixels, yellowish), 0.0)
        self.assertGreater(share(pixels, bluish), 0.1)

    def test_a_tall_box_is_in_view(self):
        case = self.folder / "case.yaml"
        size = "[0.0594, 0.010725, 0.2475]"
        case.write_text(re.sub(r"size: \[.*?\]", f"size: {size}", case.read_text()))
        for view in ((-0.45, -1.0, 0.4), (0.0, 0.0, 1.0), (1.0, 0.0, -0.2)):
            dark = self.pixels("--view", *map(str, view))[52:, :1120, :3].max(axis=2) < 0.7   # the box, below the title
            for edge in (dark[0], dark[-1], dark[:, 0], dark[:, -1]):
                self.assertFalse(edge.any())
            self.assertGreater(max(np.ptp(np.flatnonzero(dark.any(axis=1))) / 1000,
                                   np.ptp(np.flatnonzero(dark.any(axis=0))) / 1120), 0.8)

    def test_what_cannot_be_drawn_is_refused(self):
        (self.folder / "taken.png").mkdir()
        for options, words in (
            (("--view", "0", "0", "0"), "not a direction"), (("--view", "nan", "0", "1"), "not a direction"),
            (("--size", "0", "0"), "from 1 to"), (("--size", "100000", "100000"), "from 1 to"),
            (("--out", self.folder / "picture.jpg"), "is a .png"),
            (("--out", self.folder / "taken.png"), "taken.png: Is a directory"),
        ):
            done = self.draw(*options)
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertEqual(done.stdout, "")
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn(words, done.stderr)

    def test_what_is_missing(self):
        for name, words in (
            ("fluid.pvd", None), ("grains.pvd", "no frame of grains or fluid"), ("case.yaml", "no case.yaml"),
        ):
            (self.folder / name).unlink()
            if words:
                done = self.draw()
                self.assertEqual(done.returncode, 2)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main()
