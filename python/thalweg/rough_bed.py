"""Water over a floor of fixed spheres without side walls: bulk velocity, equivalent sand roughness and logarithmic
profile.

The flow begins at the height 0.8 d of the virtual wall, as in Chan-Braun et al. (2011) and Mazzuoli and Uhlmann (2017):
u*, the bulk velocity and the logarithmic law refer to the depth from there to the surface.
"""
from dataclasses import dataclass

import numpy as np

from thalweg.bed import rows_between
from thalweg.errors import RunFolderError
from thalweg.means import mean_with_error
from thalweg.water import VON_KARMAN

VIRTUAL_WALL = 0.8            # diameters above the floor
LOGARITHMIC = 2.2, 0.95       # the law is fitted from there (diameters above the floor) to that part of the height


@dataclass
class RoughFlow:
    friction_velocity: float   # m/s, sqrt(g_x h)
    grain_reynolds: float      # D+: u* d/nu
    depth: float               # diameters, above the virtual wall
    bulk_velocity: float       # of u*, mean over the depth and over time
    bulk_error: float          # of u*, of that mean

    @property
    def roughness(self):
        """k_s in diameters, of a logarithmic profile with this mean."""
        return roughness_of(self.bulk_velocity, self.depth)


def roughness_of(bulk_velocity, depth):
    """k_s of the profile u/u* = ln(30 z/k_s)/0.41 over a depth, with a mean of bulk_velocity (in u*); in units of the
    depth."""
    return 30.0 * depth * np.exp(-1.0 - VON_KARMAN * bulk_velocity)


def friction_velocity(run):
    """m/s: of the water above the virtual wall, sqrt(g sin(alpha) h)."""
    return float(np.sqrt(run.gravity[0] * (run.size[2] - VIRTUAL_WALL * run.diameter)))


def rough_flow(run, start):
    """From the momentum of the water from a time (s) on; that below the virtual wall, 1 % of it, counts to the flow
    above."""
    depth = run.size[2] - VIRTUAL_WALL * run.diameter
    momentum = mean_with_error(run.series["fluid_momentum_x"][rows_between(run, start, np.inf)])
    u_star, density = friction_velocity(run), float(run.case["fluid"]["density"])
    in_u_star = 1.0 / (density * run.size[0] * run.size[1] * depth * u_star)
    return RoughFlow(
        u_star, u_star * run.diameter / float(run.case["fluid"]["kinematic_viscosity"]), depth / run.diameter,
        momentum.mean * in_u_star, momentum.error * in_u_star,
    )


def plus_profile(run):
    """Height in diameters above the virtual wall and mean velocity in u*, of the middles of the layers."""
    means = run.profiles.get("fluid_statistics")
    if means is None:
        raise RunFolderError(
            f"{run.folder}: there are no means of the fluid yet (analysis.fluid_statistics in the case)."
        )
    return means["z"] / run.diameter - VIRTUAL_WALL, means["velocity"][:, 0] / friction_velocity(run)


def von_karman_number(run):
    """1 over the slope of u/u* over ln(z), from 1.4 diameters above the virtual wall to 95 % of the height."""
    height, plus = plus_profile(run)
    top = run.size[2] / run.diameter
    fitted = (height > LOGARITHMIC[0] - VIRTUAL_WALL) & (height < LOGARITHMIC[1] * top - VIRTUAL_WALL)
    return 1.0 / float(np.polyfit(np.log(height[fitted]), plus[fitted], 1)[0])
