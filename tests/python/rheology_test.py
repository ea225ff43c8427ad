"""The state of a sheared mixture and its flow rule against values by hand."""
import unittest

import numpy as np

import made_up_folder  # noqa: F401 (where the package is)
from thalweg.rheology import flow_state, mixed_fraction, mixed_friction, solid_stress


class Rheology(unittest.TestCase):
    def test_flow_rule(self):
        # Eq. 20 at phi 0.5, I_v 0.01, I_m 1: 0.37 + 0.33/6 + 0.0125/0.70711 + 0.0125.
        self.assertAlmostEqual(mixed_friction(0.5, 0.01, 1.0), 0.455178, places=6)
        # At phi 0.4, I_v 0.02, I_m 0.5: 0.37 + 0.33/11 + 0.02/0.353553 + 0.02.
        self.assertAlmostEqual(mixed_friction(0.4, 0.02, 0.5), 0.476569, places=6)
        # Eq. 21 at I_m sqrt(2): 0.62/2.
        self.assertAlmostEqual(mixed_fraction(np.sqrt(2.0)), 0.31)

    def test_numbers_of_a_stress(self):
        stress = np.array([[-10.0, 0.0, 5.0], [0.0, -12.0, 0.0], [3.0, 0.0, -14.0]])
        state = flow_state(0.5, stress, -8.0, 0.005, 2500.0, 0.3)
        self.assertAlmostEqual(float(state.pressure), 12.0)
        # Deviator: diagonal 2, 0, -2 and twice (5 + 3)/2; half of its square 0.5 (8 + 32).
        self.assertAlmostEqual(float(state.shear_stress), np.sqrt(20.0))
        self.assertAlmostEqual(float(state.viscous_number), 0.3 * 8.0 / 12.0)
        self.assertAlmostEqual(float(state.inertial_number), 8.0 * 0.005 * np.sqrt(2500.0 / 12.0))
        self.assertAlmostEqual(float(state.mixed_number), np.sqrt(0.4 + 0.04**2 * 2500.0 / 12.0))

    def test_pull_has_no_friction(self):
        self.assertTrue(np.isnan(flow_state(0.1, np.eye(3), 1.0, 1.0, 1.0, 1.0).friction))

    def test_pore_pressure_is_no_stress_of_the_solid(self):
        # Grains at rest in a fluid under 7 Pa: they have -7 Pa over their share of the volume, and no effective stress.
        phi = np.array([0.2, 0.6])
        isotropic = -7.0 * phi[:, None] * np.eye(3).ravel()
        layers = {
            "contact_stress": np.zeros((2, 9)), "grain_fluid_stress": isotropic, "lubrication_stress": np.zeros((2, 9)),
            "kinetic_stress": np.zeros((2, 6)), "solid_fraction": phi, "fluid_pressure": np.full(2, 7.0),
        }
        np.testing.assert_allclose(solid_stress(layers), 0.0, atol=1e-12)

    def test_the_stress_of_the_solid_is_the_sum_of_all_its_parts(self):
        # Eqs. 13 and 15: contacts 1, the fluid 10, lubrication 100, fluctuations 1000, pore pressure 0.2 times 5e5.
        layers = {
            "contact_stress": np.arange(9.0)[None, :], "grain_fluid_stress": 10 * np.arange(9.0)[None, :],
            "lubrication_stress": 100 * np.arange(9.0)[None, :], "kinetic_stress": 1000 * np.arange(6.0)[None, :],
            "solid_fraction": np.array([0.2]), "fluid_pressure": np.array([5e5]),
        }
        # Of xx, xy, xz, ...; the kinetic stress is xx, yy, zz, xy, xz, yz.
        expected = 111 * np.arange(9.0).reshape(3, 3) + 1000 * np.array([[0, 3, 4], [3, 1, 5], [4, 5, 2]])
        expected = expected + 1e5 * np.eye(3)
        np.testing.assert_allclose(solid_stress(layers)[0], expected)


if __name__ == "__main__":
    unittest.main()
