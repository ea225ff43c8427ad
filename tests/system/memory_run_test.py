#!/usr/bin/env python3
"""Runs of 1e5 steps, in which the memory of the program may not grow.

Called by ctest: memory_run_test.py THALWEG MPIEXEC [unittest arguments]. The resident set of the only process is looked
at again and again. After two fifths of a run it may be larger by half a megabyte than before, since the C library takes
and gives back such amounts: a loss of nine bytes a step, or of nine kilobytes with every frame, would be more.
"""
import re
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import SLIDING_GRAINS, ProgramTest

STEPS = 100_000
LARGEST_GROWTH = 0.5e6   # bytes

WATER_OVER_GRAINS = """
system: resolved
name: memory
domain:
  size: [0.0096, 0.008, 0.0096]
  spacing: 0.8e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, smagorinsky_constant: 0.27, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.05}
grains: [{count: 2, diameter: 4.0e-3, density: 2550, placement: {pattern: random, seed: 1}}]
contact: {restitution: 0.9}
coupling: {grain_steps_per_fluid_step: 15}
run: {until: 10.0}
output: {series: {every: 0.01}, fluid: {every: 0.1}, grains: {every: 0.1}, checkpoint: {every: 0.2}}
analysis:
  transport_rate: {}
  bed_surface: {}
  grain_profiles: {}
  fluid_statistics: {}
  stress_balance: {}
  wall_forces: {}
  tracks: {grains: [0]}
  probes: {points: [[0.004, 0.004, 0.008]]}
"""

# A floor that drags a few grains against a wall, where they tumble. A step of dry grains is fifty of `time_step`.
DRY_GRAINS = SLIDING_GRAINS.replace("count: 60", "count: 6").replace(
    "x: periodic, y: no_slip, bottom: no_slip", "x: no_slip, y: no_slip, bottom: {type: moving, velocity: [0.3, 0, 0]}") + """
run: {until: 100.0, time_step: 2.0e-5}
output: {series: {every: 0.1}, grains: {every: 1.0}, checkpoint: {every: 2.0}}
analysis: {transport_rate: {}, grain_profiles: {}, wall_forces: {}}
"""


class Memory(ProgramTest):
    def resident(self, process):
        """Bytes; none once it has ended."""
        found = re.search(r"VmRSS:\s+(\d+) kB", Path(f"/proc/{process.pid}/status").read_text())
        return 1024 * int(found[1]) if found else None

    def time_reached(self):
        """s, by the newest whole row of the series."""
        series = self.folder / "run/series.csv"
        rows = series.read_text().split("\n")[1:-1] if series.exists() else []
        return float(rows[-1].split(",")[0]) if rows else 0.0

    def check_growth(self, text, until):
        self.case.write_text(text)
        with open(self.folder / "printed.txt", "w") as printed:
            process = subprocess.Popen(
                self.command(["run", self.case], 0), cwd=self.folder, stdout=printed, stderr=printed
            )
        self.addCleanup(process.kill)
        early, late = [], []
        while process.poll() is None:
            reached, bytes_in_use = self.time_reached(), self.resident(process)
            if bytes_in_use and reached >= 0.25 * until:
                (early if reached < 0.4 * until else late).append(bytes_in_use)
            time.sleep(0.05)
        self.assertEqual(process.returncode, 0, (self.folder / "printed.txt").read_text())
        self.assertEqual(self.summary("run")["steps"], STEPS)
        self.assertGreater(len(early), 3)
        self.assertGreater(len(late), 10)
        growth = max(late) - max(early)
        print(f"{max(late) * 1e-6:.2f} MB, {growth * 1e-6:+.3f} MB since the beginning")
        self.assertLess(growth, LARGEST_GROWTH)

    def test_water_over_grains(self):
        self.check_growth(WATER_OVER_GRAINS, 10.0)

    def test_dry_grains(self):
        self.check_growth(DRY_GRAINS, 100.0)


if __name__ == "__main__":
    program.main()
