"""Inputs that a program might swallow: names that are not UTF-8, counts beyond all memory, surfaces in another unit,
beds of other shapes.

Called by ctest: odd_inputs_test.py THALWEG MPIEXEC [unittest arguments]
"""
import json
import os
import resource
import subprocess
import sys
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import THALWEG, ProgramTest
from stl_box import write_box

BOX = (
    "domain: {size: [0.02, 0.02, 0.02], spacing: 1.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top:"
    " free_slip}}"
)
GRAINS = f"""
system: grains
name: "grès, 砂"
{BOX}
gravity: {{magnitude: 9.8}}
grains: [{{count: 2, diameter: 4.0e-3, density: 2550, placement: {{pattern: random, seed: 1}}}}]
contact: {{normal_stiffness: 20000, restitution: 0.5, friction: 0.3}}
run: {{until: 1.0e-3, time_step: 5.0e-6}}
output: {{series: {{every: 2.5e-4}}}}
analysis: {{transport_rate: {{}}}}
"""
SURFACE = f"""
system: fluid
{BOX}
fluid: {{density: 1000, kinematic_viscosity: 1.0e-5, time_step: 1.0e-4}}
gravity: {{magnitude: 9.8, slope: 0.05}}
solids: [{{stl: part.stl}}]
run: {{until: 1.0e-3}}
"""


