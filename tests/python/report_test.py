"""`thalweg analyze` on a folder whose answers are known."""
import contextlib
import io
import json
import re
import unittest
import unittest.mock

import h5py
import numpy as np

import made_up_folder as made_up
import thalweg
from thalweg import __main__ as program
from thalweg.report import Report, describe_water, plain, report_of, window
from thalweg.tables import read_series

D, SIZE = 4.95e-3, np.array([0.12, 0.0105, 0.1485])


class Reports(made_up.MadeUpFolder):
    def setUp(self):
        super().setUp()
        few = unittest.mock.patch("thalweg.report.VISIBLE_FRAMES", 2)   # each is looked at pixel by pixel
        few.start()
        self.addCleanup(few.stop)
        time = np.arange(0.0, 4.005, 0.01)
        self.rate = 0.1 + 0.02 * np.sin(20 * np.pi * time)
        rows = [f"{t:.6g},{q:.9g},5" for t, q in zip(time, self.rate)]
        (self.folder / "series.csv").write_text("time [s],q_star [1],moving_grains [1]\n" + "\n".join(rows) + "\n")

    def write_bed(self):
        """24 x 2 grains a layer, ten layers one diameter apart, at rest."""
        x, y, z = np.meshgrid(
            (np.arange(24) + 0.5) * SIZE[0] / 24, (0.3 * SIZE[1], 0.7 * SIZE[1]), (np.arange(10) + 0.5) * D
        )
        places = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
        times = np.arange(0.0, 4.05, 0.1)
        self.write_frames(times, [places] * len(times))

    def test_transport_of_a_window(self):
        report = report_of(thalweg.Run(self.folder), 2.0, 4.0)
        # Twenty whole waves and one value more, which is the mean.
        self.assertAlmostEqual(report.numbers["q_star"]["mean"], 0.1, 9)
        self.assertAlmostEqual(report.numbers["q_star"]["deviation"], 0.02 / np.sqrt(2), 4)
        self.assertTrue(report.numbers["q_star"]["steady"])
        self.assertEqual(report.numbers["moving_grains"]["mean"], 5.0)
        # No frames: said, and no table.
        self.assertTrue(any(line.startswith("surface") and "left out" in line for line in report.lines))
        self.assertEqual(report.profiles, {})

    def test_surface_and_profiles(self):
        self.write_bed()
        report = report_of(thalweg.Run(self.folder))
        self.assertEqual((report.start, report.stop), (1.0, 4.0))   # of the case's transport_rate
        # The top of the grains is at 10 d; the static outline lies on them, at most a radius lower between two.
        static = report.numbers["surface_by_static_pixels"]
        self.assertLess(static["bed_height"], 10.0 * D)
        self.assertGreater(static["bed_height"], 9.5 * D)
        depth = SIZE[2] - static["bed_height"]
        self.assertAlmostEqual(static["depth"], depth, 12)
        radius = depth * SIZE[1] / (2 * depth + SIZE[1])
        self.assertAlmostEqual(static["shields"], np.sin(np.arctan(0.0748)) * radius / (1.55 * D), 9)
        self.assertAlmostEqual(report.numbers["surface_by_solid_fraction"]["bed_height"], 10.0 * D, delta=0.5 * D)
        files = report.write(self.folder / "out")
        self.assertNotIn(b"\r", files[1].read_bytes())
        self.assertEqual([file.name for file in files], ["summary.json", "layers.csv", "visible_grains.csv"])
        self.assertEqual(json.loads(files[0].read_text()), report.numbers)
        layers = read_series(files[1])
        # All of the grains' volume is in the layers.
        volume = np.sum(layers["solid_fraction"]) * SIZE.prod() / len(layers["z"])
        self.assertAlmostEqual(volume / (480 * np.pi / 6 * D**3), 1.0, 6)
        self.assertEqual(layers.units["velocity_x"], "m/s")
        case = self.folder / "case.yaml"
        case.write_text(case.read_text() + "model_fluid: {units: grain}\n")
        self.assertEqual(read_series(report_of(thalweg.Run(self.folder)).write(self.folder / "out")[1]).units["velocity_x"],
                         "sqrt(g'D)")

    def test_no_table_of_other_times_stays_beside_a_new_summary(self):
        self.write_bed()
        out, mine = self.folder / "out", self.folder / "out/mine.csv"
        report_of(thalweg.Run(self.folder)).write(out)
        mine.touch()
        (self.folder / "grains.pvd").unlink()
        self.assertEqual(report_of(thalweg.Run(self.folder)).write(out), [out / "summary.json"])
        self.assertEqual(sorted(out.iterdir()), [mine, out / "summary.json"])

    def test_rows_without_a_number_do_not_count(self):
        rows = [f"{t:.6g},{q},{n}" for t, q, n in zip(np.arange(0.0, 4.005, 0.01), self.rate, [4, 6] * 201)]
        rows[250], rows[300] = "2.5,nan,nan", "3,0.1,nan"
        (self.folder / "series.csv").write_text("time [s],q_star [1],moving_grains [1]\n" + "\n".join(rows) + "\n")
        numbers = report_of(thalweg.Run(self.folder), 2.0, 4.0).numbers
        self.assertEqual(numbers["q_star"]["measurements"], 200)
        self.assertAlmostEqual(numbers["q_star"]["mean"], 0.1, 4)
        self.assertAlmostEqual(numbers["moving_grains"]["mean"], 5.0, 1)

    def test_what_is_no_number_is_null(self):
        report = report_of(thalweg.Run(self.folder), 2.0, 4.0)
        report.numbers["one_row"] = {"error": float("nan"), "steps": [np.float64("inf"), 1.5], "steady": None}

        def refuse(word):
            self.fail(f"{word} is not JSON")

        text = report.write(self.folder / "analysis")[0].read_text()
        self.assertEqual(
            json.loads(text, parse_constant=refuse)["one_row"], {"error": None, "steps": [None, 1.5], "steady": None}
        )

    def test_the_shields_number_under_a_moving_top_is_the_measured_one(self):
        self.write_bed()
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace("top: free_slip", "top: {type: moving, velocity: [0.1, 0, 0]}"))
        numbers = report_of(thalweg.Run(self.folder)).numbers
        self.assertNotIn("shields", numbers["surface_by_static_pixels"])
        (self.folder / "series.csv").write_text("time [s],shields_number [1]\n0.5,9\n1.0,0.1\n2.0,0.2\n3.0,0.6\n")
        report = report_of(thalweg.Run(self.folder))
        self.assertAlmostEqual(report.numbers["surface_by_solid_fraction"]["shields"], 0.3, 12)
        self.assertTrue(any("as measured" in line for line in report.lines))
        self.assertNotIn(
            "shields", report.numbers["surface_by_static_pixels"]
        )  # the top's share of the stress is not known

    def test_the_shields_number_of_a_held_flow_by_static_pixels_goes_with_the_hydraulic_radius(self):
        self.write_bed()
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace("fluid: {", "fluid: {mean_velocity: [0.5, 0, 0], ", 1))
        (self.folder / "series.csv").write_text(
            "time [s],shields_number [1],hydraulic_radius [m]\n1.0,0.1,4e-3\n4.0,0.3,6e-3\n"
        )
        numbers = report_of(thalweg.Run(self.folder)).numbers
        self.assertAlmostEqual(numbers["surface_by_solid_fraction"]["shields"], 0.2, 12)
        depth = numbers["surface_by_static_pixels"]["depth"]
        radius = depth * SIZE[1] / (2 * depth + SIZE[1])
        self.assertAlmostEqual(numbers["surface_by_static_pixels"]["shields"], 0.2 * radius / 5e-3, 12)

    def write_water(self, shape):
        """profiles.h5 with the fluid at shape (fractions of one, across the width) from 0.06 m up and at rest below."""
        z = (np.arange(297) + 0.5) * 0.5e-3
        velocity = np.zeros((297, len(shape), 3))
        velocity[..., 0] = np.where(z[:, None] > 0.06, shape, 0.0)
        with h5py.File(self.folder / "profiles.h5", "w") as file:
            group = file.create_group("fluid_statistics")
            group["z"], group["section_velocity"] = z, velocity
            group["section_fluid_fraction"] = np.ones(velocity.shape[:2])

    def test_water_between_side_walls(self):
        self.write_bed()
        missing = report_of(thalweg.Run(self.folder))
        self.assertTrue(any(line.startswith("water") and "left out" in line for line in missing.lines))
        # Half of 10.5 mm and a slope of 0.0748 make u_tau = 0.0619 m/s, and y+ = 325 in the middle. The mean by the
        # integrals of y+ up to 10.8, and of ln(y+)/0.41 + 5 from there.
        friction_velocity = np.sqrt(9.8 * np.sin(np.arctan(0.0748)) * 5.25e-3)
        middle = friction_velocity * (np.log(friction_velocity * 5.25e-3 / 1e-6) / 0.41 + 5.0)
        width, sublayer = friction_velocity * 5.25e-3 / 1e-6, 10.8
        log_law = [end * (np.log(end) - 1) / 0.41 + 5 * end for end in (sublayer, width)]
        mean = friction_velocity * (0.5 * sublayer**2 + log_law[1] - log_law[0]) / width
        self.assertAlmostEqual(middle, 1.184, 2)
        for shape in (np.array([0.8, 1.0, 0.8]) * middle, np.array([0.8, 1.0, 1.0, 0.8]) * middle):
            self.write_water(shape)
            report = report_of(thalweg.Run(self.folder))
            found = report.numbers["water"]
            self.assertAlmostEqual(found["law_of_the_wall"]["middle"], middle, 9)
            self.assertAlmostEqual(found["law_of_the_wall"]["mean"] / mean, 1.0, 4)
            self.assertAlmostEqual(found["middle_speed"], middle, 9)
            self.assertAlmostEqual(found["mean_speed"], shape.mean(), 9)
            self.assertTrue(any(line.startswith("water") and "(+0.0 %)" in line for line in report.lines))

    def test_water_that_the_slope_and_the_side_walls_alone_do_not_rule_is_not_compared(self):
        self.write_water(np.array([0.8, 1.0, 0.8]))
        inlet = "x_low: {type: velocity_inlet, velocity: [0.5, 0, 0]}, x_high: pressure_outlet"
        wall, top = "type: law_of_the_wall", "top: free_slip"
        for what, instead, compared in (
            (wall, wall, True), (wall, "type: no_slip", True), (wall, "type: slip_law_of_the_wall", True),
            (wall, "type: free_slip", False), (wall, "type: moving, velocity: [0.5, 0, 0]", False),
            (wall, "type: navier_slip, slip_length: 1e-3", False), (top, "top: no_slip", False),
            (top, "top: {type: moving, velocity: [0.5, 0, 0]}", False), ("slope: 0.0748", "slope: 0.0", False),
            ("x: periodic", inlet, False), ("x: periodic", "x: no_slip", False),
            ("fluid: {", "fluid: {mean_velocity: {velocity: 0.5, response_time: 0.1}, ", False),
            ("analysis:", "solids: [{stl: pier.stl}]\nanalysis:", False),
        ):
            (self.folder / "case.yaml").write_text(made_up.CASE.replace(what, instead))
            report = Report(thalweg.Run(self.folder))
            describe_water(report, 0.05)
            self.assertEqual(("water" in report.numbers, len(report.lines)), (compared, int(compared)), instead)

    def test_a_mean_from_the_start_on_and_none_at_all(self):
        case = self.folder / "case.yaml"
        text = case.read_text()
        for analysis, start in (("{transport_rate: {from: 0}}", 0.0), ("{transport_rate: {}}", 0.0), ("{}", 2.0)):
            case.write_text(text.replace("{transport_rate: {from: 1.0}}", analysis))
            self.assertEqual(window(thalweg.Run(self.folder)), (start, 4.0))

    def test_the_mean_of_the_run_itself(self):
        """Where no times are given it is that of summary.json, which may be of more measurements than series.csv has
        rows."""
        means = {
            "q_s_independent": 25.0, "q_star_mean": 0.1234, "q_star_error": 0.002, "q_star_deviation": 0.01,
            "steady": -2, "q_star_drift": 0.05, "q_star_drift_error": 0.01, "measured_from": 1.0,
            "measured_until": 3.99, "measurements": 2991, "moving_grains_mean": 7.0, "moving_grains_error": None,
            "mean_from": 1.0,
        }
        (self.folder / "summary.json").write_text(json.dumps({"finished": True, "transport_rate": means}))
        run = thalweg.Run(self.folder)
        report = report_of(run)
        self.assertIn(
            "transport  q* = 0.1234 +- 0.002, deviation 0.01, from 1 to 3.99 s (2991 measurements worth 25 independent "
            "ones)", report.lines,
        )
        self.assertIn(
            (
                "transport  too short a time to tell whether it is steady: a straight line through it changes by +0.05"
                " +- 0.01 over this time, which is within chance, but may be half of the mean"
            ), report.lines,
        )
        report.write(self.folder / "out")
        numbers = json.loads((self.folder / "out/summary.json").read_text(), parse_constant=self.fail)
        self.assertEqual(numbers["moving_grains"], {"mean": 7.0, "error": None})
        self.assertAlmostEqual(report_of(run, 1.0).numbers["q_star"]["mean"], 0.1, 3)   # of the rows

    def test_a_run_that_ended_between_two_rows(self):
        (self.folder / "summary.json").write_text('{"simulated_time": 4.0037}')
        self.assertIn("1 to 4 s of 4.0037 s", report_of(thalweg.Run(self.folder)).lines[0])

    def test_numbers_of_grains_have_no_exponent(self):
        for number, digits, text in ((103.2, 2, "100"), (12345.6, 4, "12350"), (6.32, 2, "6.3"), (0.0, 2, "0")):
            self.assertEqual(plain(number, digits), text)

    def test_times(self):
        run = thalweg.Run(self.folder)
        self.assertEqual(window(run), (1.0, 4.0))
        self.assertEqual(window(run, 0.0), (0.0, 4.0))
        self.assertEqual(window(run, -1.0, 50.0), (0.0, 4.0))   # what series.csv has
        report = report_of(run, 2.0, 50.0)
        self.assertEqual(report.numbers["until"], 4.0)
        self.assertTrue(any(line.startswith("window") and "shorter than wanted" in line for line in report.lines))
        for start, stop in ((5.0, None), (2.0, 1.0), (-2.0, -1.0)):
            with self.assertRaisesRegex(thalweg.RunFolderError, "nothing to average"):
                window(run, start, stop)
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace("analysis: {transport_rate: {from: 1.0}}", "model_fluid: {units: grain}"))
        run = thalweg.Run(self.folder)
        self.assertEqual(window(run, stop=50.0), (2.0, 4.0))   # from the middle of the run on, which ends before that
        with self.assertRaisesRegex(thalweg.RunFolderError, re.escape("from 5 to 4 sqrt(D/g'): the run has rows")):
            window(run, 5.0)

    def test_a_series_without_time_is_said_in_a_sentence(self):
        (self.folder / "series.csv").write_text("step [1],q_star [1]\n0,1\n")
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            self.assertEqual(program.main(["analyze", str(self.folder)]), 2)
        self.assertIn("series.csv: there is no 'time'", said.getvalue())

    def test_the_command(self):
        self.assertEqual(program.main(["analyze", str(self.folder), "--from", "2"]), 0)
        numbers = json.loads((self.folder / "analysis" / "summary.json").read_text())
        self.assertEqual(numbers["from"], 2.0)
        self.assertEqual(program.main(["analyze", str(self.folder / "elsewhere")]), 2)


