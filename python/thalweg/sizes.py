"""Transport by size class (`analysis.fractional_transport`), as river scientists show it: rates by the share of the
surface or of the bed, gradings, and the armouring of the bed."""
import math

import numpy as np

from thalweg.bed import mean_between
from thalweg.errors import MissingName, RunFolderError
from thalweg.units import units_of


class Sizes:
    """The size classes of a run, the finest first, in the units of its case."""

    def __init__(self, run):
        found = run.fractional_transport
        self.run, self.edges, self.diameter = run, found["edges"], found["diameter"]
        self.bed_share, self.surface_share, self.load_share = (
            found[f"{what}_share"] for what in ("bed", "surface", "load")
        )
        self.q_s, self.q_s_error, self.density = found["q_s"], found["q_s_error"], found["density"]
        self.moving_grains = found["moving_grains"]
        self.q_star, self.q_star_error = found.get("q_star"), found.get(
            "q_star_error"
        )  # by the surface; None without a fluid
        self.bed_d50, self.surface_d50, self.load_d50 = (float(size) for size in found["d50"])

    @property
    def headings(self):
        """Of rows()."""
        return (f"sizes [{units_of(self.run).length}]", "bed", "surface", "load", "q*", "error", "W*", "moving grains")

    @property
    def armouring_ratio(self):
        """d50 of the surface over that of the bed: the mean of the ratios, or, as long as the run goes on, that of their
        means."""
        mean = ((self.run.summary or {}).get("fractional_transport") or {}).get("armouring_ratio_mean")
        return self.surface_d50 / self.bed_d50 if mean is None else mean

    @property
    def downstream(self):
        """1, or -1 where more grains go along -x."""
        return -1.0 if np.sum(self.q_s) < 0.0 else 1.0

    def q_star_by_bed(self):
        """q* of each class by its share of the bed, as Parker and Klingeman (1982), and its error; None without a
        fluid."""
        if self.q_star is None:
            return None
        with np.errstate(invalid="ignore", divide="ignore"):
            ratio = self.surface_share / self.bed_share
        return self.q_star * ratio, self.q_star_error * ratio

    def bed_stress(self):
        """Pa: mean over the time of the rates of what the run has measured (`analysis.bed_surface`), from series.csv
        where its own mean begins at another time; None where there is none."""
        run, start = self.run, self.run.averaged_from("fractional_transport")
        of_run = ((run.summary or {}).get("bed_surface") or {}).get("bed_stress_mean")
        if run.averaged_from("bed_surface") == start:
            return of_run
        try:
            return mean_between(run, "bed_stress", start, math.inf)
        except (RunFolderError, MissingName):
            return None

    def shear_velocity(self):
        """m/s, of the mean stress on the bed, whichever way it acts; None where it is not known."""
        stress = self.bed_stress()
        return math.sqrt(abs(stress) / self.run.section("fluid")["density"]) if stress else None

    def w_star(self):
        """W*_i = (s - 1) g q_si / (F_i u_*^3) of each class, F_i its share of the surface (Wilcock and Crowe 2003, eq.
        2); None where the shear velocity is not known."""
        velocity = self.shear_velocity()
        if velocity is None:
            return None
        weight = (self.density / self.run.section("fluid")["density"] - 1.0) * float(np.linalg.norm(self.run.gravity))
        with np.errstate(invalid="ignore", divide="ignore"):
            return weight * self.q_s / (self.surface_share * velocity**3)

    def finer(self, share):
        """Share that is finer than each of the edges, of the shares of the classes."""
        return np.concatenate([[0.0], np.cumsum(share)])

    def sentence(self):
        units = units_of(self.run)

        def text(size):
            return f"{units.per_length * size:.4g} {units.length}"
        load = (
            text(self.load_d50)
            if math.isfinite(self.load_d50)
            else "unknown, as there is no net transport"
        )
        return (
            f"d50 of the bed {text(self.bed_d50)}, of its surface {text(self.surface_d50)}, of the load {load}; armouring"
            f" ratio {self.armouring_ratio:.3g}"
        )

    def rows(self):
        """A row of texts for each class, under the headings."""
        def text(values, c, digits=3):
            return "" if values is None or not math.isfinite(values[c]) else f"{values[c]:.{digits}g}"
        w_star, edges = self.w_star(), units_of(self.run).per_length * self.edges
        return [
            (
                f"{edges[c]:.3g} to {edges[c + 1]:.3g}", text(self.bed_share, c),
                text(self.surface_share, c), text(self.load_share, c), text(self.q_star, c),
                text(self.q_star_error, c, 2), text(w_star, c), text(self.moving_grains, c),
            )
            for c in range(len(self.diameter))
        ]

    def numbers(self):
        """For a summary: SI units, lists over the classes."""
        arrays = {
            "edges": self.edges, "diameter": self.diameter, "bed_share": self.bed_share,
            "surface_share": self.surface_share, "load_share": self.load_share, "q_s": self.q_s,
            "q_s_error": self.q_s_error, "q_star": self.q_star, "q_star_error": self.q_star_error,
            "w_star": self.w_star(), "moving_grains": self.moving_grains,
        }
        numbers = {name: [float(value) for value in values] for name, values in arrays.items() if values is not None}
        return numbers | {"bed_d50": self.bed_d50, "surface_d50": self.surface_d50, "load_d50": self.load_d50,
                          "armouring_ratio": self.armouring_ratio}


def measured(run):
    """Whether the run has means by size class: profiles.h5 has the group from the first checkpoint on, also before they
    begin."""
    return "fractional_transport" in run.profiles and bool(run.fractional_transport["surface_share"].any())


def sizes_of(run):
    """The size classes of a run. Raises RunFolderError where the means have not begun."""
    if "fractional_transport" in run.profiles and not measured(run):
        raise RunFolderError(f"{run.folder}: nothing has been measured by size class yet; the means begin at "
                             f"{run.averaged_from('fractional_transport'):g} {units_of(run).named('s')}.")
    if "fractional_transport" not in run.profiles:
        raise RunFolderError(
            f"{run.folder / 'profiles.h5'}: it has no transport by size class (analysis.fractional_transport in the"
            " case; written with every checkpoint)."
        )
    return Sizes(run)
