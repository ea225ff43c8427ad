#!/usr/bin/env python3
"""Runs that go on: with which case, what may differ from before, and what is kept of that.

Called by ctest: restart_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import json
import shutil
import subprocess
import sys
import time
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest, contents_below


class RestartRun(ProgramTest):
    CASE = """
system: grains
name: restart
domain:
  size: [0.05, 0.03, 0.05]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: no_slip, bottom: no_slip, top: free_slip}
gravity: {magnitude: 9.8, slope: 0.3}
grains: [{count: 40, diameter: 5.0e-3, density: 2550, placement: {pattern: random, seed: 3}}]
contact: {normal_stiffness: 2000, tangential_stiffness: 571, restitution: 0.7, friction: 0.3, wall_friction: 0.3}
run: {until: 0.05, time_step: 1.0e-5}
output: {series: {every: 0.01}}
"""

    def setUp(self):
        super().setUp()
        self.run_well("run", self.case)

    def test_the_same_case_has_nothing_to_tell(self):
        said = self.run_well("run", self.case, "--restart", "run").stdout
        self.assertNotIn("changed since then", said)

    def test_a_run_that_is_at_its_end_keeps_its_results(self):
        def results():
            summary = json.loads((self.folder / "run/summary.json").read_text())
            return {name: group for name, group in summary.items() if name in ("grain_energy", "population_loads")}

        loads = ("--set", "analysis.population_loads={}", "--out", "run", "--overwrite")
        self.run_well("run", self.case, *loads)
        before = results()
        self.assertNotEqual(before["grain_energy"]["grain_kinetic_energy"], 0.0)
        self.run_well("run", self.case, "--restart", "run", *loads[:2])
        self.assertEqual(results(), before)

    def test_what_has_changed_is_told_and_kept(self):
        said = self.run_well(
            "run", self.case, "--restart", "run", "--until", "0.1", "--set", "contact.friction=0.4"
        ).stdout
        self.assertIn("changed since then: run.until: 0.05 -> 0.1", said)
        self.assertIn("changed since then: contact.friction: 0.3 -> 0.4", said)
        log = (self.folder / "run/run.log").read_text()
        self.assertIn("contact.friction: 0.3 -> 0.4", log)
        # A checkpoint is told from the case that made it, not from the folder's present one.
        said = self.run_well(
            "run", self.case, "--restart", "run/checkpoints/step_100.h5", "--out", "other", "--until", "0.06"
        )
        self.assertNotIn("contact.friction", said.stdout)
        # A setting that is not repeated is told as well.
        said = self.run_well("run", self.case, "--restart", "run", "--until", "0.15").stdout
        self.assertIn("changed since then: contact.friction: 0.4 -> 0.3", said)
        kept = {path.name: path.read_text() for path in (self.folder / "run").glob("case*.yaml")}
        self.assertEqual(sorted(kept), ["case.yaml", "case_until_step_100.yaml", "case_until_step_200.yaml"])
        self.assertIn("friction: 0.3\n", kept["case_until_step_100.yaml"])
        self.assertIn("friction: 0.4\n", kept["case_until_step_200.yaml"])
        self.run_well("run", self.case, "--overwrite")
        self.assertEqual(len(list((self.folder / "run").glob("case*.yaml"))), 1)

    def test_grains_that_the_checkpoint_has_cannot_be_changed(self):
        for key, value in (("grains.0.density", "2650"), ("grains.0.diameter", "4e-3"), ("grains.0.count", "41")):
            self.assert_refused("run", self.case, "--restart", "run", "--set", f"{key}={value}", "--until", "0.1",
                                words=[key, "in its checkpoint", "initial.from"])

    def test_grains_are_not_placed_again(self):
        # Forty grains would fill 58 % of this, more than a random packing can: a new run is refused, and one that goes
        # on does not look for it.
        tight = (
            "--set", "grains.0.placement.region={lower: [0, 0, 0], upper: [0.0165, 0.0165, 0.0165]}", "--until", "0.1",
        )
        self.assert_refused("run", self.case, "--out", "new", *tight, words=["grains.0", "region"])
        self.run_well("run", self.case, "--out", "straight", "--until", "0.1")
        self.run_well("run", self.case, "--restart", "run", *tight, ranks=2)
        self.assert_same_bed("run", "straight")

    def test_in_another_folder_too(self):
        checkpoint = self.last_checkpoint("run")
        self.assert_refused(
            "run", self.case, "--restart", checkpoint, "--out", "other", "--set", "grains.0.density=2650",
            words=["grains.0.density = 2650", "2550"],
        )
        said = self.run_well("run", self.case, "--restart", checkpoint, "--out", "other", "--until", "0.1").stdout
        self.assertIn("changed since then: run.until: 0.05 -> 0.1", said)


    def begin(self, *arguments):
        """A run that goes on beside the test, which ends it."""
        process = subprocess.Popen(self.command(("run", self.case, *arguments, "--until", "1000"), 0), cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def wait_until(self, happened):
        deadline = time.monotonic() + 60.0
        while not happened():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)

    def test_a_second_run_is_kept_out_of_the_folder(self):
        process = self.begin("--restart", "run", "--set", "gravity.slope=0")   # or they would get too fast
        self.wait_until(lambda: len((self.folder / "run/series.csv").read_text().splitlines()) > 8)
        for way in (("--restart", "run"), ("--overwrite",)):
            refused = self.thalweg("run", self.case, *way, "--until", "2000")
            self.assertEqual(refused.returncode, 2, refused.stdout + refused.stderr)
            self.assertIn("a run is writing there now (process ", refused.stderr)
        self.assertIsNone(process.poll())
        process.kill()   # the lock goes with the process, however that ends
        process.wait()
        self.run_well("run", self.case, "--restart", "run", "--until", "0.06")

    def test_a_course_that_was_left_is_not_taken_up_again(self):
        self.run_well("run", self.case, "--restart", "run", "--until", "0.1")
        other = ("--set", "contact.friction=0.9", "--set", "output.checkpoint.every_wall=0")
        process = self.begin("--restart", "run/checkpoints/step_100.h5", *other)
        latest = self.folder / "run/checkpoints/latest"
        self.wait_until(lambda: latest.read_text() == "step_100.h5\n")
        self.wait_until(lambda: not (self.folder / "run/bed.h5").exists())   # of the course that was left
        process.kill()   # before it has a checkpoint of its own
        process.wait()
        said = self.run_well("run", self.case, "--restart", "run", "--until", "0.12", *other).stdout
        self.assertIn("step_100.h5 at 0.05 s", said)
        self.assertIn("changed since then: contact.friction: 0.3 -> 0.9", said)
        self.run_well("run", self.case, "--out", "first", "--until", "0.05")
        self.run_well("run", self.case, "--restart", "first", "--until", "0.12", *other)
        self.assert_same_bed("run", "first")

    def test_a_table_that_cannot_be_continued_is_refused_and_nothing_is_touched(self):
        kept = contents_below(self.folder)
        refused = self.thalweg(
            "run", self.case, "--restart", "run", "--until", "0.1", "--set", "analysis.transport_rate={}"
        )
        self.assertEqual(refused.returncode, 2)
        self.assertIn("series.csv: the file has other columns than this run writes, without q_s", refused.stderr)
        self.assertEqual(contents_below(self.folder), kept)

    def test_a_checkpoint_that_has_left_its_folder_is_compared_too(self):
        shutil.copy(self.last_checkpoint("run"), self.folder / "copy.h5")
        on = ("run", self.case, "--restart", "copy.h5", "--out", "on", "--until", "0.06")
        for key, value in (
            ("grains.0.density", "2650"), ("domain.boundaries.bottom", "{type: moving, velocity: [0.1, 0, 0]}"),
        ):
            self.assert_refused(
                *on, "--set", f"{key}={value}", words=["copy.h5: ", key, "set the key back", "initial.from"]
            )
        self.run_well(*on)


class RestartOfSums(ProgramTest):
    """What is summed up over a run goes on with it, or says from when it counts."""
    CASE = RestartRun.CASE

    def test_largest_figures_go_on(self):
        rate = ("--set", "analysis.transport_rate={}")
        self.run_well("run", self.case, "--out", "straight", "--until", "0.1", *rate)
        # Grains fall for 0.05 s: the largest acceleration and overlap come early or late, and both count.
        self.run_well("run", self.case, "--until", "0.033", *rate)
        self.run_well("run", self.case, "--restart", "run", "--until", "0.1", *rate, ranks=2)
        straight, resumed = self.summary("straight"), self.summary("run")
        self.assertEqual(resumed["largest"], straight["largest"])
        self.assertEqual(resumed["largest_from"], 0.0)
        self.assertEqual(resumed["transport_rate"], straight["transport_rate"])
        self.assert_same_end("run", "straight")

    def test_what_is_added_says_from_when_it_counts(self):
        self.run_well("run", self.case, "--out", "first")
        with_rate = ("--out", "second", "--set", "analysis.transport_rate={from: 0.02}", "--until")
        said = self.run_well("run", self.case, "--restart", "first", *with_rate, "0.1").stdout
        self.assertIn("analysis.transport_rate: averaging starts at 0.05 s", said)
        self.assertEqual(self.summary("second")["transport_rate"]["mean_from"], 0.05)
        # And still after another restart.
        self.run_well("run", self.case, "--restart", "second", *with_rate, "0.12")
        self.assertEqual(self.summary("second")["transport_rate"]["mean_from"], 0.05)


class RestartOfACopy(ProgramTest):
    """A checkpoint that lies in no run folder."""
    CASE = """
