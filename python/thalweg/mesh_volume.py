"""The volume between two heights that closed surfaces enclose together in a box, a place counted once however many of
them, or of their periodic images, enclose it: as the program has it (core/geometry/mesh_volume.hpp), from columns along
z with exact ends."""
import numpy as np

COLUMNS_A_SIDE = 250


class Columns:
    """Midpoints of the columns along an axis of the plan: of the surfaces' part of a box that ends there, else of all."""

    def __init__(self, places, size, periodic):
        lower, upper = (np.min(places), np.max(places)) if len(places) else (0.0, 0.0)
        self.wraps = periodic and (lower < 0.0 or upper > size)
        self.lower, upper = (0.0, size) if self.wraps else (max(lower, 0.0), min(upper, size))
        self.width = max(upper - self.lower, 0.0) / COLUMNS_A_SIDE

    def between(self, lower, upper):
        """Numbers of the columns between two places, and their midpoints."""
        first, last = (lower - self.lower) / self.width - 1.5, (upper - self.lower) / self.width + 0.5
        numbers = np.arange(np.ceil(first), np.floor(last) + 1.0)
        if not self.wraps:
            numbers = numbers[(numbers >= 0) & (numbers < COLUMNS_A_SIDE)]
        return numbers.astype(int) % COLUMNS_A_SIDE, self.lower + (numbers + 0.5) * self.width


def crosses_edge(one, other, x, y):
    """Where lines from (x, y) towards +x cross an edge in the plan, which holds its lower end but not its upper one. Both
    triangles that share the edge take it in the same order."""
    low, high = sorted((tuple(one[[1, 0, 2]]), tuple(other[[1, 0, 2]])))
    within = (low[0] <= y) & (y < high[0])
    rise = high[0] - low[0]
    return within & (x < low[1] + (y - low[0]) / (rise if rise else 1.0) * (high[1] - low[1]))


def ends_in(corners, along, across):
    """Columns that cross a triangle, as rows (number, height, 1 where a column enters or -1)."""
    (i, x), (j, y) = (axis.between(corners[:, a].min(), corners[:, a].max())
                      for a, axis in enumerate((along, across)))
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    if normal[2] == 0.0 or not len(x) or not len(y):
        return np.empty((0, 3))
    x, y = x[:, None], y[None, :]
    inside = np.zeros((len(i), len(j)), bool)
    for k in range(3):
        inside ^= crosses_edge(corners[k], corners[(k + 1) % 3], x, y)
    z = corners[0, 2] - (normal[0] * (x - corners[0, 0]) + normal[1] * (y - corners[0, 1])) / normal[2]
    number = i[:, None] * COLUMNS_A_SIDE + j[None, :]
    return np.column_stack([number[inside], z[inside], np.full(inside.sum(), 1.0 if normal[2] < 0.0 else -1.0)])


def volumes_in_layers(points, triangles, size, periodic, edges):
    """m^3 between one edge (m) and the next. points: m; triangles: anticlockwise seen from outside; size: of the box, m;
    periodic: along each of its axes."""
    used = points[np.unique(triangles)]
    along, across = (Columns(used[:, axis], size[axis], periodic[axis]) for axis in (0, 1))
    if not along.width * across.width > 0.0:
        return np.zeros(len(edges) - 1)
    ends = np.concatenate([ends_in(points[triangle], along, across) for triangle in triangles])
    ends = ends[np.lexsort((ends[:, 1], ends[:, 0]))]
    inside = np.cumsum(ends[:, 2])   # how many surfaces enclose what follows
    last = np.flatnonzero(inside == 0)
    first = np.concatenate([[0], last[:-1] + 1])
    lower, upper = (np.clip(ends[rows, 1], 0.0, size[2]) for rows in (first, last))
    below = [np.sum(np.minimum(upper, edge) - np.minimum(lower, edge)) for edge in edges]
    return np.diff(below) * along.width * across.width
