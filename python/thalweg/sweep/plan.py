"""A sweep file: which runs there are, and what each sets. docs/sweep.md explains the keys."""
import functools
import itertools
import json
import math
import operator
import re
from dataclasses import dataclass, field
from pathlib import Path

import yaml

from thalweg.case_file import WordLoader
from thalweg.sweep.inputs import SweepError, content_of, state_of

KEYS = {"case", "set", "vary", "together", "bisect", "ranks", "columns"}
BISECT_KEYS = {"key", "from", "to", "width", "spacing", "holds", "repeat", "share"}
OPERATORS = {">": operator.gt, ">=": operator.ge, "<": operator.lt, "<=": operator.le}
NO_RESULTS = ("phases", "largest", "units", "provenance")   # sections of summary.json
MOST_VALUES = 100_000   # of a range: more would not end
ROUNDING = 1e-9   # relative: a time is a number of steps, and 1050 steps of 7e-4 s are not 0.735 s to the last bit


@dataclass(frozen=True)
class Condition:
    """Whether a run shows what is looked for: a figure of its summary.json, compared with a number or another
    figure."""
    figure: str
    sign: str
    limit: float | str

    @staticmethod
    def of(text):
        match = re.fullmatch(r"\s*([\w.]+)\s*(>=|<=|>|<)\s*(?:([-+.\d][-+.\deE]*)|([a-zA-Z][\w.]*))\s*", str(text))
        if not match:
            raise SweepError(f"bisect.holds: {text}: write a figure of summary.json and what it is compared with, e.g. "
                             "transport_rate.q_star_mean > 1e-3.")
        return Condition(match[1], match[2], number_in("bisect.holds", match[3]) if match[3] else match[4])

    def holds(self, summary):
        limit = found(summary, self.limit) if isinstance(self.limit, str) else self.limit
        value = found(summary, self.figure)
        if math.isclose(value, limit, rel_tol=ROUNDING):
            return "=" in self.sign
        return OPERATORS[self.sign](value, limit)


def found(summary, path):
    """A number of summary.json that bisect.holds names."""
    value = figure_of(summary, path)
    if value is None:
        section = summary.get(path.partition(".")[0])
        there = meant_by(summary, path) or f"only {', '.join(section if isinstance(section, dict) else summary)}"
        raise SweepError(f"bisect.holds: the runs have no number {path} in summary.json, {there}.")
    return value


@dataclass(frozen=True)
class Bisection:
    """Of each combination of the varied keys: the value of one more key from which on a condition holds."""
    key: str
    lower: float
    upper: float
    width: float        # of the bracket at the end; with geometric steps over its lower end
    geometric: bool
    condition: Condition
    repetitions: tuple   # of settings, one a repetition
    share: float         # of the repetitions: it holds where more than this show it

    def most_shown(self, count):
        """Of so many repetitions: how many may show the condition where it does not hold."""
        return math.floor(self.share * count * (1.0 + ROUNDING))

    def middle(self, lower, upper):
        return math.sqrt(lower * upper) if self.geometric else 0.5 * (lower + upper)

    def narrow(self, lower, upper):
        return upper - lower <= self.width * (lower if self.geometric else 1.0) * (1.0 + 1e-9)

    def most_levels(self):
        """Values looked at where the bracket is halved down to an end of the range, which is then looked at as well."""
        lower, upper, halvings = self.lower, self.upper, 0
        while not self.narrow(lower, upper):
            upper = self.middle(lower, upper)   # the wider half, where steps are arithmetic: equal
            halvings += 1
        return halvings + (1 if halvings else 2)


@dataclass
class Plan:
    """points: the settings (key: value) of each combination, without those of a bisection; bisections: that of each
    point, or none at all."""
    case: Path
    points: list
    bisections: list = field(default_factory=list)
    ranks: int = 1
    columns: list = field(default_factory=list)
    keys: list = field(default_factory=list)          # of vary and together, in the order of the file
    naming_keys: list = field(default_factory=list)   # those of them that tell the runs apart

    @functools.cached_property
    def in_grain_units(self):
        """Whether any of the runs is, of system: model_fluid; the results of others are in SI units."""
        given = [section(content_of(self.case, state_of(self.case)) or {}, "model_fluid").get("units")]
        return "grain" in given + [point.get("model_fluid.units") for point in self.points]

    def lacks(self, summary):
        """What a bisection looks for and the summary of a finished run does not have, in a sentence; None if it is
        there."""
        try:
            for search in self.bisections[:1]:   # the condition is that of all
                search.condition.holds(summary)
        except SweepError as error:
            return str(error)
        return None


def figure_of(summary, path):
    """A number of summary.json by its path, e.g. transport_rate.q_star_mean; None if it is not there."""
    value = summary
    for part in path.split("."):
        value = value.get(part) if isinstance(value, dict) else None
    return float(value) if isinstance(value, (int, float)) else None


