"""Speed of the water between side walls, far above the bed: measured, and by the law of the wall."""
import numpy as np

from thalweg.errors import RunFolderError

VON_KARMAN, INTERCEPT, SUBLAYER = 0.41, 5.0, 10.8   # u+ = ln(y+)/kappa + B beyond y+ = 10.8, u+ = y+ below
SMALLEST_HALF_WIDTH = 100.0   # in wall units: narrower flows are not turbulent
FAR = 2.0                     # widths above the bed, where the side walls alone hold the water back


def law_of_the_wall(distance, friction_velocity, viscosity):
    """Mean velocity (m/s) of a turbulent flow at a distance (m) from a smooth wall."""
    inner = np.asarray(distance, float) * friction_velocity / viscosity
    return friction_velocity * np.where(inner < SUBLAYER, inner, np.log(np.maximum(inner, 1.0)) / VON_KARMAN + INTERCEPT)


def expected_middle_speed(run):
    """m/s, half-way between side walls that carry all of the water's weight along the slope, far above the bed (Zhang et al.
    2022, app. A): friction velocity sqrt(g_x W/2). None without such walls, or where that flow would not be turbulent."""
    along = run.gravity[0]
    if not run.side_walls or not along > 0.0:
        return None
    half, viscosity = 0.5 * run.size[1], run.case["fluid"]["kinematic_viscosity"]
    friction_velocity = np.sqrt(along * half)
    if friction_velocity * half / viscosity < SMALLEST_HALF_WIDTH:
        return None
    return float(law_of_the_wall(half, friction_velocity, viscosity))


def middle_speed(run, start, stop, above):
    """Mean streamwise velocity (m/s) of the fluid half-way between the side faces above a height (m), one value for each
    picture between two times (s). Pictures of a slice elsewhere, or without the velocity, are refused."""
    speeds = []
    for frame in run.fluid.between(start, stop):
        if "velocity" not in frame.arrays:
            raise RunFolderError(f"{frame.path}: there is no velocity in it (output.fluid.fields).")
        y, z = frame.centres(1), frame.centres(2)
        middle = int(np.argmin(np.abs(y - 0.5 * run.size[1])))
        if abs(y[middle] - 0.5 * run.size[1]) > 0.75 * frame.spacing[1] or not (z > above).any():
            raise RunFolderError(f"{frame.path}: it shows nothing of the middle plane above {above:.4g} m.")
        velocity = frame.arrays["velocity"][z > above, middle, :, 0]
        water = np.ones(velocity.shape, bool)
        if "grain_id" in frame.arrays:
            water = frame.arrays["grain_id"][z > above, middle] < 0
        speeds.append(np.mean(velocity[water]))
    if not speeds:
        raise RunFolderError(f"{run.folder}: there is no picture of the fluid between {start:g} and {stop:g} s.")
    return np.array(speeds)
