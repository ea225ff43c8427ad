"""A made-up bed beside a made-up continuum: what is read, the decay of the creep, and drag against values by hand."""
import unittest

import h5py
import matplotlib

matplotlib.use("Agg")
import numpy as np

from made_up_folder import CASE, MadeUpFolder
from thalweg import Run, RunFolderError, two_phases
from thalweg.literature import beetstra_drag, tenneti_drag

DIAMETER, DECAY = 4.95e-3, 1.2     # m; diameters in which the made-up creep falls by e
COLUMN = """system: continuum
name: Made-up column
fluid: {density: 1000, kinematic_viscosity: 1e-06}
grains: {diameter: 5.0e-3, density: 2550}
gravity: {magnitude: 9.8, slope: 0.0748}
"""


def write_group(path, name, columns):
    with h5py.File(path, "w") as file:
        group = file.create_group(name)
        for key, (unit, values) in columns.items():
            data = group.create_dataset(key, data=values)
            data.attrs["unit"] = unit


class TwoPhases(MadeUpFolder):
    def setUp(self):
        super().setUp()
        z = (np.arange(60) + 0.5) * 0.25 * DIAMETER
        phi = np.clip(0.6 * (10.5 - z / DIAMETER), 0.0, 0.6)          # half of 0.6 ten diameters above the floor
        velocity = np.where(phi > 0.0, 0.1 * np.exp((z / DIAMETER - 10.0) / DECAY), 0.0)
        pressure = 1000.0 * np.maximum(0.12 - z, 0.01)
        stress = np.zeros((60, 9))
        stress[:, [0, 4, 8]] = -pressure[:, None]
        stress[:, [2, 6]] = 0.4 * pressure[:, None]
        six = np.zeros((60, 6))
        vector = np.zeros((60, 3))
        write_group(
            self.folder / "profiles.h5", "stress_balance",
            {
                "z": ("m", z), "solid_fraction": ("1", phi), "contact_stress": ("Pa", stress),
                "grain_fluid_stress": ("Pa", 0 * stress), "lubrication_stress": ("Pa", 0 * stress),
                "kinetic_stress": ("Pa", six), "fluid_pressure": ("Pa", 0 * z),
                "grain_velocity": ("m/s", np.column_stack([velocity, 0 * z, 0 * z])),
                "fluid_velocity": ("m/s", np.column_stack([velocity + 0.1, 0 * z, 0 * z])),
                "drag_density": ("N/m^3", vector), "granular_temperature": ("m^2/s^2", 1e-4 * phi),
                "viscous_stress": ("Pa", six), "subgrid_stress": ("Pa", six),
                "reynolds_stress": ("Pa", six + [0, 0, 0, 0, 5.0, 0]), "drag_function": ("1", 3.0 + 0 * z),
                "drag_reynolds_number": ("1", 50.0 + 0 * z),
            },
        )
        with h5py.File(self.folder / "profiles.h5", "a") as file:
            for name in ("viscous_stress", "subgrid_stress", "reynolds_stress"):
                file["stress_balance"][name].attrs["components"] = "xx yy zz xy xz yz"

    def made_up_column(self):
        folder = self.folder.parent / "column"
        folder.mkdir()
        (folder / "case.yaml").write_text(COLUMN)
        z = (np.arange(80) + 0.5) * 0.5e-3
        phi, depth = np.clip(0.62 * (25e-3 - z) / 5e-3, 0.0, 0.62), np.linspace(0.05, 0.01, 81)
        columns = {name: ("1", 1.0 + 0 * z) for name in ("grain_shear_stress", "fluid_shear_stress")}
        write_group(folder / "profiles.h5", "continuum", {
            **columns, "z": ("m", z), "solid_fraction": ("1", phi), "grain_velocity": ("m/s", np.outer(z, [1, 0, 0])),
            "fluid_velocity": ("m/s", np.outer(z, [2, 0, 0])), "creep_depth": ("m", depth),
            "creep_velocity": ("m/s", np.exp(-depth / 5e-3 / 0.95))})
        return Run(folder)

    def test_layers_are_read_from_the_surface_up(self):
        bed = two_phases.resolved_bed(Run(self.folder))
        self.assertAlmostEqual(float(np.interp(0.3, bed.solid_fraction[::-1], bed.height[::-1])), 0.0, places=6)
        inside = bed.solid_fraction > 0.0
        # The deviator has 0.4 p in xz and nothing on the diagonal.
        np.testing.assert_allclose(bed.state.friction[inside], 0.4)
        np.testing.assert_allclose(bed.fluid_stress, 5.0)
        # The rate of an exponential is the velocity over its length; a central difference over dz is sinh(dz/l)/(dz/l)
        # of it.
        step = 0.25 / DECAY
        rate = bed.grain_velocity / (DECAY * DIAMETER) * np.sinh(step) / step
        np.testing.assert_allclose(bed.state.shear_rate[5:35], rate[5:35], rtol=1e-9)

    def test_a_flow_to_the_left_is_the_mirror_image(self):
        right = two_phases.resolved_bed(Run(self.folder))
        with h5py.File(self.folder / "profiles.h5", "a") as file:
            for name in ("grain_velocity", "fluid_velocity"):
                file["stress_balance"][name][...] *= [-1.0, 1.0, 1.0]
            for name, columns in (("contact_stress", [2, 6]), ("reynolds_stress", [4])):
                values = file["stress_balance"][name][...]
                values[:, columns] *= -1.0
                file["stress_balance"][name][...] = values
        left = two_phases.resolved_bed(Run(self.folder))
        self.assertEqual((right.axis, left.axis), ("x", "-x"))
        for name in ("grain_velocity", "fluid_velocity", "solid_stress", "fluid_stress"):
            np.testing.assert_allclose(getattr(left, name), getattr(right, name), err_msg=name)
        np.testing.assert_allclose(left.state.friction, right.state.friction)

    def test_decay_length(self):
        bed = two_phases.resolved_bed(Run(self.folder))
        self.assertAlmostEqual(two_phases.decay_length(bed.height, bed.grain_velocity), DECAY, places=6)
        upwards = bed.grain_velocity.copy()
        upwards[bed.height < -4.0] = -1.0                       # from where on they no longer move downhill
        self.assertAlmostEqual(two_phases.decay_length(bed.height, upwards), DECAY, places=6)
        upwards[bed.height < -2.5] = 0.0
        self.assertTrue(np.isnan(two_phases.decay_length(bed.height, upwards)))

    def test_a_decay_that_cannot_be_fitted_is_left_out(self):
        height = np.arange(-8.0, 0.0)
        self.assertEqual(two_phases.e_fold(height, np.exp(height / 1.2), ", "), ", e-fold 1.20 d")
        self.assertEqual(two_phases.e_fold(height, 0.0 * height, ", "), "")

    def test_figure_alone_and_with_a_column(self):
        run, column = Run(self.folder), self.made_up_column()
        for other in (None, column):
            two_phases.comparison_figure(run, other).savefig(self.folder / "figure.png")
            self.assertGreater((self.folder / "figure.png").stat().st_size, 20000)
        self.assertEqual(two_phases.different_materials(run, column), "diameter of the grains 0.00495 and 0.005")

    def test_a_mixture_is_compared_by_its_reference_grain(self):
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace("diameter: 4.95e-3", "diameter: {sizes: [4e-3, 6e-3], fractions: [0.6, 0.4]}"))
        (self.folder / "series.csv").write_text("time [s],reference_diameter [m],reference_density [kg/m^3]\n0,6e-3,2550\n")
        self.assertEqual(two_phases.different_materials(Run(self.folder), self.made_up_column()),
                         "diameter of the grains 0.006 and 0.005")

    def test_a_run_without_stresses_is_refused(self):
        (self.folder / "profiles.h5").unlink()
        with self.assertRaisesRegex(RunFolderError, "stress_balance"):
            two_phases.resolved_bed(Run(self.folder))

    def test_drag_laws(self):
        # At phi -> 0 both laws are those of a single sphere; at phi 0.5 and slow flow 20 + 0.25 (1 + 1.5 sqrt(0.5)).
        self.assertAlmostEqual(beetstra_drag(0.5, 1e-12), 20.515165, places=5)
        self.assertAlmostEqual(tenneti_drag(1e-12, 100.0), 1.0 + 0.15 * 100.0**0.687, places=2)
        # At phi 0.25 and Re 100: 100^-0.343 = 0.206063, 100^0.687 = 23.6592, 10^0.75 = 5.623413, 0.25^(1/3) = 0.629961.
        # Beetstra: 10/4/0.5625 + 0.5625 (1 + 0.75) and 41.3/(24 0.5625) (4/3 + 0.5625 + 8.4 0.206063)/1.056234.
        self.assertAlmostEqual(beetstra_drag(0.25, 100.0), 5.428819 + 3.059259 * 3.626763 / 1.056234, places=5)
        # Tenneti: 0.75 times 4.54888/0.421875 + 1.4525/0.421875 + 0.302381/0.316406 + 1.5625 (0.95 + 0.61/64/0.5625).
        self.assertAlmostEqual(tenneti_drag(0.25, 100.0), 0.75 * (10.782531 + 3.442963 + 0.955674 + 1.510851), places=4)


if __name__ == "__main__":
    unittest.main()
