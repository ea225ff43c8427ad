#!/usr/bin/env python3
"""Further series of frames of the grains: what they show, the same bytes on any ranks, and what is refused.

Called by ctest: grain_parts_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import sys
from pathlib import Path

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest
from thalweg import Run

ALL_FIELDS = {"id", "clump", "radius", "speed", "velocity", "angular_velocity", "contact_force", "contact_stress",
              "population", "held", "density", "orientation"}


def opened(path):
    """The points of a frame and their arrays by name, by VTK's own reader."""
    reader = vtkXMLPolyDataReader()
    assert reader.CanReadFile(str(path)), path
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0, path
    data = reader.GetOutput()
    arrays = data.GetPointData()
    assert data.GetNumberOfVerts() == data.GetNumberOfPoints()
    points = vtk_to_numpy(data.GetPoints().GetData()).reshape(-1, 3)
    return points, {arrays.GetArrayName(n): vtk_to_numpy(arrays.GetArray(n)) for n in range(arrays.GetNumberOfArrays())}


class GrainParts(ProgramTest):
    # Twelve clumps of two spheres (ids 0 to 23), ten spheres (24 to 33) that fall on three fixed ones (34 to 36).
    CASE = """
system: grains
name: parts
domain:
  size: [0.02, 0.02, 0.06]
  spacing: 1.0e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: no_slip}
gravity: {magnitude: 9.8, slope: 0.05}
grains:
  - shape: {clump: [{position: [0, 0, 0], diameter: 4.0e-3}, {position: [0.002, 0, 0], diameter: 4.0e-3}]}
    density: 2550
    count: 12
    angular_velocity: [60, 40, 20]
    placement: {pattern: random, seed: 3, region: {lower: [0, 0, 0.01], upper: [0.02, 0.02, 0.06]}}
  - {count: 10, diameter: 4.0e-3, density: 2000, placement: {pattern: random, seed: 5, region: {lower: [0, 0, 0.01], upper: [0.02, 0.02, 0.06]}}}
  - {count: 3, diameter: 4.0e-3, density: 2650, fixed: true, placement: {positions: [[0.004, 0.01, 0.002], [0.01, 0.01, 0.002], [0.016, 0.01, 0.002]]}}
contact: {restitution: 0.4, tangential_damping: 0.5}
run: {until: 0.004}
output:
  grains: {every: 1.0e-3}
  grain_parts:
    - {name: tracers, every: 5.0e-4, ids: [30, 1, 24]}
    - {name: spheres, every: 1.0e-3, population: 1, fields: [density, id, velocity]}
    - {name: falling, every: 1.0e-3, box: {lower: [0, 0, 0.03], upper: [0.02, 0.02, 0.05]}, fields: [id]}
    - {name: nobody, every: 2.0e-3, ids: [2], population: 2, fields: [contact_stress]}
  checkpoint: {every: 2.0e-3, keep: 3}
"""

    def frames(self, out):
        return {path.relative_to(self.folder / out): path.read_bytes() for kind in ("*.pvd", "*.vtp")
                for path in (self.folder / out).rglob(kind)}

    def test_they_show_what_is_asked_for(self):
        self.run_well("run", self.case, ranks=2)
        run = Run(self.folder / "run")
        self.assertEqual(
            [len(run.grain_part(name)) for name in ("tracers", "spheres", "falling", "nobody")], [9, 5, 5, 3]
        )
        whole = run.grains[4]
        self.assertEqual(set(whole.arrays) - {"position"}, ALL_FIELDS)
        self.assertEqual(whole.population.tolist(), 24 * [0] + 10 * [1] + 3 * [2])
        self.assertEqual(whole.held.tolist(), 34 * [0] + 3 * [3])
        numpy.testing.assert_allclose(whole.density, 24 * [2550] + 10 * [2000] + 3 * [2650], rtol=1e-12)
        self.assertEqual(len(run.grain_part("nobody")[1]), 0)
        self.assertEqual(run.grain_part("nobody")[1].contact_stress.shape, (0, 3, 3))

        places = {"tracers": [1, 24, 30], "spheres": list(range(24, 34)), "nobody": []}
        height = whole.position[:, 2]
        places["falling"] = numpy.flatnonzero((height >= 0.03) & (height <= 0.05)).tolist()
        self.assertTrue(0 < len(places["falling"]) < 37)
        fields = {
            "tracers": ALL_FIELDS, "spheres": {"density", "id", "velocity", "radius"}, "falling": {"id", "radius"},
            "nobody": {"contact_stress", "radius"},
        }
        for name, chosen in places.items():
            frame = run.grain_part(name)[-1]
            self.assertEqual(frame.time, whole.time)
            points, arrays = opened(frame.path)
            self.assertEqual(set(arrays), fields[name])
            numpy.testing.assert_array_equal(points, whole.position[chosen])
            numpy.testing.assert_array_equal(frame.position, points)
            for field in fields[name]:
                numpy.testing.assert_array_equal(frame.arrays[field], whole.arrays[field][chosen], f"{name} {field}")
                numpy.testing.assert_array_equal(arrays[field].ravel(), frame.arrays[field].ravel())

    def test_the_orientation_turns_a_clump_as_its_members_lie(self):
        self.run_well("run", self.case)
        frames = Run(self.folder / "run").grains
        for frame in (frames[0], frames[-1]):
            w, x, y, z = frame.orientation[:24:2].T
            numpy.testing.assert_array_equal(frame.orientation[:24:2], frame.orientation[1:24:2])
            numpy.testing.assert_array_equal(frame.orientation[24:], 13 * [[1, 0, 0, 0]])
            # The columns of the rotation matrix are the principal axes; one of them goes through both members.
            axes = numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
            apart = frame.position[1:24:2] - frame.position[:24:2]
            apart[:, :2] -= 0.02 * numpy.round(apart[:, :2] / 0.02)
            along = abs(numpy.einsum("iac,ci->ac", axes, apart / 0.002))
            numpy.testing.assert_allclose(along.max(axis=0), 1, atol=1e-9)
            numpy.testing.assert_allclose(numpy.sort(along, axis=0)[:2], 0, atol=1e-6)
        self.assertGreater(abs(frames[-1].orientation - frames[0].orientation)[:24].max(), 1e-3)

    def test_the_same_bytes_on_any_ranks_and_after_a_restart(self):
        self.run_well("run", self.case, "--out", "one")
        self.run_well("run", self.case, "--out", "four", ranks=4)
        self.run_well("run", self.case, "--out", "two", "--until", "0.002", ranks=2)
        self.run_well("run", self.case, "--out", "two", "--restart", "two", ranks=2)
        one = self.frames("one")
        self.assertEqual(len(one), 5 + 5 + 9 + 5 + 5 + 3)
        for other in ("two", "four"):
            self.assertEqual(one, self.frames(other), other)
        # Nothing that is looked at changes the run.
        self.run_well("run", self.case, "--out", "unseen", "--set", "output.grain_parts=[]", "--set",
                      "output.grains.every=0")
        self.assert_same_end("unseen", "one")

    def test_frames_with_some_fields_only(self):
        self.run_well(
            "run", self.case, "--until", "0.001", "--set", "output.grains.fields=[speed, population]", "--set",
            "output.grain_parts=[]",
        )
        frame = Run(self.folder / "run").grains[1]
        self.assertEqual(list(frame.arrays), ["position", "radius", "speed", "population"])
        self.assertEqual(len(frame), 37)
        self.run_well("run", self.folder / "run/case.yaml", "--until", "0.001", "--out", "again")
        self.assertEqual(self.frames("run"), self.frames("again"))

    def test_the_check_counts_their_space(self):
        def space(*settings):
            line = [
                l for l in self.run_well("check", self.case, *settings).stdout.splitlines() if l.startswith("disk")
            ][0]
            words = line.replace(",", "").split()
            return float(words[words.index("grains") + 1])   # MB
        # More than the run writes, whose numbers are compressed; no more than all numbers, 8 bytes each, and what is
        # written once more: 5 frames of 37 grains with 34 numbers, 9 of 3 with 34, 5 of 10 with 11, 5 of 37 with 7, 3 of
        # 1 with 15.
        for numbers, settings in (
            (5 * 37 * 34 + 9 * 3 * 34 + 5 * 10 * 11 + 5 * 37 * 7 + 3 * 15, ()),
            (5 * 37 * 7, ("--set", "output.grain_parts=[]", "--set", "output.grains.fields=[id]")),
        ):
            self.run_well("run", self.case, "--overwrite", *settings)
            frames = [path for part in ("grains", "grain_parts") for path in (self.folder / "run" / part).rglob("*.vtp")]
            megabytes = 1e-6 * sum(path.stat().st_size for path in frames)
            self.assertGreater(space(*settings), megabytes)
            self.assertLess(space(*settings), 8e-6 * numbers + megabytes)

    def test_what_there_is_not_is_refused(self):
        part = "output.grain_parts.0"
        for given, words in (
            ("{name: a b, every: 1}", [f"{part}.name", "letters, digits and underscores"]),
            ("{name: a}", [f"{part}.every", "above 0"]),
            ("{name: a, every: 1}, {name: a, every: 1}", ["output.grain_parts", "two of them have the same name"]),
            ("{name: a, every: 1, ids: []}", [f"{part}.ids", "a list of whole numbers"]),
            ("{name: a, every: 1, ids: [3, -1]}", [f"{part}.ids.1 = -1", "at least 0"]),
            ("{name: a, every: 1, ids: [3, 37]}", [f"{part}.ids.1 = 37", "no such grain", "0 to 36"]),
            ("{name: a, every: 1, ids: [3, 3]}", [f"{part}.ids.1 = 3", "twice"]),
            ("{name: a, every: 1, population: 3}", [f"{part}.population = 3", "no such population", "0 to 2"]),
            ("{name: a, every: 1, population: -1}", [f"{part}.population = -1", "at least 0"]),
            ("{name: a, every: 1, box: {lower: [0, 0, 0], upper: [0.02, 0, 0.01]}}", [f"{part}.box", "no volume"]),
            (
                "{name: a, every: 1, box: {lower: [0, 0, 0], upper: [0.02, 0.02, 0.07]}}",
                [f"{part}.box", "out of the domain"],
            ), ("{name: a, every: 1, fields: [mass]}", [f"{part}.fields.0 = \"mass\"", "one of id, clump, radius"]),
            ("{name: a, every: 1, fields: []}", [f"{part}.fields", "a list of some of"]),
            ("{name: a, every: 1, fields: [fluid_force]}", [f"{part}.fields.0 = \"fluid_force\"", "no fluid"]),
            (
                "{name: a, every: 1, fields: [id, fluid_stress]}",
                [f"{part}.fields.1 = \"fluid_stress\"", "system: resolved"],
            ),
        ):
            self.assert_refused("check", self.case, "--set", f"output.grain_parts=[{given}]", words=words)
        self.assert_refused(
            "run", self.case, "--set", "output.grains.fields=[colour]", words=["output.grains.fields.0"]
        )
        self.case.write_text(self.CASE.replace("fields: [id]}", "fields: [id, orientations]}"))
        self.assert_refused(
            "check", self.case, words=["case.yaml:", "output.grain_parts.2.fields.1 = \"orientations\""]
        )


if __name__ == "__main__":
    program.main()
