"""The picture of a clump: a surface and the spheres beside it look alike where they are the same body."""
import tempfile
import unittest
from pathlib import Path

import numpy as np

import made_up_folder  # puts the package on the path
from thalweg.clump_picture import read_spheres, views_of
from thalweg.stl import read_stl, write_stl

SHAPES = Path(__file__).resolve().parents[2] / "cases/shapes"


class ClumpPicture(unittest.TestCase):
    def test_a_sphere_of_triangles_looks_like_a_sphere(self):
        """The corners of an ellipsoid, brought to a sphere of radius 2 about (1, 0, 3)."""
        corners = read_stl(SHAPES / "prolate.stl") / np.array([2.0, 1.0, 1.0])
        corners *= 2.0 / np.linalg.norm(corners, axis=-1, keepdims=True)
        middle = np.array([1.0, 0.0, 3.0])
        for surface, spheres, half in views_of(corners + middle, middle[None, :], np.array([2.0])):
            self.assertAlmostEqual(half, 2.16, delta=0.02)
            seen = np.isfinite(spheres)
            self.assertAlmostEqual(seen.mean(), np.pi * 2.0**2 / (2.0 * half) ** 2, delta=2e-3)
            self.assertLess(np.mean(seen != np.isfinite(surface)), 0.01)
            both = seen & np.isfinite(surface)
            self.assertLess(abs(surface[both] - spheres[both]).mean(), 0.02)

    def test_the_nearer_sphere_hides_the_other(self):
        """Seen along y from below zero, the sphere at y = -3 is in front; the one behind is all of its shade."""
        corners = np.zeros((1, 3, 3))
        centres, radii = np.array([[0.0, 3.0, 0.0], [0.0, -3.0, 0.0]]), np.array([1.0, 1.0])
        both = next(views_of(corners, centres, radii))[1]
        front = next(views_of(corners, centres[1:], radii[1:]))[1]
        np.testing.assert_array_equal(np.isfinite(both), np.isfinite(front))
        np.testing.assert_array_equal(both, front)

    def test_small_spheres(self):
        """Whose diameters the program writes without a point."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "silt.yaml"
            path.write_text("shape:\n  clump:\n    - {position: [0, 1e-05, 0], diameter: 5e-05}\n", encoding="utf-8")
            centres, radii = read_spheres(path)
        np.testing.assert_array_equal(centres, [[0.0, 1e-5, 0.0]])
        np.testing.assert_array_equal(radii, [2.5e-5])

    def test_text_and_binary_files_are_the_same_surface(self):
        corners = read_stl(SHAPES / "pebble.stl")
        self.assertEqual(corners.shape, (1280, 3, 3))
        with tempfile.TemporaryDirectory() as folder:
            write_stl(Path(folder) / "text.stl", corners)
            np.testing.assert_allclose(read_stl(Path(folder) / "text.stl"), corners, atol=1e-6)


if __name__ == "__main__":
    unittest.main()
