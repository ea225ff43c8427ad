#!/usr/bin/env python3
"""What lies beside a checkpoint is on the disk before the checkpoint gets its name, as a loss of power would show.

Called by ctest: disk_run_test.py THALWEG MPIEXEC LIBRARY. LIBRARY (order_of_writes.cpp) is preloaded and says what the
program puts on the disk, and when.
"""
import os
import sys
from pathlib import Path
from unittest import mock

LIBRARY = sys.argv.pop(3)
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest


class OnTheDisk(ProgramTest):
    CASE = """
system: resolved
name: power cut
domain:
  size: [0.0192, 0.0128, 0.016]
  spacing: 0.8e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.05}
grains: [{count: 2, diameter: 4.8e-3, density: 2550, placement: {pattern: random, seed: 1}}]
contact: {restitution: 0.9}
solids: [{sphere: {centre: [0.0096, 0.0064, 0.012], radius: 0.002}, motion: {velocity: [0.01, 0, 0]}}]
run: {until: 0.004}
output:
  series: {every: 0.001}
  grains: {every: 0.001}
  fluid: {every: 0.001, fields: [velocity]}
  grain_parts: [{name: one, ids: [1], every: 0.001}]
  fluid_parts: [{name: bottom, plane: {axis: z, at: 0.001}, fields: [pressure], every: 0.001}]
  checkpoint: {every: 0.002, keep: 2}
analysis:
  tracks: {grains: [0], every: 2.0e-4}
  probes: {points: [[0.01, 0.01, 0.01]], every: 3.0e-4}
  entrainment: {grains: [0, 1], rest_time: 1.0e-4, displacement: 0.001, memory: 1.0e-3}
"""
    # Of a step, and what grows or is replaced with every frame and row.
    OF_STEP = (
        "grains/grains_{:09d}.vtp", "fluid/fluid_{:09d}.vti", "solids/solids_{:09d}.vtp",
        "grain_parts/one/one_{:09d}.vtp", "fluid_parts/bottom/bottom_{:09d}.vti", "tracks/part_{:09d}.h5",
        "probes/part_{:09d}.h5",
    )
    GROWING = ("series.csv", "grains.pvd", "fluid.pvd", "solids.pvd", "grain_parts/one.pvd", "fluid_parts/bottom.pvd")

    def events(self):
        """(what, place in the folder) of the run in order; a file that is named after it was put on the disk counts by
        its name."""
        return [(what, os.path.relpath(path, self.folder / "run").removesuffix(".partial"))
                for what, path in (line.split(" ", 1) for line in (self.folder / "order").read_text().splitlines())]

    def test_before_a_checkpoint(self):
        order = {"ORDER_OF_WRITES": str(self.folder / "order"), "LD_PRELOAD": LIBRARY}
        with mock.patch.dict(os.environ, order):
            self.run_well("run", self.case, "--out", "run")
        events, begin = self.events(), 0
        for step in (20, 40):
            end = events.index(("rename", f"checkpoints/step_{step}.h5"))
            before = events[begin:end]
            for name in self.GROWING + tuple(of_step.format(step) for of_step in self.OF_STEP):
                self.assertIn(("fsync", name), before)
                named = max((n for n, event in enumerate(events[:end]) if event == ("rename", name)), default=None)
                if named is not None:   # and so is its name
                    self.assertIn(("fsync", str(Path(name).parent)), events[named:end], name)
            begin = end
        self.assertIn(("fsync", "case.yaml"), events[:events.index(("rename", "checkpoints/step_20.h5"))])
        self.assertIn(("rename", "entrainment/part_000000020.h5"), events)


if __name__ == "__main__":
    program.main()
