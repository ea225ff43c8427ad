#!/usr/bin/env python3
"""Beds: poured until at rest, written to a file, and read by other cases.

Called by ctest: bed_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest

MASS = 2550 * numpy.pi / 6 * 5e-3 ** 3


class BedRun(ProgramTest):
    CASE = """
system: grains
name: pour
domain:
  size: [0.02, 0.015, 0.06]
  spacing: 1.0e-3
  boundaries: {x: periodic, y: no_slip, bottom: no_slip, top: no_slip}
gravity: {magnitude: 9.8, slope: 0.05}
grains:
  - {count: 40, diameter: 5.0e-3, density: 2550, placement: {pattern: random, seed: 2}}
contact: {restitution: 0.4, tangential_damping: 0.5}
run: {until: 2.0, until_at_rest: {largest_speed: 2.0e-4, largest_acceleration: 0.01}}
output: {series: {every: 0.02}}
"""
    FILE = "grains=[{placement: {file: run/bed.h5}}]"

    def setUp(self):
        super().setUp()
        self.run_well("run", self.case)

    def test_the_file_has_the_same_bytes_on_any_ranks(self):
        for out, ranks, layout in (("one", 0, "1,1,1"), ("two", 2, "2,1,1"), ("four", 4, "2,1,2")):
            self.run_well("run", self.case, "--out", out, "--layout", layout, "--set", "run={until: 0.02}", ranks=ranks)
            self.assertEqual((self.folder / out / "bed.h5").read_bytes(), (self.folder / "one/bed.h5").read_bytes())

    def test_a_box_of_cells_to_seven_digits_takes_its_own_bed(self):
        cells = (
            "--set", "domain.spacing=8.333333e-4", "--set", "domain.size=[0.02, 0.015, 0.06]",
        )  # 24 x 18 x 72, and 4e-8
        self.run_well("run", self.case, *cells, "--out", "rounded", "--set", "run={until: 0.3}")
        for ranks in (0, 2):
            self.run_well(
                "run", self.case, *cells, "--out", f"again_{ranks}", "--set",
                "grains=[{placement: {file: rounded/bed.h5}}]", "--set", "run={until: 0.02}", ranks=ranks,
            )
        self.assert_same_bed("again_0", "again_2")

    def test_the_grains_are_at_rest_on_each_other(self):
        summary = self.summary("run")
        self.assertTrue(summary["finished"])
        self.assertLess(summary["simulated_time"], 1.9)
        bed = self.bed()
        self.assertEqual(bed["id"].tolist(), list(range(40)))
        self.assertTrue((bed["radius"] == 2.5e-3).all())
        numpy.testing.assert_allclose(bed["density"], 2550, rtol=1e-14)
        self.assertLess(numpy.linalg.norm(bed["velocity"], axis=1).max(), 2e-4)
        # All lie on each other: between the densest packing (0.74) and one too loose to stand (0.4) in a layer below
        # the highest surface.
        top = bed["position"][:, 2].max() + 2.5e-3
        fraction = 40 * MASS / 2550 / (0.02 * 0.015 * top)
        self.assertTrue(0.4 < fraction < 0.74, fraction)

    def test_a_share_of_the_grains_at_rest_is_enough(self):
        share = ["--set", "run.until_at_rest.quantile=0.9"]
        self.run_well("run", self.case, "--out", "one", *share)
        summary = self.summary("one")
        self.assertTrue(summary["finished"])
        self.assertLess(summary["simulated_time"], self.summary("run")["simulated_time"])
        restless = (numpy.linalg.norm(self.bed("one")["velocity"], axis=1) >= 2e-4).sum()
        self.assertTrue(0 < restless <= 4, restless)
        self.assertIn("a share of 0.9 of the grains at rest", (self.folder / "one/run.log").read_text())
        # All 40 fall at first; the figure is the same on any ranks.
        for out, ranks in (("first", 0), ("two", 2)):
            self.run_well(
                "run", self.case, "--out", out, *share, "--until", "0.004", "--set", "output.series.every=0.002",
                ranks=ranks,
            )
            self.assertEqual(self.series(out)["restless_grains"].tolist(), [40, 40, 40])

    def test_the_share_at_rest_is_one_of_the_grains_that_are_there(self):
        # Nearly all fall into the sink, and a tenth of what there was at the start is left, on its way.
        case = self.folder / "drained.yaml"
        case.write_text(
            """
