#!/usr/bin/env python3
"""Grid turbulence of Comte-Bellot and Corrsin (1971) by large-eddy simulation: compare.py PROGRAM [--figure FILE]

Makes a random solenoidal field with the spectrum measured at t U_0/M = 42, and its pressure; PROGRAM
(bin/decaying_turbulence) advances it to 98 and 171, where energy and spectra are compared. Prints a table and pass or
fail: the resolved energy must be within 10 % of that of the measured spectrum over the same wave numbers, for C_s =
0.17, which is Lilly's value for a cut-off in the inertial range. Exit code 0 if it passes.
"""
import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python

import matplotlib.pyplot as plt
import numpy as np

from thalweg.tables import read_rows

ACCEPTED = 0.10
SIDE = 9 * 2 * np.pi          # cm
VISCOSITY = 0.15              # cm^2/s: air
STATIONS = (0.28448, 0.65532)  # s after t U_0/M = 42: 98 and 171
OPTIONS = {"qr": ["--qr"]} | {f"C_s = {c}": ["--smagorinsky", c] for c in ("0.10", "0.17", "0.27")}
RMS_LATTICE = 0.02            # root mean square of a component at the start, cells a step


def reference(column):
    rows = [r for r in read_rows(Path(__file__).with_name("reference.csv")) if r[column]]
    k, e = (np.array([float(r[c]) for r in rows]) for c in ("k", column))
    return k, e


def measured(column, k):
    """The measured spectrum between its points (a power law from one to the next), zero below the first."""
    points, values = reference(column)
    e = np.exp(np.interp(np.log(k), np.log(points), np.log(values)))
    return np.where(k < points[0], 0.0, e)


def wave_numbers(n):
    axis = np.fft.fftfreq(n, 1.0 / n)
    kz, ky, kx = np.meshgrid(axis, axis, axis, indexing="ij")
    return np.array([kx, ky, kz])


def shells(velocity):
    """Energy in each shell of wave numbers m - 1/2 to m + 1/2, in units of the velocity squared."""
    n = velocity.shape[1]
    k = np.sqrt((wave_numbers(n)**2).sum(0))
    energy = 0.5 * sum(np.abs(np.fft.fftn(v) / n**3)**2 for v in velocity)
    return np.bincount(np.rint(k).astype(int).ravel(), energy.ravel())[:n // 2]


def start(n, seed):
    """Velocity (cm/s) on n^3 points with the measured energy in every shell, up to n/2 - 1."""
    random = np.random.default_rng(seed)
    k = wave_numbers(n)
    k2 = (k**2).sum(0)
    k2[0, 0, 0] = 1.0
    spectrum = np.array([np.fft.fftn(random.standard_normal((n, n, n))) for _ in range(3)])
    spectrum -= k * (k * spectrum).sum(0) / k2
    velocity = np.array([np.fft.ifftn(s).real for s in spectrum])
    has = shells(velocity)
    unit = 2 * np.pi / SIDE
    wanted = measured("E42", np.maximum(np.arange(n // 2), 0.1) * unit) * unit
    scale = np.zeros(n * 2)
    scale[1:n // 2] = np.sqrt(wanted[1:] / has[1:])
    factor = scale[np.rint(np.sqrt((k**2).sum(0))).astype(int)]
    return np.array([np.fft.ifftn(np.fft.fftn(v) * factor).real for v in velocity])


def pressure(velocity):
    """Pressure over density of the incompressible field, in units of the velocity squared."""
    n = velocity.shape[1]
    k = wave_numbers(n)
    k2 = (k**2).sum(0)
    k2[0, 0, 0] = 1.0
    p = -sum(k[a] * k[b] * np.fft.fftn(velocity[a] * velocity[b]) for a in range(3) for b in range(3)) / k2
    p[0, 0, 0] = 0.0
    return np.fft.ifftn(p).real


def decay(program, n, subgrid, collision, folder):
    velocity = start(n, seed=1)
    speed = np.sqrt((velocity**2).mean()) / RMS_LATTICE      # cm/s per cell a step
    dx = SIDE / n
    dt = dx / speed
    lattice = velocity / speed
    file = Path(folder) / "start"
    np.concatenate([[3 * pressure(lattice)], lattice]).astype(np.float32).tofile(file)
    steps = [round(t / dt) for t in STATIONS]
    subprocess.run([program, "--cells", str(n), "--excess", repr(3 * VISCOSITY * dt / dx**2), *OPTIONS[subgrid],
                    "--collision", collision, "--start", str(file), "--steps"]
                   + [str(s) for s in steps], check=True)
    fields = [np.fromfile(f"{file}.{s}", np.float32).reshape(3, n, n, n).astype(float) * speed for s in steps]
    return [shells(f) for f in [velocity] + fields]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--figure", default=str(Path(__file__).with_name("decaying_turbulence.png")))
    arguments = parser.parse_args()
    unit = 2 * np.pi / SIDE
    passed, drawn = True, {}
    print("| cells | collision | subgrid model | energy at 98, cm^2/s^2 | measured | energy at 171 | measured |")
    print("|---|---|---|---|---|---|---|")
    runs = [(64, "bgk", "C_s = 0.17"), (64, "trt", "C_s = 0.17"), (32, "bgk", "C_s = 0.17"), (64, "bgk", "C_s = 0.10"),
            (64, "bgk", "C_s = 0.27"), (64, "bgk", "qr")]
    for n, collision, subgrid in runs:
        with tempfile.TemporaryDirectory() as folder:
            spectra = decay(arguments.program, n, subgrid, collision, folder)
        k = np.arange(n // 2) * unit
        text = ""
        for spectrum, column in zip(spectra[1:], ("E98", "E171")):
            expected = measured(column, k[1:]).sum() * unit
            error = spectrum[1:].sum() / expected - 1
            text += f" {spectrum[1:].sum():.0f} ({100 * error:+.1f} %) | {expected:.0f} |"
            if (n, subgrid) == (64, "C_s = 0.17"):
                passed = passed and abs(error) <= ACCEPTED
        drawn[n, collision, subgrid] = (k, spectra)
        print(f"| {n} | {collision} | {subgrid} |{text}")

    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), sharey=True)
    for axis, chosen in zip(axes, (runs[:2], [runs[5], runs[0], runs[4]])):
        for style, run in zip(("-", "--", ":"), chosen):
            k, spectra = drawn[run]
            for s, colour in zip(spectra, ("C0", "C1", "C2")):
                label = f"{run[1]}, {run[2]}" if colour == "C0" else None
                axis.loglog(k[1:], s[1:] / unit, style, color=colour, label=label)
        for column, colour in zip(("E42", "E98", "E171"), ("C0", "C1", "C2")):
            axis.loglog(*reference(column), "o", ms=4, mfc="none", color=colour)
        axis.set(xlabel="k, 1/cm", ylim=(2, 1000), xlim=(0.1, 5))
        axis.legend(fontsize=8)
    axes[0].set(ylabel="E, cm³/s²", title="64³: collisions; t U₀/M = 42, 98, 171", )
    axes[1].set(title="64³: subgrid models")
    figure.tight_layout()
    figure.savefig(arguments.figure, dpi=80)
    print("passed" if passed else "FAILED")
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