system: fluid
name: a flow
domain:
  size: [0.0128, 0.0128, 0.0192]
  spacing: 0.8e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-4, time_step: 1.0e-4, precision: double}
gravity: {magnitude: 9.8, slope: 0.1}
run: {until: 0.001}
output: {series: {every: 0.001}}
"""

    def setUp(self):
        super().setUp()
        self.run_well("run", self.case)
        shutil.copy(self.last_checkpoint("run"), self.folder / "copy.h5")

    def test_as_many_cells_of_another_size_are_refused(self):
        wider = ("--set", "domain.size=[0.0256, 0.0256, 0.0384]", "--set", "domain.spacing=1.6e-3", "--until", "0.002")
        for ranks in (0, 2):
            self.assert_refused("run", self.case, "--restart", "copy.h5", "--out", "wider", *wider, ranks=ranks,
                                words=["copy.h5: ", "domain.spacing is 0.0008 m", "0.0016 m", "initial.from"])
        self.run_well("run", self.case, *wider, "--out", "wider")   # the case itself can be run

    def test_cells_of_the_same_size_go_on(self):
        for number, spacing in enumerate(("0.8e-3", "0.00080000000000001")):   # but for rounding
            self.run_well(
                "run", self.case, "--restart", "copy.h5", "--set", f"domain.spacing={spacing}", "--until", "0.002",
                "--out", f"on_{number}",
            )

    def test_another_number_of_cells_is_refused(self):
        self.assert_refused(
            "run", self.case, "--restart", "copy.h5", "--out", "longer", "--set",
            "domain.size=[0.0256, 0.0128, 0.0192]", "--until", "0.002",
            words=["copy.h5: ", "domain.size = [0.0256", "set the key back"],
        )

    def test_as_a_start_of_a_new_run_its_cells_may_differ(self):
        finer = ("--set", "domain.spacing=0.4e-3", "--set", "fluid.time_step=0.5e-4")
        self.run_well("run", self.case, "--set", "initial={from: copy.h5, fields: [fluid]}", *finer, "--out", "finer")


class RestartWithoutBedFile(ProgramTest):
    """What a bed file gives (sizes, densities, clumps, and the time step that follows) is in the checkpoint."""
    PAIR = "shape: {clump: [{position: [0, 0, 0], diameter: 4.0e-3}, {position: [2.0e-3, 0, 0], diameter: 3.0e-3}]}"
    BED = f"""
