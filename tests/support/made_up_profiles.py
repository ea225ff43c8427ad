"""Means over the height in a profiles.h5, made up."""
import h5py
import numpy as np

FULL, HALF = "xx xy xz yx yy yz zx zy zz", "xx yy zz xy xz yz"


def add_ones(group, components, layers):
    for name, words in components.items():
        group[name] = np.ones((layers, len(words.split())))
        group[name].attrs["components"] = words


def write_grain_profiles(path, diameter):
    """A bed of six diameters (m) in thirty layers; every velocity and stress is 1."""
    z = (np.arange(30) + 0.5) * diameter
    with h5py.File(path, "w") as file:
        group = file.create_group("grain_profiles")
        group["z"], group["solid_fraction"] = z, np.where(z < 6 * diameter, 0.5, 0.0)
        add_ones(group, {"velocity": "x y z", "contact_stress": FULL, "kinetic_stress": HALF}, 30)


def add_stress_balance(path, diameter):
    """The same bed in sixty layers; every velocity and stress is 1."""
    z = (np.arange(60) + 0.5) * 0.5 * diameter
    with h5py.File(path, "a") as file:
        group = file.create_group("stress_balance")
        group["z"], group["solid_fraction"] = z, np.where(z < 6 * diameter, 0.5, 0.0)
        add_ones(
            group,
            {
                "grain_velocity": "x y z", "fluid_velocity": "x y z", "contact_stress": FULL,
                "grain_fluid_stress": FULL, "lubrication_stress": FULL, "kinetic_stress": HALF, "viscous_stress": HALF,
                "subgrid_stress": HALF, "reynolds_stress": HALF,
            }, 60,
        )
        for name in ("rotation_stress", "total_stress", "side_wall_stress", "driving_stress"):
            group[name] = np.ones(60)
