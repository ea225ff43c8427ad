#!/usr/bin/env python3
"""Growth rates of small disturbances on the lattice: linear_stability.py

Two flows: plane Couette flow between half-link walls eight cells apart, the upper moving at 0.1 cells per step, and a
uniform stream at the same velocity without walls. The step (collision, streaming, bounce-back) is linearised about the
flow; the largest eigenvalue over all wave numbers, minus one, is the growth per step (positive: unstable). The matrices
are written out from the definitions of the collisions, independently of the library.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
import thalweg_python

import numpy as np

C = np.array([[0, 0, 0]] + [[s * (a == b) for b in range(3)] for a in range(3) for s in (1, -1)] +
             [v for a, b in ((0, 1), (0, 2), (1, 2)) for t in (1, -1) for s in (1, -1)
              for v in [[s if k == a else s * t if k == b else 0 for k in range(3)]]])
W = np.array([1 / 3] + [1 / 18] * 6 + [1 / 36] * 12)
OPPOSITE = [int(np.where((C == -c).all(1))[0][0]) for c in C]
MAGIC = 3 / 16


BULK = 1.5 * W * ((C * C).sum(1) - 1)  # what a unit of the separate trace of the second moment adds to a population


def collision(tau, u, model, tau_bulk=None):
    """Derivative of the populations after the collision by those before, about the equilibrium at density 1."""
    after, rest = shear_collision(tau, u, model)
    if tau_bulk is None:
        return after
    return after + np.outer(BULK, (1 / tau - 1 / tau_bulk) * ((C * C).sum(1) @ rest))


def shear_collision(tau, u, model):
    """The same with one rate for the whole second moment, and the derivative of f - f_eq."""
    cu, identity = C @ u, np.eye(19)
    # f_eq = w [rho + 3 c.m + (9/2 (c.m)^2 - 3/2 m.m)/rho] with m the momentum.
    equilibrium = W[:, None] * (1 + 3 * C @ C.T + 9 * cu[:, None] * (C @ C.T) - 3 * (C @ u)[None, :]
                                - (4.5 * cu**2 - 1.5 * u @ u)[:, None])
    rest = identity - equilibrium
    if model == "bgk":
        return identity - rest / tau, rest
    swap = identity[OPPOSITE]
    return identity - (0.5 * (identity + swap) / tau
                       + 0.5 * (identity - swap) / (0.5 + MAGIC / (tau - 0.5))) @ rest, rest


def growth(matrix):
    return np.abs(np.linalg.eigvals(matrix)).max() - 1


def couette(excess, speed, model, cells=8, waves=8):
    collide = [collision(0.5 + excess, np.array([(z + 0.5) / cells * speed, 0, 0]), model) for z in range(cells)]
    best = (-1, 0, 0)
    for kx in np.linspace(0, np.pi, waves + 1):
        for ky in np.linspace(0, np.pi, waves + 1):
            step = np.zeros((19 * cells, 19 * cells), complex)
            phase = np.exp(-1j * (C[:, 0] * kx + C[:, 1] * ky))
            for z in range(cells):
                for i in range(19):
                    source = z - C[i, 2]
                    if 0 <= source < cells:
                        step[19 * z + i, 19 * source:19 * source + 19] += phase[i] * collide[source][i]
                    else:
                        step[19 * z + i, 19 * z:19 * z + 19] += collide[z][OPPOSITE[i]]
            best = max(best, (growth(step), kx / np.pi, ky / np.pi))
    return best


def stream(excess, speed, model, tau_bulk=None, waves=8):
    collide = collision(0.5 + excess, np.array([speed, 0, 0]), model, tau_bulk)
    sides = np.linspace(0, np.pi, waves + 1)
    return max(growth(np.exp(-1j * (C @ np.array([kx, ky, kz])))[:, None] * collide)
               for kx in sides for ky in sides for kz in sides)


def largest_stable_stream(excess, tau_bulk):
    stable = 0.0
    for speed in np.arange(1, 9) * 0.02:
        if stream(excess, speed, "bgk", tau_bulk) > 1e-9:
            break
        stable = speed
    return stable


def main():
    models = ("bgk", "trt")
    print("Couette flow, lid at 0.1: growth a step, and its wave number along and across the flow in units of pi\n")
    print("| tau - 1/2 | " + " | ".join(models) + " |\n|---|---|---|")
    for excess in (0.1, 0.05, 0.03, 0.02, 0.01, 0.003, 0.001):
        cells = [couette(excess, 0.1, m) for m in models]
        print(f"| {excess:g} | " + " | ".join("stable" if g < 1e-9 else f"{g:.4f} ({x:.2f}, {y:.2f})"
                                             for g, x, y in cells) + " |", flush=True)
    print("\nUniform stream at 0.1: growth a step\n")
    print("| tau - 1/2 | " + " | ".join(models) + " |\n|---|---|---|")
    for excess in (0.03, 0.01, 0.003, 0.001):
        print(f"| {excess:g} | " + " | ".join("stable" if g < 1e-9 else f"{g:.4f}"
                                             for g in (stream(excess, 0.1, m) for m in models)) + " |", flush=True)
    print("\nUniform stream at 0.05, bulk relaxation time 3: growth a step\n")
    print("| tau - 1/2 | " + " | ".join(models) + " |\n|---|---|---|")
    for excess in (0.1, 0.05, 0.03, 0.01, 0.003, 0.001):
        print(f"| {excess:g} | " + " | ".join("stable" if g < 1e-9 else f"{g:.4f}"
                                             for g in (stream(excess, 0.05, m, 3) for m in models)) + " |", flush=True)

    times = (None, 1, 1.5, 2, 3, 10)
    print("\nUniform stream, bgk: the largest velocity in steps of 0.02 that is stable, up to 0.16\n")
    print(
        "| tau - 1/2 | bulk as the shear | "
        + " | ".join(f"{t:g}" for t in times[1:])
        + " |\n"
        + "|---" * (len(times) + 1)
        + "|"
    )
    for excess in (0.01, 0.003, 0.001):
        print(
            f"| {excess:g} | " + " | ".join(f"{largest_stable_stream(excess, t):.2f}" for t in times) + " |", flush=True
        )


if __name__ == "__main__":
    main()