def result_paths(summary):
    """Of all numbers in the sections of summary.json that hold results."""
    return [f"{section}.{name}" for section, figures in summary.items()
            if isinstance(figures, dict) and section not in NO_RESULTS
            for name in figures if figure_of(figures, name) is not None]


def meant_by(summary, path):
    """The results that have the same name in any section, in words, e.g. those of figures.q_star for q_star."""
    name = path.rpartition(".")[2]
    found_there = [other for other in result_paths(summary) if other.endswith(f".{name}")]
    return f"but {' and '.join(found_there)}" if found_there else ""


def read_plan(path):
    path = Path(path)
    try:
        content = yaml.load(path.read_text(encoding="utf-8"), WordLoader)
    except OSError as error:
        raise SweepError(f"{path}: {error.strerror}.") from None
    except UnicodeDecodeError:
        raise SweepError(f"{path} is not a text in UTF-8.") from None
    except yaml.YAMLError as error:
        raise SweepError(f"{path} is not YAML: {' '.join(str(error).split())}.") from None
    try:
        return plan_of(content, path.parent)
    except SweepError as error:
        raise SweepError(f"{path}: {error}") from None


def plan_of(content, folder):
    refuse_unknown(content, KEYS, "")
    if not isinstance(content.get("case"), str):
        raise SweepError("case is missing; give the case file that is run, relative to this file.")
    case = (folder / content["case"]).absolute()   # not what a link leads to: files that it names are beside the link
    if not case.is_file():
        raise SweepError(f"case: {case} cannot be read.")
    points = points_of(content)
    bisections = bisections_of(content, points)
    ranks = content.get("ranks", 1)
    if not isinstance(ranks, int) or ranks < 1:
        raise SweepError(f"ranks: {ranks} is not a number of MPI ranks; give a whole number from 1 on.")
    columns = content.get("columns") or []
    if not isinstance(columns, list) or not all(isinstance(column, str) for column in columns):
        raise SweepError("columns: give a list of paths in summary.json, e.g. [transport_rate.q_star_mean].")
    return Plan(case, points, bisections, ranks, columns, keys_in(content), naming_keys_in(content))


def points_of(content):
    fixed = section(content, "set")
    varied = [[{key: value} for value in values_of(key, given)] for key, given in section(content, "vary").items()]
    together = content.get("together") or []
    if not isinstance(together, list) or not all(isinstance(entry, dict) and entry for entry in together):
        raise SweepError("together: give a list of sections, each with the keys of one run.")
    for entry in together:
        refuse_other_than_values(entry, "together")
    if together:
        varied.append(together)
    points = []
    for combination in itertools.product(*varied):
        point = dict(fixed)
        for settings in combination:
            twice = set(point) & set(settings)
            if twice:
                raise SweepError(f"{min(twice)} is given twice; give it in one of set, vary and together.")
            point |= settings
        points.append(point)
    return points


def keys_in(content):
    """Also those with a single value, so that names and columns stay when values are added."""
    together = dict.fromkeys(
        key for entry in content.get("together") or [] for key in entry if not key.startswith("bisect.")
    )
    return list(section(content, "vary")) + list(together)


def naming_keys_in(content):
    """The first key of an entry of `together` stands for the entry, if it is the same key with another value in
    each."""
    entries = [{key: value for key, value in entry.items() if not key.startswith("bisect.")}
               for entry in content.get("together") or []]
    first = [item for entry in entries for item in list(entry.items())[:1]]
    if first and len({key for key, _ in first}) == 1 and len({json.dumps(value) for _, value in first}) == len(entries):
        return list(section(content, "vary")) + [first[0][0]]
    return keys_in(content)


def bisections_of(content, points):
    """That of each point, whose own bisect.from and bisect.to are taken out of it; none if nothing is searched."""
    ranges = [
        {end: point.pop(f"bisect.{end}") for end in ("from", "to") if f"bisect.{end}" in point} for point in points
    ]
    if not content.get("bisect"):
        if any(ranges):
            raise SweepError("bisect.from and bisect.to of a run need a section bisect that says what is searched.")
        return []
    bisections = [bisection_of(section(content, "bisect") | own) for own in ranges]
    taken = bisections[0].key
    repeated = set(bisections[0].repetitions[0])
    for key, name in [(taken, "key")] + [(key, "repeat") for key in sorted(repeated)]:
        if any(key in point for point in points):
            raise SweepError(f"bisect.{name}: {key} is also in set, vary or together; give it in one place.")
    if taken in repeated:
        raise SweepError(f"bisect.repeat: {taken} is the key that is searched; repeat runs with other values of another key.")
    return bisections


