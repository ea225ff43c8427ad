"""What the camera beside the flume sees of a few spheres."""
import unittest

import numpy as np

import made_up_folder  # noqa: F401 (where the package is)
from types import SimpleNamespace

from thalweg.plan_view import upper_sides
from thalweg.side_view import Surface, front_grains, visible_grains, with_images_along_x
from thalweg.visible_profiles import VisibleSums

R = np.array([0.5, 0.5])
SIZE = np.array([10.0, 4.0, 10.0])


class UpperSides(unittest.TestCase):
    def test_over_the_corner_of_a_periodic_box(self):
        x, y = (np.arange(length / 0.5) * 0.5 for length in (10.0, 4.0))
        found = upper_sides(np.array([[0.0, 4.0, 3.0], [0.0, 0.0, 2.9]]), np.array([0.8, 0.8]), x, y, (10.0, 4.0))
        side, corner = np.sqrt(0.8**2 - 0.5**2), np.sqrt(0.8**2 - 2 * 0.5**2)
        for place, height in ((0, 0), 0.8), ((1, 0), side), ((-1, 0), side), ((0, -1), side), ((-1, -1), corner):
            self.assertAlmostEqual(found[place], 3.0 + height)
        self.assertEqual(np.count_nonzero(found), 9)
        self.assertEqual(np.count_nonzero(upper_sides(np.array([[0.0, 0.0, 3.0]]), [0.8], x, y)), 4)


class FrontGrains(unittest.TestCase):
    def test_a_disk_of_pixels(self):
        shown = front_grains(np.array([[5.0, 1.0, 5.0]]), R[:1], SIZE, 0.02)
        # The error of counting pixels is below a quarter of those on the rim.
        self.assertLess(abs(np.sum(shown == 0) * 0.02**2 - np.pi / 4), 0.25 * np.pi * 0.02)
        self.assertEqual(shown[250, 250], 0)
        self.assertEqual(shown[250, 280], -1)

    def test_the_nearer_one_hides_the_other(self):
        for order in ([0, 1], [1, 0]):
            places = np.array([[5.0, 1.0, 5.0], [5.2, 2.5, 5.0]])[order]
            shown = front_grains(places, R, SIZE, 0.02)
            self.assertEqual(shown[250, 260], order.index(0))
            self.assertEqual(shown[250, 283], order.index(1))

    def test_across_the_end_of_the_box(self):
        shown = front_grains(np.array([[0.1, 1.0, 5.0]]), R[:1], SIZE, 0.02)
        self.assertLess(abs(np.sum(shown == 0) * 0.02**2 - np.pi / 4), 0.25 * np.pi * 0.02)
        self.assertEqual(shown[250, 490], 0)
        place, radius, owner = with_images_along_x(np.array([[0.1, 1.0, 5.0], [5.0, 1, 5]]), R, 10.0)
        np.testing.assert_allclose(place[2], (10.1, 1.0, 5.0))
        np.testing.assert_array_equal(owner, (0, 1, 0))


def seen(offset, second=0.5, **options):
    """Whether a grain is seen behind another that is so far aside."""
    places = np.array([[5.0, 1.0, 5.0], [5.0 + offset, 2.5, 5.0]])
    return visible_grains(places, np.array([second, 0.5]), **options).tolist()


class VisibleGrains(unittest.TestCase):
    def test_the_covered_share_of_the_perimeter(self):
        # Of a circle with its centre s from another of the same radius R, the arc within it is 2 acos(s/2R): 60 % of
        # the perimeter at s = 2 R cos(0.6 pi) < 0, so a single equal disk never covers that much ...
        self.assertEqual(seen(0.3), [True, True])
        # ... and one of radius 0.8 in front covers it up to s where cos(0.6 pi) = (R^2 + s^2 - 0.64)/(2 R s): s =
        # 0.489.
        self.assertEqual(seen(0.47, 0.8), [True, False])
        self.assertEqual(seen(0.51, 0.8), [True, True])

    def test_the_nearest_of_two_projections(self):
        self.assertEqual(seen(0.99 / 6), [True, False])   # a sixth of a diameter, which is 1
        self.assertEqual(seen(1.01 / 6), [True, True])

    def test_a_hidden_grain_hides_by_its_rim_only(self):
        # The second is too near to the first, the third too near to the second only: that one stays.
        places = np.array([[5.0, 0.6, 5.0], [5.15, 1.7, 5.0], [5.30, 2.8, 5.0]])
        self.assertEqual(visible_grains(places, np.full(3, 0.5)).tolist(), [True, False, True])

    def test_across_the_end_of_the_box(self):
        places = np.array([[9.95, 1.0, 5.0], [0.05, 2.5, 5.0]])
        self.assertEqual(visible_grains(places, R).tolist(), [True, True])
        self.assertEqual(visible_grains(places, R, length=10.0).tolist(), [True, False])


class VisibleProfiles(unittest.TestCase):
    def test_between_walls_the_ends_of_the_box_do_not_meet(self):
        # A front grain at one end hides that at the other only where x is periodic.
        frame = SimpleNamespace(position=np.array([[9.95, 1.0, 3.0], [0.05, 4.0, 3.0]]), radius=np.full(2, 0.5),
                                velocity=np.zeros((2, 3)))
        surface = Surface(np.arange(10.0), np.zeros(10))
        areas = []
        for periodic in (True, False):
            sums = VisibleSums(np.array([0.0, 6.0]), 10.0, periodic)
            sums.add(frame, surface)
            areas.append(float(sums.area.sum()))
        self.assertAlmostEqual(areas[1], 2.0 * np.pi / 4.0, 9)
        self.assertLess(areas[0], areas[1])

    def test_of_two_grains_above_a_slope(self):
        # The surface rises from 3 to 4; both grains are 1 above it, one layer holds both whole. A third is hidden.
        surface = Surface(np.array([2.0, 8.0]), np.array([3.0, 4.0]))
        frame = SimpleNamespace(
            position=np.array([[2.0, 1, 4.0], [8.0, 1, 5.0], [8.05, 2.5, 5.0]]), radius=np.full(3, 0.5),
            velocity=np.array([[1.0, 9, 0], [3.0, 9, 0], [50, 50, 50]]),
        )
        sums = VisibleSums(np.array([-1.5, 0.5, 2.5]), 10.0)
        sums.add(frame, surface)
        found = sums.profiles()
        np.testing.assert_allclose(found["areal_fraction"], (0.0, 2 * np.pi / 4 / (10.0 * 2.0)), rtol=1e-12)
        np.testing.assert_allclose(found["velocity"][1], (2.0, 0.0), rtol=1e-12)
        np.testing.assert_allclose(found["temperature"][1], 0.5, rtol=1e-12)  # half of the variance 1 of two components
        self.assertTrue(np.isnan(found["temperature"][0]))

    def test_a_grain_alone_has_no_temperature(self):
        for speed in np.linspace(0.1, 0.5, 41):
            sums = VisibleSums(np.array([0.0, 0.7, 2.0]), 10.0)
            frame = SimpleNamespace(position=np.array([[2.0, 1.0, 0.9]]), radius=np.full(1, 0.5),
                                    velocity=np.array([[speed, 0.0, -0.3 * speed]]))
            sums.add(frame, Surface(np.arange(10.0), np.zeros(10)))
            np.testing.assert_array_equal(sums.profiles()["temperature"], 0.0)


if __name__ == "__main__":
    unittest.main()
