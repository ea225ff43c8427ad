"""The units that figures show lengths, speeds and times in."""
import re
from typing import NamedTuple


class Units(NamedTuple):
    """Names of units, and how many of them are one of the unit of the case."""
    length: str
    per_length: float
    speed: str
    per_speed: float
    names: dict   # of the units of a run folder, where they are not those that a figure shows

    def named(self, unit):
        """What a unit of a run folder is called."""
        return self.names.get(unit, unit)

    def mathematical(self, unit):
        """The same in matplotlib's formulas."""
        return re.sub(r"\^(\d)", r"$^\1$", self.named(unit))


SI = Units("mm", 1e3, "cm/s", 1e2, {})
# Mean diameter D, mean mass m and reduced gravity g' are 1.
GRAIN = Units("D", 1.0, "sqrt(g'D)", 1.0, {
    "m": "D", "s": "sqrt(D/g')", "m/s": "sqrt(g'D)", "m/s^2": "g'", "m^2/s": "sqrt(g'D^3)", "m^2/s^2": "g'D",
    "kg": "m", "kg m/s": "m sqrt(g'D)", "kg/m^3": "m/D^3", "N": "m g'", "J": "m g'D", "Pa": "m g'/D^2",
})


def units_of(run):
    """Grain units where the case has them (model_fluid.units), else SI units with the prefixes of a small flume."""
    return GRAIN if (run.case.get("model_fluid") or {}).get("units") == "grain" else SI
