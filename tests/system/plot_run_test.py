"""plot_run.py draws a run folder, and says in one sentence what is wrong with one it cannot draw."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import matplotlib.image
import numpy as np

import made_up_run

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "plot_run.py"
sys.path.insert(0, str(SCRIPT.parent))
import plot_run  # noqa: E402
import thalweg  # noqa: E402
from thalweg import drawing  # noqa: E402


class PlotRun(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name) / "run"
        self.grains = made_up_run.write_run(self.folder)

    def plot(self, *options):
        return subprocess.run([sys.executable, SCRIPT, self.folder, *options], text=True, capture_output=True)

    def test_draws_both_pictures_and_names_them(self):
        done = self.plot()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        names = [self.folder / "bed.png", self.folder / "transport_rate.png"]
        self.assertEqual(done.stdout.split(), [str(name) for name in names])
        for name in names:
            pixels = matplotlib.image.imread(name)
            self.assertGreater(min(pixels.shape[:2]), 400)
            self.assertGreater(len(np.unique((pixels * 15).astype(int).reshape(-1, pixels.shape[2]), axis=0)), 10)

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
        flow, box = drawing.fluid_slice(thalweg.Run(self.folder).fluid[0])
        self.assertEqual(flow.shape, (90, 72))
        self.assertEqual(flow.mask.sum(), 40)
        self.assertTrue(flow.mask[0, :40].all())
        np.testing.assert_allclose(box, (0, 72 * made_up_run.SPACING, 0, 90 * made_up_run.SPACING), rtol=1e-12)

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

    def test_holes_take_the_mean_of_their_neighbours(self):
        layer = np.ma.array([[1.0, 2.0, 3.0, 4.0, 5.0]] * 5, mask=np.zeros((5, 5), bool))
        layer[2, 2] = np.ma.masked
        filled = drawing.without_holes(layer)
        np.testing.assert_allclose(filled, [[1.0, 2.0, 3.0, 4.0, 5.0]] * 5, atol=1e-15)
        layer.mask[:] = True
        self.assertEqual(drawing.without_holes(layer).shape, (5, 5))

    def test_the_settling_at_the_start_does_not_dwarf_the_rest(self):
        rate = np.array([0.0, 2.0, 0.1, 0.08])
        self.assertEqual(plot_run.range_of_interest(rate, rate[2:]), (0.0, 1.5 * 0.1))
        self.assertEqual(plot_run.range_of_interest(rate, rate), (0.0, 1.08 * 2.0))
        low, high = plot_run.range_of_interest(np.zeros(3), np.zeros(3))
        self.assertLess(low, high)

    def test_a_run_without_a_fluid_or_grain_pictures(self):
        (self.folder / "fluid.pvd").unlink()
        self.assertEqual(self.plot().returncode, 0)
        (self.folder / "grains.pvd").unlink()
        done = self.plot()
        self.assertEqual(done.returncode, 1)
        self.assertIn("no picture of the grains", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1)

    def test_a_folder_that_is_no_run(self):
        (self.folder / "case.yaml").unlink()
        done = self.plot()
        self.assertEqual(done.returncode, 1)
        self.assertIn("no case.yaml", done.stderr)


if __name__ == "__main__":
    unittest.main()
