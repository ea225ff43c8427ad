"""Impacts of a sphere whose heights and velocities are made up."""
import unittest

import made_up_folder  # noqa: F401 (where the package is)
from thalweg.rebound import impacts, settling_time


class SettlingTime(unittest.TestCase):
    def test_is_that_of_sound_around_half_a_grain(self):
        # Half a circumference of pi 2.5 mm at the speed of sound, 0.5 mm/(sqrt(3) 0.1 ms) = 2.88675 m/s.
        case = {"grains": [{"diameter": 5.0e-3}], "domain": {"spacing": 0.5e-3}, "fluid": {"time_step": 1.0e-4}}
        self.assertAlmostEqual(settling_time(case), 7.853982e-3 / 2.886751, delta=1e-9)


class Impacts(unittest.TestCase):
    TIMES = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]

    def test_velocities_before_and_after(self):
        # Leaves at 3 s; half a second later, half-way between the next two velocities.
        found = impacts(self.TIMES, [1.9, 1.0, 0.01, 0.0, 0.5, 0.9, 1.2], [0.0, -0.5, -0.8, 0.4, 0.6, 0.5, 0.3], 0.5)
        self.assertEqual([before for before, _ in found], [0.8])
        self.assertAlmostEqual(found[0][1], 0.5, delta=1e-12)

    def test_what_comes_after_the_end_of_the_record_is_not_an_impact(self):
        for gaps, velocities in (([1.9, 1.5, 1.2, 1.0, 0.8, 0.6, 0.4], [-0.3] * 7),   # still falling
                                 ([1.9, 1.0, 0.01, 0.0, 0.0, 0.0, 0.0], [-0.5] * 7),   # still in contact
                                 ([1.9, 1.5, 1.0, 0.8, 0.4, 0.01, 0.1], [-0.5] * 6 + [0.4])):
            self.assertEqual(impacts(self.TIMES, gaps, velocities, 0.5), [])

    def test_a_record_that_begins_at_the_wall(self):
        # It rests there, and then leaves: no impact. It comes back, and that is one.
        away = [0.01, 0.01, 0.3, 0.5, 0.7, 0.8, 0.9]
        self.assertEqual(impacts(self.TIMES, away, [0.0, 0.1, 0.4, 0.3, 0.2, 0.1, 0.1], 0.5), [])
        back = impacts(self.TIMES, [0.01, 0.3, 0.3, 0.01, 0.2, 0.4, 0.5], [0.4, 0.2, -0.2, -0.4, 0.3, 0.1, 0.0], 1.0)
        self.assertEqual(len(back), 1)
        self.assertEqual(back[0][0], 0.4)
        self.assertAlmostEqual(back[0][1], 0.1, delta=1e-12)

    def test_a_record_that_begins_as_it_arrives(self):
        # Its first row is in contact already, falling: the fastest known is that row.
        found = impacts(self.TIMES, [0.01, 0.0, 0.2, 0.4, 0.5, 0.6, 0.7], [-0.5, 0.2, 0.4, 0.3, 0.2, 0.1, 0.1], 1.0)
        self.assertEqual(len(found), 1)
        self.assertEqual(found[0][0], 0.5)
        self.assertAlmostEqual(found[0][1], 0.4, delta=1e-12)


if __name__ == "__main__":
    unittest.main()
