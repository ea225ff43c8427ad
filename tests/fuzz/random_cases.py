"""Random valid cases: a small box with whatever the program can put into it, each part by the toss of a coin. They name a
surface box.stl, of side 1 about the origin.

random_case(chance) returns the content of a case, which begins with everything in motion, so that grains cross the
borders between ranks, meet walls and solids, come in and leave within the few steps of the run.
"""

SPACING = 0.8e-3                  # m
SIZE = (0.0288, 0.0192, 0.024)    # m: 36 x 24 x 30 cells
STEP, STEPS = 1.0e-4, 60          # s, of a fluid
DRY_STEP, DRY_STEPS = 1.0e-5, 600


def maybe(chance, content, key, value, odds=0.5):
    """Puts value() under the key, or leaves it to the default."""
    if chance.random() < odds:
        content[key] = value()


def corners(chance):
    """A region of at least a third of each side."""
    region = {"lower": [], "upper": []}
    for side in SIZE:
        length = side * chance.uniform(0.34, 1)
        start = chance.uniform(0, side - length)
        region["lower"].append(start)
        region["upper"].append(start + length)
    return region


def velocity(chance, largest):
    return [chance.uniform(-largest, largest) for _ in range(3)]


def oscillation(chance):
    return {"amplitude": velocity(chance, 5e-5), "frequency": chance.uniform(50, 200), "phase": chance.uniform(0, 6)}


def motion(chance, point):
    """Of a body: slow enough for one that has grains beside it."""
    content = {}
    maybe(chance, content, "velocity", lambda: velocity(chance, 0.03))
    maybe(chance, content, "oscillation", lambda: oscillation(chance))
    maybe(
        chance, content, "rotation",
        lambda: {"point": point, "axis": velocity(chance, 1), "angular_velocity": chance.uniform(-8, 8)},
    )
    return content or {"velocity": [0.02, 0, 0]}


# ---- the box

def boundaries(chance, fluid):
    """Faces of the three axes; with an inlet now and then."""
    def walls(axis):
        kinds = ["no_slip", "free_slip", "moving"]
        if fluid:
            kinds += ["law_of_the_wall", "slip_law_of_the_wall", "navier_slip"]
        kind = chance.choice(kinds)
        if kind == "navier_slip":
            return {"type": kind, "slip_length": 1e-4}
        if kind != "moving":
            return kind
        speed = velocity(chance, 0.05)
        if fluid:
            speed[axis] = 0.0
        face = {"type": kind, "velocity": speed}
        if not fluid:
            maybe(chance, face, "oscillation", lambda: oscillation(chance))
        return face

    content = {}
    if fluid and chance.random() < 0.25:
        content["x_low"] = {"type": "velocity_inlet", "velocity": [0.15, 0, 0]}
        maybe(chance, content["x_low"], "recycling_plane", lambda: 0.016, 0.4)
        content["x_high"] = "pressure_outlet"
    elif chance.random() < 0.75:
        content["x"] = "periodic"
    else:
        content["x_low"], content["x_high"] = walls(0), walls(0)
    if chance.random() < 0.5:
        content["y"] = "periodic"
    else:
        content["y_low"], content["y_high"] = walls(1), walls(1)
    if chance.random() < 0.15:
        content["bottom"] = content["top"] = "periodic"
    else:
        content["bottom"], content["top"] = walls(2), walls(2)
    return content


def is_periodic(faces, axis):
    return faces.get("xyz"[axis] if axis < 2 else "bottom") == "periodic"


def planes(chance):
    """Walls in the box, planes and plates, which grains of random places keep clear of."""
    def plane():
        along, other = velocity(chance, 1), velocity(chance, 1)
        normal = [along[1] * other[2] - along[2] * other[1], along[2] * other[0] - along[0] * other[2],
                  along[0] * other[1] - along[1] * other[0]]
        wall = {"point": [x * chance.uniform(0.4, 0.6) for x in SIZE], "normal": normal,
                "plate": {"along": along, "length": chance.uniform(4e-3, 9e-3), "width": 6e-3}}
        maybe(chance, wall, "friction", lambda: 0.7)
        maybe(chance, wall, "velocity", lambda: velocity(chance, 0.05))
        maybe(chance, wall, "oscillation", lambda: oscillation(chance))
        return wall
    return [plane() for _ in range(chance.randint(1, 2))]


# ---- grains