class OddNames(ProgramTest):
    CASE = GRAINS

    def test_a_folder_whose_name_is_not_utf8(self):
        odd = os.fsdecode(b"r\xfcn")   # Latin-1, as old disks have it
        self.run_well("run", "case.yaml", "--out", odd)
        texts = {
            name: (self.folder / odd / name).read_bytes().decode("utf-8")
            for name in ("summary.json", "case.yaml", "run.log")
        }
        self.assertIn("r\ufffdn", json.loads(texts["summary.json"])["command"])
        self.assertIn("r\ufffdn", texts["run.log"])
        self.run_well("run", "case.yaml", "--restart", odd, "--until", "2.0e-3")
        self.run_well("info", odd)
        self.run_well("analyze", odd)

    def test_text_in_utf8_is_kept(self):
        self.run_well("run", "case.yaml", "--out", "größe")
        self.assertEqual(self.summary("größe")["name"], "grès, 砂")
        with h5py.File(self.last_checkpoint("größe")) as file:
            name = file["run"].attrs["name"]
            self.assertEqual(name.decode() if isinstance(name, bytes) else name, "grès, 砂")

    def test_other_text_is_refused_with_its_line(self):
        (self.folder / "latin.yaml").write_bytes(GRAINS.encode("latin-1", "replace"))
        self.assert_refused("check", "latin.yaml", words=["latin.yaml:3: the byte 0xe8 here is not UTF-8"])
        self.assert_refused("run", "case.yaml", "--set", os.fsdecode(b"name=caf\xe9"), words=["0xe9", "UTF-8"])
        odd = self.folder / os.fsdecode(b"d\xfcne")
        odd.mkdir()
        self.run_well("run", "case.yaml", "--out", odd / "run")
        (odd / "next.yaml").write_text(GRAINS.replace(GRAINS[GRAINS.index("grains: ["):GRAINS.index("contact")],
                                                      "grains: [{placement: {file: run/bed.h5}}]\n"))
        done = subprocess.run([THALWEG, "check", odd / "next.yaml"], capture_output=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("rename the folder", done.stderr.decode("utf-8", "replace"))


class Counts(ProgramTest):
    CASE = GRAINS

    def check_briefly(self, *settings):
        """Exit code and what is said; at most half a gigabyte and ten seconds of a core."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        result = self.thalweg("check", "case.yaml", *[word for setting in settings for word in ("--set", setting)])
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.assertLess(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 10.0)
        self.assertLess(after.ru_maxrss, 512 * 1024)
        return result

    def test_more_grains_than_there_is_memory_for_are_not_placed(self):
        big = ("domain.size=[20, 20, 20]", "domain.spacing=5.0e-3")
        for count in (2000000000, 5000000000):   # below and above 2^31
            for pattern in ("random", "uniform"):
                result = self.check_briefly(*big, f"grains.0.count={count}", f"grains.0.placement.pattern={pattern}")
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn("of memory, and this machine has", result.stderr)
                self.assertIn("too many grains to be placed on this machine", result.stdout)
        self.assert_refused(
            "check", "case.yaml", "--set", big[0], "--set", big[1], "--set", "grains.0.count=2000000000", "--set",
            "grains.0.diameter={sizes: [4.0e-3, 5.0e-3], fractions: [0.5, 0.5]}",
            words=["grains.0.count = 2000000000", "at most 100000000 grains"],
        )

    def test_whole_numbers_that_an_int_does_not_hold(self):
        self.assert_refused("run", "case.yaml", "--layout", "65536,65536,1", words=["4294967296 rank"])
        self.run_well(
            "run", "case.yaml", "--set", "output.checkpoint.keep=4294967296", "--set", "output.checkpoint.every=2.5e-4"
        )
        # A step is 50 sub-steps. To keep 0, what is left of 2^32 as an int, would leave one.
        self.assertEqual(len(list((self.folder / "run/checkpoints").glob("step_*.h5"))), 4)


class Surfaces(ProgramTest):
    CASE = SURFACE

    def warnings_of(self, low, high, *settings):
        write_box(self.folder / "part.stl", low, high)
        report = self.run_well("check", "case.yaml", *settings).stdout
        return [line for line in report.splitlines() if line.startswith("warning") and "solids." in line]

    def test_a_file_in_millimetres(self):
        box, walls = ((5, 6, 4), (12, 14, 9)), (
            "--set", "domain.boundaries={x: no_slip, y: no_slip, bottom: no_slip, top: no_slip}", "--set",
            "gravity.slope=0",
        )
        self.assertEqual(self.warnings_of(*box, "--set", "solids.0.scale=1.0e-3"), [])
        self.assertTrue(
            any("millimetres, consider solids.0.scale: 0.001" in line for line in self.warnings_of(*box, *walls))
        )
        self.assert_refused(
            "check", "case.yaml", words=["solids.0.stl", "periodic box", "give scale: 0.001"]
        )  # a thousand images
        grains = GRAINS.replace("run:", "solids: [{stl: part.stl}]\nrun:").replace(
            "x: periodic, y: periodic", "x: no_slip, y: no_slip"
        )
        self.case.write_text(grains)   # all of the box is in the solid or beside it
        write_box(self.folder / "part.stl", (5, 6, 4), (12, 14, 9))
        self.assertIn("millimetres, consider solids.0.scale: 0.001", self.run_well("check", "case.yaml").stdout)

    def test_a_solid_outside_the_box_is_noticed(self):
        outside = self.warnings_of((0.002, 0.002, 0.021), (0.004, 0.004, 0.025))
        self.assertTrue(
            any("solids.0 lies outside the box, from 0.021 to 0.025 m along z" in line for line in outside), outside
        )


class Beds(ProgramTest):
    CASE = GRAINS.replace(
        GRAINS[GRAINS.index("grains: [") : GRAINS.index("contact")], "grains: [{placement: {file: bed.h5}}]\n"
    )

    def put_bed(self, change):
        """A bed as another program writes it: no checksums."""
        n = 2
        columns = {
            "id": numpy.arange(n), "radius": numpy.full(n, 2e-3), "density": numpy.full(n, 2550.0),
            "position": numpy.array([[0.005, 0.005, 0.005], [0.015, 0.015, 0.015]]), "velocity": numpy.zeros((n, 3)),
            "angular_velocity": numpy.zeros((n, 3)),
        }
        with h5py.File(self.folder / "bed.h5", "w") as file:
            bed = file.create_group("bed")
            bed.attrs["format"] = numpy.bytes_("thalweg bed 1")
            bed.attrs["time"], bed.attrs["disk_thickness"] = 0.0, 0.0
            bed["box"], bed["periodic"] = numpy.full(3, 0.02), numpy.array([1, 1, 0])
            for name, values in columns.items():
                file[f"grains/{name}"] = values
            change(file)

    def assert_bed_refused(self, change, *words):
        self.put_bed(change)
        self.assert_refused("check", "case.yaml", words=["grains.0.placement.file", "bed.h5", *words])

    def test_a_bed_of_another_program_is_taken_if_it_is_whole(self):
        self.put_bed(lambda file: None)
        self.run_well("check", "case.yaml")

    def test_others_are_refused(self):
        def anew(name, **made):
            def change(file):
                del file["grains/" + name]
                if made:
                    file.create_dataset("grains/" + name, **made)
            return change

        def with_value(name, value):
            def change(file):
                file["grains/" + name][1] = value
            return change

        self.assert_bed_refused(anew("id", data=3), "grains/id", "a single value")
        self.assert_bed_refused(anew("radius", data=2e-3), "grains/radius")
        self.assert_bed_refused(
            anew("id", shape=(1 << 60,), dtype="i8", chunks=(64,)), "announces 1152921504606846976 values"
        )
        self.assert_bed_refused(anew("position", data=numpy.zeros(6)), "grains/position", "6 values, but 2 x 3")
        self.assert_bed_refused(anew("density", data=numpy.full(2, 2550.0, "f4")), "float32, but float64")
        self.assert_bed_refused(anew("velocity"), "grains/velocity", "no such data")
        self.assert_bed_refused(with_value("position", numpy.nan), "nan")
        self.assert_bed_refused(with_value("velocity", numpy.inf), "velocity that is not a number")
        self.assert_bed_refused(with_value("radius", -1e-3), "radius -0.001")
        self.assert_bed_refused(with_value("density", 0.0), "density 0")
        self.put_bed(lambda file: None)
        whole = (self.folder / "bed.h5").read_bytes()
        (self.folder / "bed.h5").write_bytes(whole[:len(whole) // 2])
        self.assert_refused("check", "case.yaml", words=["grains.0.placement.file", "bed.h5", "damaged"])


if __name__ == "__main__":
    program.main()
