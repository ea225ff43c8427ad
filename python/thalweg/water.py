"""Speed of the water between side walls, far above the bed: measured, and by the law of the wall."""
from typing import NamedTuple

import numpy as np

from thalweg.errors import RunFolderError

VON_KARMAN, INTERCEPT, SUBLAYER = 0.41, 5.0, 10.8   # u+ = ln(y+)/kappa + B beyond y+ = 10.8, u+ = y+ below
SMALLEST_HALF_WIDTH = 100.0   # in wall units: narrower flows are not turbulent
FAR = 2.0                     # widths above the bed, where the side walls alone hold the water back
SMOOTH_WALLS = ("no_slip", "law_of_the_wall", "slip_law_of_the_wall")   # at rest, where the law of the wall holds


class Speeds(NamedTuple):
    """Streamwise velocities in m/s."""
    mean: float     # over the width
    middle: float   # half-way between the side walls


def logarithmic_law(inner):
    """u+ at y+ beyond the sublayer."""
    return np.log(inner) / VON_KARMAN + INTERCEPT


def law_of_the_wall(distance, friction_velocity, viscosity):
    """Mean velocity (m/s) of a turbulent flow at a distance (m) from a smooth wall."""
    inner = np.asarray(distance, float) * friction_velocity / viscosity
    return friction_velocity * np.where(inner < SUBLAYER, inner, logarithmic_law(np.maximum(inner, 1.0)))


def expected_speeds(run):
    """Speeds between side walls that carry all of the water's weight along the slope, far above the bed (Zhang et al.
    2022, app. A): friction velocity sqrt(|g_x| W/2), along x or -x as the slope. None where anything else drives the
    water or holds it (a mean velocity, an inlet, a top that moves or drags, solids, walls that move or slip by a
    length), where a restart changed gravity within the means of the fluid, and where that flow would not be
    turbulent."""
    smooth_walls = all(face in SMOOTH_WALLS for face in run.faces("y"))
    if not smooth_walls or not run.driven_by_slope or run.case.get("solids"):
        return None
    if run.driven_alike_since > run.averaged_from("fluid_statistics"):
        return None
    half, viscosity = 0.5 * run.size[1], run.case["fluid"]["kinematic_viscosity"]
    way, friction_velocity = np.sign(run.gravity[0]), np.sqrt(abs(run.gravity[0]) * half)
    if friction_velocity * half / viscosity < SMALLEST_HALF_WIDTH:
        return None
    across = (np.arange(1000) + 0.5) / 1000 * half
    return Speeds(float(way * np.mean(law_of_the_wall(across, friction_velocity, viscosity))),
                  float(way * law_of_the_wall(half, friction_velocity, viscosity)))


def measured_speeds(run, above):
    """Speeds above a height (m) in the mean over time that `analysis.fluid_statistics` gathered in profiles.h5."""
    means = run.profiles.get("fluid_statistics")
    if means is None or not np.any(means["section_fluid_fraction"]):
        raise RunFolderError(
            f"{run.folder}: there are no means of the fluid yet (analysis.fluid_statistics in the case)."
        )
    far = means["z"] > above
    if not far.any():
        raise RunFolderError(
            f"{run.folder}: the water is less than {FAR:g} widths of the box deep, and near the bed its speed is not that "
            "of the side walls alone."
        )
    section = means["section_velocity"][far, :, 0].mean(axis=0)
    count = len(section)
    return Speeds(float(section.mean()), float(section[(count - 1) // 2:count // 2 + 1].mean()))