system: grains
name: bed
domain:
  size: [0.04, 0.03, 0.05]
  spacing: 0.5e-3
  boundaries: {{x: periodic, y: no_slip, bottom: no_slip, top: free_slip}}
gravity: {{magnitude: 9.8, slope: 0.0}}
grains:
  - {{count: 15, diameter: {{distribution: lognormal, median: 4.0e-3, geometric_deviation: 1.2, minimum: 3.0e-3, maximum: 5.0e-3}}, density: 2550, placement: {{pattern: random, seed: 3}}}}
  - {{count: 8, density: 2650, {PAIR}, placement: {{pattern: random, seed: 4}}}}
contact: {{normal_stiffness: 2000, tangential_stiffness: 571, restitution: 0.7, friction: 0.3, wall_friction: 0.3}}
run: {{until: 0.05}}
"""
    CASE = """
system: grains
name: on a bed
domain:
  size: [0.04, 0.03, 0.05]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: no_slip, bottom: no_slip, top: free_slip}
gravity: {magnitude: 9.8, slope: 0.3}
grains:
  - {count: 2, diameter: 3.0e-3, density: 2550, placement: {positions: [[0.01, 0.01, 0.045], [0.03, 0.02, 0.045]]}}
  - {placement: {file: bed.h5}}
contact: {normal_stiffness: 2000, tangential_stiffness: 571, restitution: 0.7, friction: 0.3, wall_friction: 0.3}
run: {until: 0.04}
output: {series: {every: 0.01}, checkpoint: {every: 0.01, keep: 3}}
analysis: {transport_rate: {}, bed_surface: {}}
"""

    def setUp(self):
        super().setUp()
        (self.folder / "bed.yaml").write_text(self.BED)
        self.run_well("run", "bed.yaml", "--out", "made")
        (self.folder / "made/bed.h5").rename(self.folder / "bed.h5")

    def test_the_bed_file_may_be_gone(self):
        self.run_well("run", self.case, "--out", "straight")
        self.run_well("run", self.case, "--until", "0.02")
        (self.folder / "bed.h5").unlink()
        self.assert_refused("run", self.case, "--out", "new", words=["grains.1.placement.file", "no file"])
        said = self.run_well("run", self.case, "--restart", "run", ranks=2).stdout
        self.assertNotIn("changed since then: grains", said)
        self.assert_same_bed("run", "straight")
        self.assertEqual(
            (self.folder / "run/series.csv").read_text(), (self.folder / "straight/series.csv").read_text()
        )
        self.assert_same_end("run", "straight")
        # Also where the newest checkpoint is damaged, from the one before.
        newest = self.last_checkpoint("run")
        newest.write_bytes(newest.read_bytes()[:newest.stat().st_size // 2])
        said = self.run_well("run", self.case, "--restart", "run").stdout
        self.assertIn("at 0.0301226 s", said)   # 101 steps, the first after 3 times 33.5
        self.assert_same_bed("run", "straight")


class RestartOfDisksFromAFile(ProgramTest):
    """Disks that a region takes out of a file are moved into the middle of a wider box, where the region's y does not
    reach."""
    CASE = """