system: grains
domain: {size: [0.06, 0.06, 0.40], spacing: 5.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}}
gravity: {magnitude: 9.8}
grains:
  - {count: 100, diameter: 4.0e-3, density: 2550,
     placement: {pattern: random, seed: 1, region: {lower: [0, 0, 0.02], upper: [0.06, 0.06, 0.39]}}}
sinks: [{region: {lower: [0, 0, 0], upper: [0.054, 0.06, 0.015]}}]
contact: {normal_stiffness: 2000, restitution: 0.9, friction: 0.3, wall_friction: 0.3}
run: {until: 0.32, until_at_rest: {largest_speed: 1.0e-3, largest_acceleration: 0.05, quantile: 0.9}}
output: {series: {every: 0.01}}
"""
        )
        said = self.run_well("run", case, "--out", "drained").stdout
        known = self.series("drained")
        self.assertLessEqual(known["restless_grains"][-1], 10)   # of the 100 at the start nine tenths are not restless
        self.assertGreater(known["restless_share"][-1], 0.5)
        self.assertIn("not at rest at the last check", said)

    def test_a_fill_is_as_deep_as_it_says(self):
        fill = [
            "--set",
            "grains=[{fill: {depth: 0.024, porosity: 0.45}, diameter: {d16: 3.5e-3, d50: 4.0e-3, d84: 4.6e-3}, "
            "density: 2550, placement: {pattern: random, seed: 3}}]",
        ]
        self.run_well("run", self.case, "--out", "filled", *fill)
        bed = self.bed("filled")
        volume = numpy.pi / 6.0 * ((2.0 * bed["radius"]) ** 3).sum()
        floor = 0.02 * 0.015
        self.assertLess(abs(volume - 0.55 * 0.024 * floor), numpy.pi / 6.0 * (2.0 * bed["radius"].max()) ** 3)
        # The surface of the bed is rough: the tops of its highest grains are up to a diameter above its mean height.
        self.assertTrue(0.024 - 2e-3 < (bed["position"][:, 2] + bed["radius"]).max() < 0.024 + 6e-3)
        # The number is that of the case as run, on any ranks and after a restart.
        self.run_well("run", self.case, "--out", "two", *fill, "--set", "run={until: 0.004}", ranks=2)
        self.run_well("run", self.case, "--out", "half", *fill, "--set", "run={until: 0.002}")
        self.run_well("run", self.folder / "half/case.yaml", "--out", "half", "--restart", "half", "--until", "0.004")
        self.assertEqual((self.folder / "half/bed.h5").read_bytes(), (self.folder / "two/bed.h5").read_bytes())

    def test_every_dataset_has_its_unit(self):
        with h5py.File(self.folder / "run/bed.h5") as file:
            units = {
                name: data.attrs["units"].decode() for name, data in file["grains"].items() if "units" in data.attrs
            }
            self.assertEqual(units, {"id": "1", "radius": "m", "density": "kg/m^3", "position": "m",
                                     "velocity": "m/s", "angular_velocity": "rad/s"})
            self.assertEqual(file["bed/box"][()].tolist(), [0.02, 0.015, 0.06])
            self.assertEqual(file["bed/periodic"][()].tolist(), [1, 0, 0])

    def test_another_run_begins_with_the_bed(self):
        # One step of 2.04e-4 s: 4.1e-8 m at 2e-4 m/s, and g t^2/2 = 2.04e-7 m while the springs along the contacts,
        # which the file does not keep, build up again.
        self.run_well("run", self.case, "--out", "next", "--set", self.FILE, "--set", "run={until: 1.0e-4}", ranks=2)
        before, after = self.bed(), self.bed("next")
        numpy.testing.assert_allclose(after["position"], before["position"], rtol=0, atol=2.5e-7)
        self.assertEqual(after["radius"].tolist(), before["radius"].tolist())
        # ... and the bed stays where it is: far longer than a grain needs to fall a diameter (0.03 s).
        self.run_well("run", self.case, "--out", "later", "--set", self.FILE, "--set", "run={until: 0.2}")
        moved = numpy.linalg.norm(self.bed("later")["position"] - before["position"], axis=1)
        self.assertLess(moved.max(), 0.02 * 5e-3)
        # The case kept in the run folder is valid in itself: its path of the bed file is relative to the folder.
        self.run_well("run", self.folder / "next/case.yaml", "--out", "again")
        self.assertEqual((self.folder / "again/bed.h5").read_bytes(), (self.folder / "next/bed.h5").read_bytes())

    def test_two_populations_share_a_bed(self):
        top = 0.06
        shared = ("grains=[{placement: {file: run/bed.h5, region: {lower: [0, 0, 0], upper: [0.02, 0.015, 0.004]}}, "
                  "fixed: true}, {placement: {file: run/bed.h5, velocities: zero, "
                  f"region: {{lower: [0, 0, 0.004], upper: [0.02, 0.015, {top}]}}}}}}]")
        self.run_well("run", self.case, "--out", "glued", "--set", shared, "--set", "run={until: 0.01}")
        before, after = self.bed()["position"], self.bed("glued")["position"]
        low = before[:, 2] < 0.004
        numpy.testing.assert_array_equal(after[:low.sum()], before[low])
        self.assertEqual(len(after), 40)

    def test_a_resolved_case_begins_with_the_bed(self):
        self.run_well("run", self.case, "--out", "wet", "--set", self.FILE, "--set", "system=resolved",
                      "--set", "fluid={density: 1000, kinematic_viscosity: 1.0e-6, smagorinsky_constant: 0.27, "
                      "time_step: 1.0e-4}", "--set", "run={until: 5.0e-4}")
        # In 0.5 ms under gravity, grains not quite held by their contacts fall by g t^2/2 = 1.2e-6 m at most.
        moved = numpy.linalg.norm(self.bed("wet")["position"] - self.bed()["position"], axis=1)
        self.assertLess(moved.max(), 2e-6)

    def test_beds_that_do_not_fit_are_refused(self):
        place = "grains.0.placement.file"
        for words, settings in (
            (["there is no file", "no.h5", place], ["grains=[{placement: {file: no.h5}}]"]),
            (
                ["not a bed file", place],
                ["grains=[{placement: {file: run/checkpoints/" + self.last_checkpoint("run").name + "}}]"],
            ), (["not an HDF5 file", place], ["grains=[{placement: {file: run/run.log}}]"]),
            (["periodic along x over 0.02 m", "periodic over 0.03 m"], [self.FILE, "domain.size=[0.03, 0.015, 0.06]"]),
            (["not periodic over 0.02 m"], [self.FILE, "domain.boundaries.x=no_slip"]),
            (["outside this case's box", "domain.size"], [self.FILE, "domain.size=[0.02, 0.015, 0.006]"]),
            (
                ["overlap", "placement.largest_overlap: 1e-08", place],
                ["grains=[{placement: {file: run/bed.h5, largest_overlap: 1.0e-8}}]"],
            ),
            (
                ["no grain in the region"],
                [
                    "grains=[{placement: {file: run/bed.h5, region: {lower: [0, 0, 0.059], "
                    "upper: [0.02, 0.015, 0.06]}}}]"
                ],
            ),
            (
                ["grains.0.diameter", "the bed file gives it"],
                ["grains=[{placement: {file: run/bed.h5}, diameter: 4.0e-3}]"],
            ),
            (["grains.0.placement.velocities", "only a placement from a file"], ["grains.0.placement.velocities=zero"]),
            (["run.until_at_rest.quantile = 1.5", "at most 1"], ["run.until_at_rest.quantile=1.5"]),
            (["run.until_at_rest.largest_speed", "above 0"], ["run.until_at_rest.largest_speed=0"]),
        ):
            arguments = [a for setting in settings for a in ("--set", setting)]
            self.assert_refused("check", self.case, *arguments, words=words)


program.main()
