"""Random cases (random_cases.py) whose grains have places in the case, which can be moved with everything else."""
import numpy

from random_cases import SIZE, velocity


def reaches_of(case):
    """Centres and radii of spheres around solids and plates."""
    for solid in case.get("solids", []):
        if "sphere" in solid:
            yield solid["sphere"]["centre"], solid["sphere"]["radius"]
        else:
            yield solid["translate"], 3 ** 0.5 / 2 * solid["scale"]   # a cube of side 1
    for wall in case.get("walls", []):
        yield wall["point"], 9e-3


def free_places(chance, count, radius, taken, periodic):
    """Up to `count` centres of spheres of a radius that clear each other and those taken, to which they are added."""
    places = []
    for _ in range(200 * count):
        here = [chance.uniform(0 if p else radius, side if p else side - radius) for p, side in zip(periodic, SIZE)]
        for other, reach in taken:
            apart = numpy.subtract(here, other)
            apart -= [side * round(x / side) if p else 0 for x, side, p in zip(apart, SIZE, periodic)]
            if numpy.linalg.norm(apart) < radius + reach:
                break
        else:
            places.append(here)
            taken.append((here, radius))
        if len(places) == count:
            break
    return places


def place_grains(chance, case, periodic):
    """Gives every population one size and random places, clear of each other and of solids and plates; what finds no room
    is left out. periodic: of the axes.
    """
    taken, placed = list(reaches_of(case)), []
    for grains in case["grains"]:
        diameter = radius = 5.2e-3   # of a clump, which reaches no farther than its diameter from its centre
        if "shape" in grains:
            grains["orientation"] = {"axis": velocity(chance, 1), "angle": chance.uniform(0, 6)}
        else:
            diameter = chance.choice([4.0e-3, 4.8e-3, 5.6e-3])
            radius = 0.5 * diameter
        places = free_places(chance, grains.pop("count"), 1.001 * radius, taken, periodic)
        if places:
            placed.append({**grains, "diameter": diameter, "placement": {"positions": places}})
    case["grains"] = placed