def sizes(chance):
    return chance.choice([
        {"value": 4.8e-3},
        {"sizes": [4.0e-3, 4.8e-3, 5.6e-3], "fractions": [0.5, 0.25, 0.25]},
        {"distribution": "lognormal", "median": 4.6e-3, "geometric_deviation": 1.1, "minimum": 4.0e-3,
         "maximum": 5.6e-3},
        {"d16": 4.2e-3, "d50": 4.6e-3, "d84": 5.0e-3},
    ])


def clump(chance):
    return {"clump": [{"position": [0, 0, 0], "diameter": 4.8e-3},
                      {"position": [1.6e-3, 0, 0.4e-3], "diameter": 4.0e-3}]}


def populations(chance, floating):
    grains = []
    for number in range(chance.randint(1, 3)):
        grain = {
            "diameter": sizes(chance), "density": chance.choice([2550, 2650, 1200] + [800] * floating),
            "count": chance.randint(2, 12),
            "placement": {"pattern": "random", "seed": chance.randint(1, 99)},
        }
        kind = chance.choice(["free", "free", "free", "clump", "clump", "fixed", "prescribed", "motion"])
        if number == 0 and kind not in ("free", "clump"):
            kind = "free"
        if kind == "clump":
            grain["shape"] = clump(chance)
            grain["count"] = chance.randint(2, 6)
            grain["diameter"] = {"value": 5.2e-3}
        if kind == "fixed":
            grain["fixed"] = True
        if kind == "prescribed":
            grain["prescribed_velocity"] = velocity(chance, 0.05)
            grain["prescribed_angular_velocity"] = velocity(chance, 20)
            grain["count"] = 1
        if kind == "motion":
            grain["motion"] = motion(chance, [x / 2 for x in SIZE])
            grain["count"] = 1
        maybe(chance, grain, "contact", lambda: {"friction": 0.2}, 0.3)
        if kind in ("free", "clump"):
            maybe(chance, grain, "velocity", lambda: velocity(chance, 0.3), 0.8)
            maybe(chance, grain, "angular_velocity", lambda: velocity(chance, 60))
        grains.append(grain)
    return grains


def contact(chance, fluid):
    content = {"friction": chance.choice([0, 0.3, 0.5]), "wall_friction": chance.choice([0, 0.45])}
    if chance.random() < 0.25:
        content.update(law="hertz_mindlin", youngs_modulus=1e7, restitution=0.8)
    else:
        if chance.random() < 0.6:
            content["restitution"] = chance.uniform(0.3, 1)
        else:
            content["damping"] = 0.05
        if not fluid or chance.random() < 0.4:
            content["normal_stiffness"] = 2000
        maybe(chance, content, "walls", lambda: {"normal_stiffness": 3000, "tangential_stiffness": 800}, 0.3)
    maybe(chance, content, "kinetic_friction_ratio", lambda: 0.6, 0.3)
    maybe(chance, content, "rolling_friction", lambda: 0.05, 0.3)
    maybe(chance, content, "wall_rolling_friction", lambda: 0.05, 0.3)
    maybe(chance, content, "attraction", lambda: "none", 0.3)
    maybe(chance, content, "liquid_bridge", lambda: {"surface_tension": 0.07, "volume": 1e-10}, 0.2)
    return content


def turnover(chance, content, faces):
    """Supplies and sinks."""
    free = [n for n, g in enumerate(content["grains"]) if not {"fixed", "motion", "prescribed_velocity"} & set(g)]
    if chance.random() < 0.35:
        supply = {"population": chance.choice(free), "rate": chance.choice([200, 1000]), "region": corners(chance),
                  "seed": chance.randint(1, 99)}
        maybe(chance, supply, "velocity", lambda: velocity(chance, 0.2))
        if not is_periodic(faces, 2):
            maybe(chance, supply, "above_bed", lambda: {"lower": 0.003, "upper": 0.015}, 0.3)
        content["supplies"] = [supply]
    outlet = faces.get("x_high") == "pressure_outlet"
    if outlet or chance.random() < 0.35:
        sink = {"region": {"lower": [SIZE[0] - (13e-3 if outlet else 6e-3), 0, 0], "upper": list(SIZE)}}
        maybe(chance, sink, "recirculation",
              lambda: {"delay": chance.choice([0, 1e-3]), "region": corners(chance), "seed": chance.randint(1, 99)})
        content["sinks"] = [sink]


# ---- fluid and what it does to grains

