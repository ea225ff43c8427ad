"""Mirrors, turns and shifts of a case: another case, whose flow and grains are the mirrored, turned and shifted ones.

Symmetry: which axis becomes which, with which sign, and by how many cells everything moves along the new ones. Velocities
and forces turn with the axes; spins and torques keep their sign in a mirror.
"""
import itertools

import numpy

from random_cases import SIZE, SPACING

FACES = (("x_low", "x_high"), ("y_low", "y_high"), ("bottom", "top"))
DIRECTIONS = [   # of D3Q19, in the order of its populations
    (0, 0, 0), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1), (1, 1, 0), (-1, -1, 0), (1, -1, 0),
    (-1, 1, 0), (1, 0, 1), (-1, 0, -1), (1, 0, -1), (-1, 0, 1), (0, 1, 1), (0, -1, -1), (0, 1, -1), (0, -1, 1),
]


def signed_axes(with_z):
    """All 48 ways to lay axes on each other, or the 8 that leave z as it is; the first changes nothing."""
    return [(to, signs) for to in itertools.permutations(range(3)) for signs in itertools.product((1, -1), repeat=3)
            if with_z or (to[2] == 2 and signs[2] == 1)]


class Symmetry:
    """to: the new axis of each old one. signs: 1, or -1 where it is mirrored. shift: cells along the new axes."""

    def __init__(self, to, signs, shift):
        self.to, self.signs, self.shift = to, signs, shift
        self.old = [to.index(axis) for axis in range(3)]   # the old axis of each new one
        self.matrix = numpy.zeros((3, 3))
        for axis in range(3):
            self.matrix[to[axis], axis] = signs[axis]
        self.mirrors = round(numpy.linalg.det(self.matrix))

    def __str__(self):
        axes = ", ".join(f"{'-' * (self.signs[old] < 0)}{'xyz'[old]}" for old in self.old)
        return f"axes ({axes}), shift {tuple(self.shift)}"

    def lengths(self, old):
        return [float(old[axis]) for axis in self.old]

    def vector(self, old):
        return (self.matrix @ numpy.asarray(old, float)).tolist()

    def spin(self, old):
        return (self.mirrors * self.matrix @ numpy.asarray(old, float)).tolist()

    def point(self, old, periodic=(False, False, False)):
        """periodic: of the old axes."""
        mirrored = [SIZE[axis] - x if self.signs[axis] < 0 else x for axis, x in enumerate(old)]
        new = [mirrored[axis] + SPACING * cells for axis, cells in zip(self.old, self.shift)]
        return [x % SIZE[axis] if periodic[axis] else x for axis, x in zip(self.old, new)]

    def populations(self, old):
        """old: over direction, z, y and x."""
        new = [None] * len(DIRECTIONS)
        for direction, values in zip(DIRECTIONS, old):
            turned = values.transpose(2, 1, 0)
            turned = numpy.flip(turned, [axis for axis in range(3) if self.signs[axis] < 0])
            turned = numpy.roll(turned.transpose(self.old), self.shift, (0, 1, 2))
            new[DIRECTIONS.index(tuple(map(round, self.vector(direction))))] = turned.transpose(2, 1, 0)
        return numpy.array(new)


def faces_in(faces, symmetry):
    both = {**faces}
    for axis in "xy":
        if axis in both:
            both[f"{axis}_low"] = both[f"{axis}_high"] = both.pop(axis)
    new = {}
    for axis, sides in enumerate(FACES):
        ahead = sides if symmetry.signs[axis] > 0 else sides[::-1]
        for side, other in zip(ahead, FACES[symmetry.to[axis]]):
            new[other] = moving(both[side], symmetry) if isinstance(both[side], dict) else both[side]
    for axis in "xy":
        if new[f"{axis}_low"] == "periodic":
            new[axis] = new.pop(f"{axis}_low")
            del new[f"{axis}_high"]
    return new


def moving(old, symmetry):
    """Of a face, a plane or the motion of a body."""
    new = {**old}
    for key in {"velocity", "normal"} & set(old):
        new[key] = symmetry.vector(old[key])
    if "point" in old:
        new["point"] = symmetry.point(old["point"])
    if "plate" in old:
        new["plate"] = {**old["plate"], "along": symmetry.vector(old["plate"]["along"])}
    if "oscillation" in old:
        new["oscillation"] = {**old["oscillation"], "amplitude": symmetry.vector(old["oscillation"]["amplitude"])}
    if "rotation" in old:
        turn = old["rotation"]
        new["rotation"] = {**turn, "point": symmetry.point(turn["point"]), "axis": symmetry.spin(turn["axis"])}
    return new


def grains_in(old, symmetry, periodic):
    new = {**old, "placement": {"positions": [symmetry.point(p, periodic) for p in old["placement"]["positions"]]}}
    for key in {"velocity", "prescribed_velocity"} & set(old):
        new[key] = symmetry.vector(old[key])
    for key in {"angular_velocity", "prescribed_angular_velocity"} & set(old):
        new[key] = symmetry.spin(old[key])
    if "motion" in old:
        new["motion"] = moving(old["motion"], symmetry)
    if "shape" in old:
        new["shape"] = {"clump": [{**one, "position": symmetry.vector(one["position"])} for one in old["shape"]["clump"]]}
        new["orientation"] = {**old["orientation"], "axis": symmetry.spin(old["orientation"]["axis"])}
    return new


def solid_in(old, symmetry):
    """A sphere, or a surface that is the same whichever way it is turned."""
    new = {**old}
    if "sphere" in old:
        new["sphere"] = {**old["sphere"], "centre": symmetry.point(old["sphere"]["centre"])}
    else:
        new["translate"] = symmetry.point(old["translate"])
    if "motion" in old:
        new["motion"] = moving(old["motion"], symmetry)
    return new


def case_in(old, symmetry, periodic):
    """periodic: of the old axes."""
    new = {
        **old,
        "domain": {**old["domain"], "size": symmetry.lengths(old["domain"]["size"]),
                   "boundaries": faces_in(old["domain"]["boundaries"], symmetry)},
        "gravity": {**old["gravity"], "vector": symmetry.vector(old["gravity"]["vector"])},
    }
    if "initial" in old:
        new["initial"] = {"fluid": {"uniform": symmetry.vector(old["initial"]["fluid"]["uniform"])}}
    if "grains" in old:
        new["grains"] = [grains_in(grains, symmetry, periodic) for grains in old["grains"]]
    if "solids" in old:
        new["solids"] = [solid_in(solid, symmetry) for solid in old["solids"]]
    if "walls" in old:
        new["walls"] = [moving(wall, symmetry) for wall in old["walls"]]
    return new
