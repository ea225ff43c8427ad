"""thalweg plot picture draws grains and flow in three dimensions without a screen, and says in one sentence what is
missing."""
import os
import pathlib
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