def fluid(chance, faces):
    content = {"density": 1000, "kinematic_viscosity": chance.choice([1e-6, 1e-5]), "time_step": STEP,
               "precision": chance.choice(["single", "double"])}
    maybe(chance, content, "collision", lambda: chance.choice(["bgk", "trt", "trt_at_bodies"]))
    maybe(chance, content, "subgrid_model", lambda: chance.choice(["qr", "smagorinsky"]))
    maybe(chance, content, "bulk_relaxation_time", lambda: chance.choice([0, 1]), 0.3)
    if is_periodic(faces, 0):
        maybe(chance, content, "mean_velocity", lambda: {"velocity": 0.2, "response_time": 0.02}, 0.2)
    return content


def start_of_fluid(chance, faces):
    if is_periodic(faces, 2) or chance.random() < 0.5:
        return {"uniform": [0.15, 0, 0]}
    profile = {"bed_height": 0.004, "shear_velocity": 0.02, "roughness": 3e-4}
    maybe(chance, profile, "perturbation", lambda: {"amplitude": 1, "seed": chance.randint(1, 99)})
    return {"log_profile": profile}


def coupling(chance, case):
    content = {}
    if case["fluid"].get("collision") == "trt":
        maybe(chance, content, "links", lambda: "cli")
    maybe(chance, content, "momentum_exchange", lambda: "classical", 0.3)
    maybe(chance, content, "covered_momentum", lambda: "to_grain", 0.3)
    maybe(chance, content, "load", lambda: "mean", 0.3)
    maybe(chance, content, "lubrication", lambda: {}, 0.4)
    return content


def solids(chance, moving):
    found = []
    for _ in range(chance.randint(1, 2)):
        centre = [x * chance.uniform(0.3, 0.7) for x in SIZE]
        if chance.random() < 0.6:
            solid = {"sphere": {"centre": centre, "radius": chance.uniform(2e-3, 4e-3)}}
        else:
            solid = {"stl": "box.stl", "scale": chance.uniform(2e-3, 5e-3), "translate": centre}
        if moving:
            maybe(chance, solid, "motion", lambda: motion(chance, centre))
        found.append(solid)
    return found


# ---- what is measured and written

def every(chance, step):
    return step * chance.choice([1, 3, 7, 10])


def analysis(chance, case, step, end):
    content = {}
    grains, water = "grains" in case, "fluid" in case

    def watched(name, possible, more=lambda: {}):
        if possible and chance.random() < 0.5:
            content[name] = {"every": every(chance, step), **more()}
            maybe(chance, content[name], "from", lambda: end * chance.choice([0.2, 0.4, 0.6]), 1 if ramp else 0.5)

    ramp = case["run"].get("ramp", 0)
    resting = not is_periodic(case["domain"]["boundaries"], 2)
    watched("transport_rate", grains)
    watched("fractional_transport", grains and resting)
    watched("reach", grains and resting, lambda: {"record_every": end / 4, "sections": 5})
    watched("bed_surface", grains and resting)
    watched("grain_profiles", grains)
    watched("stress_balance", grains and water and resting)
    watched("fluid_statistics", water)
    if grains:
        maybe(chance, content, "population_loads", dict)
        maybe(chance, content, "tracks", lambda: {"every": every(chance, step), "one_in": chance.randint(1, 3)})
        maybe(chance, content, "wall_forces", dict)
    if grains and water and resting:
        maybe(
            chance, content, "entrainment",
            lambda: {"from": ramp, "memory": 5 * step, "refresh": 20 * step, "rest_time": 0, "displacement": 0.01}, 0.3,
        )
    if water:
        maybe(
            chance, content, "probes",
            lambda: {"every": every(chance, step), "points": [[x * chance.random() for x in SIZE] for _ in range(3)],
                     "lines": [{"from": [1e-4, 1e-4, 1e-4], "to": [x * 0.99 for x in SIZE], "points": 7}]},
        )
    return content


def output(chance, case, step, end):
    content = {"series": {"every": every(chance, step)}, "checkpoint": {"every": end / 2, "keep": 3}}
    if "grains" in case:
        maybe(chance, content, "grains", lambda: {"every": end / 3})
        maybe(
            chance, content, "grain_parts",
            lambda: [{"name": "part", "every": end / 4, "population": 0, "fields": ["id", "velocity"]}], 0.3,
        )
    if "fluid" in case:
        fields = ["velocity", "pressure", "grain_id", "density", "shear_rate", "eddy_viscosity", "vorticity",
                  "q_criterion"]
        maybe(
            chance, content, "fluid",
            lambda: {"every": end / 2, "region": chance.choice(["whole", "slice_x", "slice_y", "slice_z"]),
                     "stride": chance.choice([1, 2, 5]), "fields": chance.sample(fields, chance.randint(1, 8))},
        )
    return content