def bisection_of(given):
    refuse_unknown(given, BISECT_KEYS, "bisect.")
    for key in ("key", "from", "to", "width", "holds"):
        if key not in given:
            raise SweepError(f"bisect.{key} is missing; a bisection has key, from, to, width and holds.")
    lower, upper, width, share = (number(f"bisect.{key}", value) for key, value in (
        ("from", given["from"]), ("to", given["to"]), ("width", given["width"]), ("share", given.get("share", 0.5))))
    geometric = spacing_is_log("bisect.spacing", given.get("spacing", "linear"))
    if not lower < upper or (geometric and lower <= 0.0):
        raise SweepError(f"bisect: from {lower:g} to {upper:g} is not a range to search; give from below to"
                         + (", both above 0 for spacing: log." if geometric else "."))
    if width <= 0.0 or not 0.0 <= share < 1.0:
        raise SweepError("bisect: give a width above 0, and a share of the repetitions from 0 on and below 1.")
    finest = ROUNDING * (1.0 if geometric else max(abs(lower), abs(upper)))   # closer values would be the same run
    if width < finest:
        raise SweepError(f"bisect.width: {width:g} is finer than values are told apart; give at least {finest:g}.")
    repeat = [[{key: value} for value in values_of(key, values)] for key, values in section(given, "repeat").items()]
    repetitions = tuple({key: value for settings in combination for key, value in settings.items()}
                        for combination in itertools.product(*repeat))
    return Bisection(
        str(given["key"]), lower, upper, width, geometric, Condition.of(given["holds"]), repetitions, share
    )


def values_of(key, given):
    """A list of values, or {from, to, count or step, spacing: linear or log}; without count and step whole numbers."""
    if isinstance(given, list) and given:
        return given
    if not isinstance(given, dict) or not {"from", "to"} <= set(given):
        raise SweepError(f"{key}: give a list of values, or a range, e.g. {{from: 1, to: 10}} of whole numbers or "
                         "{from: 0.01, to: 1, count: 5, spacing: log}.")
    refuse_unknown(given, {"from", "to", "count", "step", "spacing"}, f"{key}.")
    start, stop = number(f"{key}.from", given["from"]), number(f"{key}.to", given["to"])
    log = spacing_is_log(f"{key}.spacing", given.get("spacing", "linear"))
    if "count" in given:
        if "step" in given:
            raise SweepError(f"{key}: a range has a count or a step; remove one of them.")
        values = counted(key, start, stop, given["count"], log)
    elif log:
        raise SweepError(f"{key}: a range with spacing: log takes a count.")
    else:
        values = stepped(key, start, stop, given)
    whole = all(isinstance(given.get(name, 1), int) for name in ("from", "to", "step")) and all(
        v.is_integer() for v in values
    )
    return [int(value) if whole else value for value in values]


def counted(key, start, stop, count, log):
    if not isinstance(count, int) or count < 2:
        raise SweepError(f"{key}.count: {count}: a range has a whole number of values, at least 2.")
    if log and min(start, stop) <= 0.0:
        raise SweepError(f"{key}: a range with spacing: log begins and ends above 0.")
    shares = [n / (count - 1) for n in range(limited(key, count))]
    return [rounded(start * (stop / start) ** share if log else start + share * (stop - start)) for share in shares]


def stepped(key, start, stop, given):
    if "step" not in given and not (start.is_integer() and stop.is_integer()):
        raise SweepError(f"{key}: a range that is not of whole numbers takes a count or a step.")
    step = number(f"{key}.step", given.get("step", 1))
    if step <= 0.0 or stop < start:
        raise SweepError(f"{key}: a range goes from a smaller to a larger value in steps above 0.")
    steps = min((stop - start) / step * (1.0 + 1e-12), 1e15)   # which may be infinite
    return [rounded(start + n * step) for n in range(limited(key, int(steps) + 1))]


def limited(key, count):
    if count > MOST_VALUES:
        raise SweepError(f"{key}: a range of {count} values; give at most {MOST_VALUES}.")
    return count


def rounded(value):
    return float(f"{value:.12g}")


def spacing_is_log(key, given):
    if given not in ("linear", "log"):
        raise SweepError(f"{key}: {given} is neither linear nor log.")
    return given == "log"


def number(key, value):
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise SweepError(f"{key}: {value} is not a number.")
    return float(value)


def number_in(key, text):
    try:
        return float(text)
    except ValueError:
        raise SweepError(f"{key}: {text} is not a number.") from None


def section(content, key):
    given = content.get(key) or {}
    if not isinstance(given, dict):
        raise SweepError(f"{key}: give keys of the case and their values, e.g. gravity.slope.")
    refuse_other_than_values(given, key)
    return given


def refuse_other_than_values(given, place):
    """What YAML takes for something else than text, numbers, lists and sections, e.g. a date, is not in any case."""
    for key, value in given.items():
        try:
            json.dumps(value)
        except TypeError:
            raise SweepError(f"{place}: {key}: {value} is neither a number nor text; put text in quotes.") from None
        if not isinstance(key, str):
            raise SweepError(f"{place}: {key} is not a key of the case; there are keys like gravity.slope.")


def refuse_unknown(given, known, prefix):
    if not isinstance(given, dict):
        raise SweepError(f"{prefix.rstrip('.') or 'the file'} is not a section of keys; there are "
                         f"{', '.join(sorted(known))}.")
    for key in given:
        if key not in known:
            raise SweepError(f"{prefix}{key} is not a key here; there are {', '.join(sorted(known))}.")
