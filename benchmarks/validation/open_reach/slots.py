#!/usr/bin/env python3
"""Discharge of a bin whose floor has a slot across it, beside Beverloo's law."""
import argparse
import csv
import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
SLOTS = (0.020, 0.025, 0.030, 0.040, 0.050)          # m
LENGTH, WIDTH, DIAMETER, DENSITY, GRAVITY = 0.12, 0.02, 5e-3, 2550.0, 9.81
FLOWING = 0.58                                       # solid fraction above a slot, as in the bin of cases/hopper
BEGIN = 0.7                                          # s: the first grains have fallen


def run(thalweg, folder, slot):
    half = 0.5 * (LENGTH - slot)
    settings = []
    for wall, middle in enumerate((0.5 * half, LENGTH - 0.5 * half)):
        settings += ["--set", f"walls.{wall}.point=[{middle}, 0.01, 0.05]", "--set", f"walls.{wall}.plate.length={half}"]
    subprocess.run([thalweg, "run", HERE / "slot.yaml", "--out", folder, "--overwrite", *settings], check=True)


def discharge(folder):
    """kg/s, from the mass that has passed through the sink."""
    with open(folder / "series.csv", newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    names = [name.split()[0] for name in header]
    time, mass = names.index("time"), names.index("recirculated_mass")
    late = [(float(row[time]), float(row[mass])) for row in rows if float(row[time]) > BEGIN]
    return (late[-1][1] - late[0][1]) / (late[-1][0] - late[0][0])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("thalweg", help="the program")
    parser.add_argument("folder", type=Path, help="of the five runs")
    arguments = parser.parse_args()
    thalweg, folder = arguments.thalweg, arguments.folder
    print("slot (diameters)  discharge (kg/s)  Beverloo's law")
    for slot in SLOTS:
        run(thalweg, folder / f"slot_{slot:.3f}", slot)
        found = discharge(folder / f"slot_{slot:.3f}")
        law = 1.03 * FLOWING * DENSITY * GRAVITY ** 0.5 * (slot - 1.4 * DIAMETER) ** 1.5 * WIDTH
        print(f"{slot / DIAMETER:6.1f} {found:20.4f} {law:18.4f}  {100 * (found / law - 1):+.0f} %")


main()
