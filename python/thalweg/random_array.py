"""A run of flow through spheres that are all held, as the comparisons with drag laws of random arrays need it."""
import numpy as np

from thalweg import Run


class RandomArray:
    """SI units. acceleration: of the fluid, along x; solid_fraction: of the spheres that the run has placed."""

    def __init__(self, folder):
        self.run = run = Run(folder)
        self.case, self.count = run.case, run.summary["grains"]
        self.density, self.viscosity = float(self.case["fluid"]["density"]), float(
            self.case["fluid"]["kinematic_viscosity"]
        )
        self.diameter, self.volume = float(self.case["grains"][0]["diameter"]), float(run.size.prod())
        self.acceleration = float(self.case["gravity"]["vector"][0])
        self.solid_fraction = self.count * np.pi / 6.0 * self.diameter**3 / self.volume
        self.cells = self.diameter / float(self.case["domain"]["spacing"])   # per diameter
