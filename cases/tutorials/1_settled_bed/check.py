#!/usr/bin/env python3
"""Checks both beds of tutorial 1: at rest, hardly overlapping, and as dense as such beds are."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python
from thalweg import Run
from thalweg.checks import check_main

RANDOM_PACKINGS = 0.55, 0.64   # solid fraction of spheres, from random loose to random close packing


def check(checks, between_walls, without_walls):
    for folder, low, high in ((between_walls, 0.48, 0.53), (without_walls, *RANDOM_PACKINGS)):
        run = Run(folder)
        checks.finished(run)
        bed = run.summary["bed"]
        checks.expect("  largest overlap", run.summary["figures"]["largest_overlap"], 0.0, 0.002, "diameters")
        checks.expect(
            "  grains that still roll", run.summary["figures"]["restless_grains"], 0, 4
        )  # 2 % of the larger bed
        checks.expect("  solid fraction", 1.0 - bed["porosity"], low, high)
        print(f"  height of the bed: {bed['bed_height'] / run.diameter:.2f} diameters")


if __name__ == "__main__":
    sys.exit(check_main(__doc__, check, ["run/settled_bed", "run/small_bed"]))