system: grains
name: disks
disks: {thickness: 1.0e-3}
domain: {size: [0.04, 0.001, 0.03], spacing: 1.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}}
gravity: {magnitude: 9.8, slope: 0.3}
grains: [{count: 30, diameter: 3.0e-3, density: 2550, placement: {pattern: random, seed: 1}}]
contact: {normal_stiffness: 200, tangential_stiffness: 57, restitution: 0.7, friction: 0.3, wall_friction: 0.3}
run: {until: 0.01, time_step: 1.0e-5}
"""

    def test_goes_on(self):
        self.run_well("run", self.case, "--out", "made")
        wider = ["--set", "domain.size=[0.04, 0.004, 0.03]", "--set",
                 "grains=[{placement: {file: made/bed.h5, region: {lower: [0, 0, 0], upper: [0.04, 0.001, 0.03]}}}]"]
        self.run_well("run", self.case, *wider, "--out", "straight")
        self.run_well("run", self.case, *wider, "--out", "half", "--until", "0.005")
        self.run_well("run", self.case, *wider, "--out", "half", "--restart", "half")
        self.assert_same_bed("half", "straight")


class RestartInWater(ProgramTest):
    """A resolved run, whose system is built without grains before the checkpoint brings them."""
    CASE = """
system: resolved
name: three settle
domain:
  size: [0.012, 0.012, 0.016]
  spacing: 0.8e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, smagorinsky_constant: 0.27, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.05}
grains: [{count: 3, diameter: 4.8e-3, density: 2550, placement: {pattern: random, seed: 1}}]
contact: {restitution: 0.9}
coupling: {grain_steps_per_fluid_step: 20, lubrication: {}}
run: {until: 0.01}
output: {series: {every: 0.001}}
"""

    def test_same_bits_on_other_ranks(self):
        self.run_well("run", self.case, "--out", "straight")
        self.run_well("run", self.case, "--until", "0.005", ranks=2)
        self.run_well("run", self.case, "--restart", "run")
        self.assert_same_end("run", "straight", "series.csv")

    def kept_stiffness(self, folder):
        return yaml.safe_load((self.folder / folder / "case.yaml").read_text())["contact"]["normal_stiffness"]

    def test_the_stiffness_is_kept_and_a_new_one_told(self):
        self.run_well("run", self.case, "--until", "0.005")
        first = self.kept_stiffness("run")
        said = self.run_well("run", self.case, "--restart", "run", "--until", "0.006").stdout
        self.assertNotIn("changed since then: contact", said)
        self.assertEqual(self.kept_stiffness("run"), first)
        said = self.run_well(
            "run", self.case, "--restart", "run", "--until", "0.007", "--set", "contact.duration=1.0e-3"
        ).stdout
        self.assertIn(f"changed since then: contact.normal_stiffness: {first!r} -> ", said)
        # New runs from that state: with half the step contacts are half as long.
        for folder, step in (("fine", 5.0e-5), ("finer", 2.5e-5)):
            self.run_well(
                "run", self.case, "--out", folder, "--until", f"{5.0 * step!r}", "--set", f"fluid.time_step={step!r}",
                "--set", "initial={from: run, fields: [grains]}",
            )
        self.assertAlmostEqual(self.kept_stiffness("finer") / self.kept_stiffness("fine"), 4.0, 9)

    def test_the_lubrication_of_the_grains_of_the_checkpoint_is_looked_at(self):
        self.run_well("run", self.case, "--until", "0.005")
        self.assert_refused("run", self.case, "--restart", "run", "--set", "coupling.lubrication.minimum_gap=1e-6",
                            words=["lubrication force", "minimum_gap: "])


if __name__ == "__main__":
    program.main()