# ---- whole cases

def make_disks(case):
    """Two dimensions: single grains that move in the plane of x and z."""
    case["disks"] = {"thickness": 4e-3}
    faces = case["domain"]["boundaries"]
    faces["y"] = "periodic"
    for face in [face for face in faces if face in ("y_low", "y_high")]:
        del faces[face]
    for face in faces.values():
        if isinstance(face, dict):
            face["velocity"][1] = 0.0
            face.pop("oscillation", None)
    case["grains"] = [
        {"diameter": grain["diameter"], "density": 2550, "count": min(grain["count"], 4), "placement": grain["placement"]}
        for grain in case["grains"]
    ]


def add_water(chance, case):
    faces = case["domain"]["boundaries"]
    case["fluid"] = fluid(chance, faces)
    case["initial"] = {"fluid": start_of_fluid(chance, faces)}
    maybe(chance, case, "solids", lambda: solids(chance, True), 0.4)


def add_grains(chance, case):
    water = "fluid" in case
    case["grains"] = populations(chance, water)
    case["contact"] = contact(chance, water)
    if case["system"] != "model_fluid":
        turnover(chance, case, case["domain"]["boundaries"])
    if not water and not {"supplies", "sinks"} & set(case) and chance.random() < 0.25:
        make_disks(case)


def add_coupling(chance, case):
    faces = case["domain"]["boundaries"]
    case["coupling"] = coupling(chance, case)
    if all(is_periodic(faces, axis) for axis in range(3)) and not {"supplies", "sinks"} & set(case):
        maybe(chance, case["gravity"], "mode", lambda: "balanced")
    elif not is_periodic(faces, 2) and faces.get("x_high") != "pressure_outlet":
        maybe(chance, case["gravity"], "mode", lambda: "full", 0.2)


def add_model_fluid(chance, case, step):
    case["gravity"] = {"magnitude": 9.8}
    content = {"shields_number": 0.2, "reynolds_number": chance.choice([0.5, 5]),
               "drag": chance.choice(["linear", "quadratic"])}
    maybe(chance, content, "lift_ratio", lambda: 0.3)
    maybe(chance, content, "ramp", lambda: {"every": 3 * step, "hold": 1, "largest_speed": 50}, 0.3)
    case["model_fluid"] = content


def add_obstacles(chance, case):
    """To dry grains."""
    if "disks" not in case:
        maybe(chance, case, "solids", lambda: solids(chance, False), 0.3)
        maybe(chance, case, "walls", lambda: planes(chance), 0.3)


def run(chance, case, step, end):
    content = {"until": end}
    if "fluid" in case:
        if case["gravity"].get("mode") != "full":
            maybe(chance, content, "ramp", lambda: end / 5, 0.2)
        return content
    content["time_step"] = step
    if case["system"] == "grains":
        if "supplies" not in case:
            maybe(chance, content, "until_at_rest",
                  lambda: {"largest_speed": 0.1, "largest_acceleration": 1, "quantile": 0.7}, 0.3)
    return content


def random_case(chance):
    system = chance.choice(["resolved", "resolved", "resolved", "grains", "grains", "model_fluid", "fluid"])
    water = system in ("resolved", "fluid")
    faces = {"x": "periodic", "y": "periodic", "bottom": "no_slip", "top": "free_slip"}
    if system != "model_fluid":
        faces = boundaries(chance, water)
    case = {"system": system, "name": "random", "domain": {"size": list(SIZE), "spacing": SPACING, "boundaries": faces},
            "gravity": {"magnitude": 9.8, "slope": chance.choice([0, 0.05, 0.3])}}
    step = STEP if water else DRY_STEP
    end = (STEPS if water else DRY_STEPS) * step
    if water:
        add_water(chance, case)
    if system != "fluid":
        add_grains(chance, case)
    if system == "resolved":
        add_coupling(chance, case)
    if system == "model_fluid":
        add_model_fluid(chance, case, step)
    if system == "grains":
        add_obstacles(chance, case)
    case["run"] = run(chance, case, step, end)
    case["analysis"] = analysis(chance, case, step, end)
    case["output"] = output(chance, case, step, end)
    return case
