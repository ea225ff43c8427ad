#!/usr/bin/env python3
"""Prints the options of `thalweg run case.yaml` for an impact at a Stokes number: restitution.py ST [CELLS_A_DIAMETER
[STEPS]]

The sphere falls at its terminal velocity V by Schiller and Naumann's drag; the viscosity is the one for which St =
rho_s V d/(9 eta). In one fluid step the sphere falls 0.04 cells. A contact lasts STEPS fluid steps, about as long as
sound takes to cross the sphere on the lattice: in a shorter one the fluid around the sphere cannot reverse with it.
"""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import thalweg_python
from thalweg.literature import settling_speed

DIAMETER, SOLID, FLUID, GRAVITY = 6.0e-3, 7800.0, 950.0, 9.81


def terminal(viscosity):
    return settling_speed(DIAMETER, SOLID / FLUID, GRAVITY, viscosity)


def main():
    stokes = float(sys.argv[1])
    cells = float(sys.argv[2]) if len(sys.argv) > 2 else 10.0
    steps = float(sys.argv[3]) if len(sys.argv) > 3 else 2.0 * cells
    low, high = 1e-7, 1e-2
    for _ in range(100):
        viscosity = math.sqrt(low * high)
        if SOLID * terminal(viscosity) * DIAMETER / (9.0 * FLUID * viscosity) > stokes:
            low = viscosity
        else:
            high = viscosity
    velocity, spacing = terminal(viscosity), DIAMETER / cells
    step = 0.04 * spacing / velocity
    stiffness = SOLID * math.pi / 6.0 * DIAMETER ** 3 * (math.pi / (steps * step)) ** 2
    print(
        f"--set domain.spacing={spacing:.8g} --set fluid.kinematic_viscosity={viscosity:.6g} "
        f"--set fluid.time_step={step:.6g} --set contact.normal_stiffness={stiffness:.6g} "
        f"--set contact.tangential_stiffness={2.0 / 7.0 * stiffness:.6g} --set grains.0.velocity=[0,0,{-velocity:.5g}] "
        f"--set output.grains.every={0.2 * spacing / velocity:.5g} --until {4.0 * DIAMETER / velocity:.5g}"
    )


main()
