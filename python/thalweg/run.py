"""A run folder."""
import json
from functools import cached_property
from pathlib import Path

import numpy as np
import yaml

from thalweg.case_file import read_case
from thalweg.errors import MissingName, RunFolderError
from thalweg.frames import FluidFrame, Frames, GrainFrame, SolidFrame
from thalweg.hdf5 import columns_of, opened
from thalweg.history import last_change, sessions_of
from thalweg.records import Events, Probes, Records, parts_of
from thalweg.tables import read_series


def face_type(boundary):
    """A boundary is written as its type or as a mapping with the key type."""
    return boundary.get("type") if isinstance(boundary, dict) else boundary


# Faces that exchange shear with the fluid.
DRAGGING = ("no_slip", "moving", "navier_slip", "law_of_the_wall", "slip_law_of_the_wall")


class Run:
    """A run folder, finished or still going. What has been read stays as it was; make another Run to look again."""

    def __init__(self, folder):
        self.folder = Path(folder)
        if self.folder.name in ("", ".."):   # its name is that of the run
            self.folder = self.folder.resolve()
        if not (self.folder / "case.yaml").exists():
            raise RunFolderError(f"{self.folder}: there is no case.yaml in it; give the folder of a run.")

    @cached_property
    def case(self):
        """The case as it was run, as a dictionary; SI units."""
        path = self.folder / "case.yaml"
        try:
            case = read_case(path)
        except (yaml.YAMLError, ValueError):   # of text that is not UTF-8
            case = None
        if not isinstance(case, dict):
            raise RunFolderError(f"{path} is damaged: it is not the case as a run writes it.")
        return case

    @cached_property
    def series(self):
        """Columns of series.csv by name, `time` (s) among them. RunFolderError where there is none."""
        path = self.folder / "series.csv"
        every = ((self.case.get("output") or {}).get("series") or {}).get("every")
        if every == 0 and not path.exists():
            raise RunFolderError(
                f"{self.folder}: the case writes no series.csv (output.series.every: 0), from which means, errors and"
                " figures are made; those of the run itself are in summary.json and profiles.h5."
            )
        return read_series(path)

    @cached_property
    def grains(self):
        """Frames of the grains."""
        return Frames.of_index(self.folder / "grains.pvd", self._grain_frame)

    @cached_property
    def fluid(self):
        """Frames of the fluid."""
        return Frames.of_index(self.folder / "fluid.pvd", FluidFrame)

    @cached_property
    def solids(self):
        """Frames of the surfaces of the solids: one if they stand still."""
        return Frames.of_index(self.folder / "solids.pvd", SolidFrame)

    def fluid_part(self, name):
        """Frames of one of `output.fluid_parts` of the case, by its name."""
        return self._part("fluid_parts", name, FluidFrame)

    def grain_part(self, name):
        """Frames of one of `output.grain_parts` of the case, by its name; they may show no grain."""
        return self._part("grain_parts", name, self._grain_frame)

    def _grain_frame(self, time, path):
        return GrainFrame(time, path, self.disk_thickness)

    def _part(self, kind, name, frame):
        index = self.folder / kind / f"{name}.pvd"
        names = [part.get("name") for part in (self.case.get("output") or {}).get(kind) or []]
        if name not in names and not index.exists():
            raise MissingName(name, names, f"{self.folder / 'case.yaml'}: output.{kind}")
        return Frames.of_index(index, frame)

    @cached_property
    def profiles(self):
        """Means over time by group (`grain_profiles`, `fluid_statistics`), each with its arrays and their units; empty
        until the first checkpoint after they were begun."""
        path = self.folder / "profiles.h5"
        if not path.exists():
            return Profiles({}, path)
        with opened(path) as file:
            return Profiles({name: columns_of(group) for name, group in file.items()}, path)

    @property
    def fractional_transport(self):
        """Transport, surface and bed by size class (`analysis.fractional_transport`), the finest first: arrays over
        `diameter` (m), with `edges` (m) and `d50` (m: of bed, surface, load)."""
        return self.profiles["fractional_transport"]

    def _recorded(self, name):
        """Paths of the parts of what an observer records."""
        parts = parts_of(self.folder, name)
        if not parts:
            told = name in (self.case.get("analysis") or {})
            raise RunFolderError(
                f"{self.folder}: it has no {name} {'yet; they are written with the first checkpoint' if told else ''}"
                f"{'' if told else f'because its case has no analysis.{name}, which records them'}."
            )
        return parts

    @cached_property
    def tracks(self):
        """Tracks of single grains (`analysis.tracks`): `id`, `time` and arrays [time, grain, axis], of which `position`
        goes on where a grain leaves a periodic box, each read when it is asked for. RunFolderError where none are
        recorded."""
        parts = self._recorded("tracks")
        return Records(parts)

    @cached_property
    def probes(self):
        """Velocity (m/s) [time, point, axis] and pressure (Pa) [time, point] of the fluid at high rate
        (`analysis.probes`), with `time` (s) and `position` (m) [point, axis], the centres of the cells, each read when
        it is asked for. RunFolderError where none are recorded."""
        parts = self._recorded("probes")
        return Probes(parts, float(self.section("domain")["spacing"]))

    @cached_property
    def reach(self):
        """Sediment along x in time (`analysis.reach`): arrays [time, section] of transport and [time, x] of the bed,
        with `time` (s, of the end of a record), `interval` (s), `section` and `x` (m), each read when it is asked for;
        means over time are in `profiles["reach"]`. RunFolderError where none are recorded."""
        return Records(self._recorded("reach"))

    @cached_property
    def entrainment(self):
        """Events at which grains started to move (`analysis.entrainment`) by name, each with its arrays and, as
        `attributes`, its single numbers. RunFolderError where they are not looked for."""
        parts = self._recorded("entrainment")
        return Events(parts)

    @cached_property
    def bed(self):
        """The grains at the end of the run, with the columns of bed.h5; None before."""
        path = self.folder / "bed.h5"
        return read_bed(path) if path.exists() else None

    @cached_property
    def summary(self):
        """summary.json as a dictionary, or None while the run is going."""
        path = self.folder / "summary.json"
        try:
            return json.loads(path.read_text(encoding="utf-8-sig")) if path.exists() else None
        except ValueError:
            raise RunFolderError(
                f"{path} is damaged; thalweg run ... --restart {self.folder} writes it again."
            ) from None

    def result(self, observer, name):
        """A mean of summary.json: `name` of the group `observer`. Raises RunFolderError where there is none: of
        another name, or because the run is still going, or ended before it had measured anything."""
        summary = self.summary or {}
        if self.summary and observer not in summary:
            groups = [key for key, group in summary.items() if isinstance(group, dict)]
            raise RunFolderError(str(MissingName(observer, groups, str(self.folder / "summary.json"))))
        group = summary.get(observer) or {}
        if group and name not in group:
            raise RunFolderError(str(MissingName(name, group, f"{self.folder / 'summary.json'}: {observer}")))
        value = group.get(name)
        if value is None:
            raise RunFolderError(
                f"{self.folder}: there is no {observer}.{name}; nothing has been measured, or the run has not ended."
            )
        return value

    @cached_property
    def latest_checkpoint(self):
        """Path of the newest checkpoint, an HDF5 file; None before the first."""
        latest = self.folder / "checkpoints" / "latest"
        return latest.parent / latest.read_text(encoding="utf-8").strip() if latest.exists() else None

    def averaged_from(self, observer):
        """Time (s) at which the means of an observer begin: as the run said at its end, which is later than the key in
        the case where a restart has added or changed the observer; before that, by run.log and the key."""
        said = ((self.summary or {}).get(observer) or {}).get("mean_from")
        if said is not None:
            return float(said)
        key = float(((self.case.get("analysis") or {}).get(observer) or {}).get("from", 0.0))
        sessions = sessions_of(self.folder)
        return max(key, sessions[-1].averaged_from.get(observer, key)) if sessions else key

    @property
    def name(self):
        return self.case.get("name") or self.folder.name

    @property
    def system(self):
        """What was run: resolved, fluid, grains, model_fluid or continuum."""
        return self.case.get("system", "resolved")

    def section(self, name):
        """A section of the case, such as `grains`; RunFolderError where what was run has none."""
        found = self.case.get(name)
        if found is None:
            raise RunFolderError(
                f"{self.folder}: a run of system: {self.system} has no {'box' if name == 'domain' else name}."
            )
        return found

    @property
    def size(self):
        """Size (m) of the box along x, y, z; RunFolderError where there is none."""
        return np.array(self.section("domain")["size"], float)

    def faces(self, axis):
        """Types of the two faces across x, y or z ("x", "y", "z"), of which "periodic" comes twice."""
        boundaries = self.section("domain").get("boundaries", {})
        both = face_type(boundaries.get(axis))
        names = ("bottom", "top") if axis == "z" else (f"{axis}_low", f"{axis}_high")
        return tuple(face_type(boundaries.get(name)) or both for name in names)

    def velocities_of_faces(self):
        """Velocities (m/s, along x, y, z) of the walls that move and of the fluid at inlets."""
        faces = self.section("domain").get("boundaries", {}).values()
        return [np.array(face["velocity"], float) for face in faces if isinstance(face, dict) and "velocity" in face]

    @property
    def periodic(self):
        """Whether x, y and z are periodic."""
        return tuple("periodic" in self.faces(axis) for axis in "xyz")

    @property
    def side_walls(self):
        """How many of the faces across y hold the water back, 0 to 2, so that the hydraulic radius counts."""
        return sum(face in DRAGGING for face in self.faces("y"))

    @property
    def side_walls_move(self):
        """Whether a face across y is a wall that moves along x, and takes a share that no hydraulic radius tells."""
        boundaries = self.section("domain").get("boundaries", {})
        faces = [face for key in ("y", "y_low", "y_high") if isinstance(face := boundaries.get(key), dict)]
        return any(face.get("type") == "moving" and face["velocity"][0] != 0.0 for face in faces)

    @property
    def free_populations(self):
        """Populations of the case that are free to move, or all where none is; RunFolderError where there are no
        grains."""
        populations = self.section("grains")
        if isinstance(populations, dict):   # of a continuum
            return [populations]
        held = ("fixed", "prescribed_velocity", "motion")
        return [grains for grains in populations if not any(grains.get(key) for key in held)] or populations

    @property
    def has_clumps(self):
        """Whether there are clumps among the grains, of which frames have the members."""
        return any(grains.get("shape") for grains in self.section("grains"))

    def reference(self, name):
        """What the run says of its reference grain (`diameter`, `density`) in every row of series.csv; None where there
        is no row, or the run is older than these columns."""
        if not (self.folder / "series.csv").exists():
            return None
        column = self.series.get(f"reference_{name}", ())
        return float(column[-1]) if len(column) else None

    @property
    def disk_thickness(self):
        """m; None where the grains are spheres."""
        disks = self.case.get("disks")
        return float(disks["thickness"]) if disks else None

    @property
    def size_exponent(self):
        """The power of the diameter that the mass of a grain grows with: 3, of disks 2."""
        return 3 if self.disk_thickness is None else 2

    @cached_property
    def diameter(self):
        """m: the reference diameter, `analysis.reference_diameter` or the one that half of the mass of all free grains
        is finer than."""
        given = self.reference("diameter") or (self.case.get("analysis") or {}).get("reference_diameter")
        if given:
            return float(given)
        sizes = [(grains.get("diameter"), grains.get("count", 1)) for grains in self.free_populations]
        if all(isinstance(diameter, (int, float)) for diameter, _ in sizes):
            sizes = np.sort(np.concatenate([np.full(int(count), float(diameter)) for diameter, count in sizes]))
        elif self.grains:
            sizes = np.sort(self.grains[0].diameter)
        else:
            raise RunFolderError(f"{self.folder}: the case has no single diameter and there is no frame of the grains.")
        masses = sizes**self.size_exponent
        return float(sizes[np.searchsorted(np.cumsum(masses), 0.5 * np.sum(masses))])

    @property
    def density_ratio(self):
        """Density of the free grains over that of the fluid, 1."""
        return self.density / self.section("fluid")["density"]

    @property
    def has_one_density(self):
        """Whether all grains have the same density, as far as the case tells."""
        return len({grains["density"] for grains in self.case.get("grains", ()) if "density" in grains}) <= 1

    @property
    def density(self):
        """kg/m^3, of the free grains: mass over volume."""
        density = self.reference("density")
        if density is None:
            populations = [
                grains for grains in self.free_populations if isinstance(grains.get("diameter"), (int, float))
            ]
            volumes = [grains.get("count", 1) * grains["diameter"] ** self.size_exponent for grains in populations] or [
                1.0
            ]
            densities = [grains["density"] for grains in populations] or [self.free_populations[0]["density"]]
            density = float(np.average(densities, weights=volumes))
        return density

    @property
    def gravity(self):
        """m/s^2, along x, y, z."""
        gravity = self.section("gravity")
        if "vector" in gravity:
            return np.array(gravity["vector"], float)
        angle = np.arctan(gravity.get("slope", 0.0))
        return gravity["magnitude"] * np.array([np.sin(angle), 0.0, -np.cos(angle)])

    @property
    def slope(self):
        """Tangent of the bed's angle, 1; RunFolderError where gravity does not point down."""
        gravity = self.gravity
        if not gravity[2] < 0.0:
            raise RunFolderError(f"{self.folder}: gravity does not point down, so there is no slope.")
        return float(gravity[0] / -gravity[2])

    @cached_property
    def driven_alike_since(self):
        """Time (s) of the last restart that changed the density of the fluid, what drives it or what holds it, as
        run.log tells; -inf where none did."""
        drives = ("gravity.", "fluid.density", "fluid.mean_velocity", "domain.boundaries", "run.ramp")
        return last_change(sessions_of(self.folder), drives)

    @property
    def driven_by_slope(self):
        """Whether gravity along the bed, downhill along x or -x, and it alone, drives the fluid: no mean velocity is
        held, no top moves or drags, no side wall moves along x, no face is open and no wall ends the box along x."""
        steered = bool((self.case.get("fluid") or {}).get("mean_velocity"))
        open_faces = any(face in ("velocity_inlet", "pressure_outlet") for axis in "xyz" for face in self.faces(axis))
        top_is_free = self.faces("z")[1] in ("free_slip", "periodic", None)
        inclined = self.gravity[0] != 0.0 and self.gravity[2] < 0.0
        return bool(inclined and self.periodic[0] and not steered and not open_faces and top_is_free
                    and not self.side_walls_move)


class Profiles(dict):
    """The groups of profiles.h5 by name."""

    def __init__(self, groups, path):
        super().__init__(groups)
        self.path = path

    def __missing__(self, name):
        raise MissingName(
            name, self, str(self.path),
            f"analysis.{name} in the case would record it, from its time `from` on; it is written "
            "with every checkpoint.",
        )


def runs_of_sweep(folder):
    """The finished runs of a sweep, by the name of their folders."""
    found = [Run(path) for path in sorted(Path(folder).glob("runs/*")) if (path / "summary.json").exists()]
    found = [run for run in found if run.summary["finished"]]
    if not found:
        raise RunFolderError(f"{folder}: there is no finished run of a sweep in it.")
    return found


def read_bed(path):
    """The grains in a bed.h5: position, radius and what else is there, one row a grain."""
    with opened(path) as file:
        return columns_of(file["grains"])
