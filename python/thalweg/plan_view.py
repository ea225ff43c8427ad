"""A bed as it is seen from above."""
import numpy as np


def upper_sides(position, radius, x, y, periods=(None, None)):
    """Height (m) of the upper sides of spheres above the points x, y as [x, y]; 0 where there is none. periods: of the
    box along x and y in m; None: it ends there."""
    height = np.zeros((len(x), len(y)))
    for centre, r in zip(position, radius):
        apart = [points - place if period is None else (points - place + period / 2) % period - period / 2
                 for points, place, period in zip((x, y), centre, periods)]
        inside = r**2 - apart[0][:, None] ** 2 - apart[1] ** 2
        np.maximum(height, np.where(inside > 0, centre[2] + np.sqrt(np.maximum(inside, 0)), 0), out=height)
    return height
