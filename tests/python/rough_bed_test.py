"""Bulk velocity, roughness and slope of a made-up logarithmic flow over fixed spheres."""
import unittest

import h5py
import numpy as np

from made_up_folder import MadeUpFolder
from thalweg import Run
from thalweg.rough_bed import friction_velocity, rough_flow, roughness_of, von_karman_number
from thalweg.water import VON_KARMAN

CASE = """
system: resolved
domain: {size: [0.060, 0.030, 0.0275], spacing: 5.0e-4}
fluid: {density: 1000, kinematic_viscosity: 1e-06}
gravity: {magnitude: 9.81, slope: 0.0025}
grains: [{count: 72, diameter: 5.0e-3, density: 2650, fixed: true}]
"""
ROUGHNESS = 0.4   # diameters


class RoughBed(MadeUpFolder):
    def setUp(self):
        super().setUp()
        (self.folder / "case.yaml").write_text(CASE)
        u_star = friction_velocity(Run(self.folder))
        # Mean of a logarithmic law over a depth h: u*/kappa (ln(30 h/k_s) - 1).
        mean = u_star / VON_KARMAN * (np.log(30.0 * 4.7 / ROUGHNESS) - 1.0)
        momentum = 1000.0 * 0.060 * 0.030 * 4.7 * 5e-3 * mean
        rows = "\n".join(f"{0.1 * n:.1f},{momentum * (2.0 if n < 100 else 1.0):.9g}" for n in range(300))
        (self.folder / "series.csv").write_text("time [s],fluid_momentum_x [kg m/s]\n" + rows + "\n")
        z = (np.arange(55) + 0.5) * 0.5e-3
        height = np.maximum(z / 5e-3 - 0.8, 0.02)
        with h5py.File(self.folder / "profiles.h5", "w") as file:
            group = file.create_group("fluid_statistics")
            group["z"] = z
            group["velocity"] = np.outer(u_star / VON_KARMAN * np.log(30.0 * height / ROUGHNESS), [1.0, 0.0, 0.0])

    def test_a_logarithmic_flow_gives_its_roughness(self):
        flow = rough_flow(Run(self.folder), start=10.0)
        self.assertAlmostEqual(flow.friction_velocity, np.sqrt(9.81 * np.sin(np.arctan(0.0025)) * 0.0235))
        self.assertAlmostEqual(flow.depth, 4.7)
        self.assertAlmostEqual(flow.grain_reynolds, flow.friction_velocity * 5.0e-3 / 1e-6)
        self.assertAlmostEqual(flow.roughness, ROUGHNESS, places=6)
        self.assertAlmostEqual(von_karman_number(Run(self.folder)), VON_KARMAN, places=6)

    def test_rows_at_shorter_intervals_do_not_weigh_more(self):
        # Twice the momentum for the last second of twenty, in rows ten times as frequent since a restart.
        path = self.folder / "series.csv"
        head, *rows = path.read_text().splitlines()[:291]
        momentum = float(rows[-1].partition(",")[2])
        rows += [f"{29 + 0.01 * n:.2f},{2.0 * momentum:.9g}" for n in range(100)]
        path.write_text("\n".join([head, *rows, ""]))
        faster = rough_flow(Run(self.folder), start=10.0).bulk_velocity
        path.write_text("\n".join([head, *rows[:290], ""]))
        self.assertAlmostEqual(faster / rough_flow(Run(self.folder), start=10.0).bulk_velocity, 1.05, delta=0.005)

    def test_roughness_and_mean_belong_together(self):
        # By hand: k_s = 30 h exp(-1 - 0.41 U), h = 4.7, U = 12.
        self.assertAlmostEqual(roughness_of(12.0, 4.7), 141.0 * np.exp(-5.92), places=9)


if __name__ == "__main__":
    unittest.main()
