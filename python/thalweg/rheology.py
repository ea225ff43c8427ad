"""The state of a sheared mixture of grains and fluid, and the granular flow rule of Zhang et al. (2022).

Stresses come from the group `stress_balance` of profiles.h5. As in the paper, the solid's effective stress is that of
contacts, of velocity fluctuations and of the fluid on the grains (eq. 13), with the pore pressure added back (eq. 15);
positive in tension.
"""
from dataclasses import dataclass

import numpy as np

MU_1, MU_2, PHI_M, B, A = 0.37, 0.70, 0.62, 5.0, np.sqrt(0.5)   # of eqs. 20 and 21
PAIRS = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]         # of a symmetric tensor's six components


def mixed_friction(phi, viscous_number, mixed_number):
    """Stress ratio mu of eq. 20."""
    steady = MU_1 + (MU_2 - MU_1) / (1.0 + B / mixed_number)
    return steady + 2.5 * phi * viscous_number / (A * mixed_number) + 2.5 * phi * viscous_number


def mixed_fraction(mixed_number):
    """Solid fraction of eq. 21."""
    return PHI_M / (1.0 + A * mixed_number)


def symmetric(components):
    """Tensors [layer, 3, 3] from six components a layer (xx, yy, zz, xy, xz, yz)."""
    tensors = np.zeros((len(components), 3, 3))
    for value, (row, column) in zip(np.asarray(components).T, PAIRS):
        tensors[:, row, column] = tensors[:, column, row] = value
    return tensors


def solid_stress(layers):
    """Effective stress of the solid (Pa) [layer, 3, 3] from the columns of `stress_balance`."""
    whole = layers["contact_stress"] + layers["grain_fluid_stress"] + layers["lubrication_stress"]
    whole = whole.reshape(-1, 3, 3) + symmetric(layers["kinetic_stress"])
    return whole + (layers["solid_fraction"] * layers["fluid_pressure"])[:, None, None] * np.eye(3)


@dataclass
class FlowState:
    """Numbers or arrays of one length. Pressure and shear stress in Pa, the rate in 1/s."""
    solid_fraction: object
    shear_rate: object
    pressure: object
    shear_stress: object     # sqrt(s:s/2) of the deviatoric symmetric part
    viscous_number: object   # I_v = eta rate/p
    inertial_number: object  # I = rate d sqrt(rho_s/p)

    @property
    def friction(self):
        return self.shear_stress / self.pressure

    @property
    def mixed_number(self):
        return np.sqrt(2.0 * self.viscous_number + self.inertial_number**2)


def flow_state(solid_fraction, stress, shear_rate, diameter, density, viscosity):
    """stress: of the solid (Pa) [..., 3, 3]; shear_rate: 1/s; diameter: m; density: of the grains, kg/m^3; viscosity:
    dynamic, Pa s. NaN where the solid is not under pressure."""
    pressure = -np.trace(stress, axis1=-2, axis2=-1) / 3.0
    pressure = np.where(pressure > 0.0, pressure, np.nan)
    deviator = 0.5 * (stress + np.swapaxes(stress, -1, -2)) + pressure[..., None, None] * np.eye(3)
    shear = np.sqrt(0.5 * np.sum(deviator**2, axis=(-2, -1)))
    rate = np.abs(shear_rate)
    return FlowState(
        solid_fraction, rate, pressure, shear, viscosity * rate / pressure,
        rate * diameter * np.sqrt(density / pressure),
    )