class OtherSystems(made_up.MadeUpFolder):
    def write(self, case, table):
        (self.folder / "case.yaml").write_text(case)
        (self.folder / "series.csv").write_text(table)

    def refusal(self, *arguments):
        """What the command says on its way out with exit code 2."""
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            self.assertEqual(program.main([*arguments, str(self.folder)]), 2)
        return said.getvalue()

    def test_a_column_of_two_continua_is_told_by_its_last_state(self):
        self.write("system: continuum\nname: Column\nfluid: {density: 1000}\ngrains: {diameter: 5e-3, density: 2550}\n"
                   "gravity: {magnitude: 9.8, slope: 0.016}\n",
                   "time [s],q_star [1],shields_number [1],surface_height [m],moving_depth [m],unsteadiness [1]\n"
                   "0,0,0.085,0.025,0,1\n5,0.06,0.087,0.024,1e-3,1\n10,0.08,0.088,0.023,2e-3,1e-5\n")
        report = report_of(thalweg.Run(self.folder))
        self.assertEqual(report.numbers["continuum"]["q_star"], 0.08)
        self.assertTrue(any("q* = 0.08 at 10 s" in line for line in report.lines))
        self.assertTrue(any("2 mm of grains in motion: Shields number 0.088" in line for line in report.lines))
        earlier = report_of(thalweg.Run(self.folder), stop=7.0).numbers
        self.assertEqual((earlier["until"], earlier["continuum"]["q_star"]), (5.0, 0.06))
        for kind in ("side", "film", "picture"):
            self.assertIn("neither grains nor flow in space to show; thalweg plot profiles", self.refusal("plot", kind))
        self.assertIn("the run writes them at its end", self.refusal("plot", "profiles"))
        for kind in ("relation", "visible"):
            self.assertIn("a run of system: continuum has no box.", self.refusal("plot", kind))

    def test_a_fluid_is_told_by_its_mean_velocity(self):
        self.write("system: fluid\nname: Water\ndomain: {size: [0.1, 0.1, 0.1], spacing: 1e-3,\n"
                   "  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}}\n"
                   "fluid: {density: 1000, kinematic_viscosity: 1e-6}\n"
                   "gravity: {magnitude: 9.8, slope: 0.01}\n",
                   "time [s],mean_velocity_x [m/s]\n" + "".join(f"{n},{0.3 + 0.1 * (-1) ** n}\n" for n in range(11)))
        report = report_of(thalweg.Run(self.folder), 1.0, 10.0)   # ten rows, half of them 0.2 and half 0.4
        self.assertAlmostEqual(report.numbers["mean_velocity_x"]["mean"], 0.3, 12)
        self.assertTrue(any("mean velocity 0.3" in line for line in report.lines))
        self.assertIn("a run of system: fluid has no grains.", self.refusal("plot", "visible"))

    def test_dry_grains_have_no_density_ratio(self):
        self.write(made_up.CASE.replace("resolved", "grains").replace("fluid:", "unknown:"), "time [s]\n0\n")
        with self.assertRaisesRegex(thalweg.RunFolderError, "a run of system: grains has no fluid"):
            thalweg.Run(self.folder).density_ratio


if __name__ == "__main__":
    unittest.main()
