"""What a sweep is made of: tasks, each of which says which runs it wants next. A task is one point, or the bisection of
one point, and independent of the others."""
import math

from thalweg.sweep.plan import result_paths
from thalweg.sweep.runs import DONE, SweepRun, name_of, names_in


class PointTask:
    """One run."""

    def __init__(self, folder, plan, number, kept=None):
        self.settings = plan.points[number]
        self.run = SweepRun(folder, name_of(self.settings, plan.naming_keys), plan, self.settings, kept)
        self.runs = [self.run]

    def ends(self):
        """Settings from one end of what its runs may set to the other."""
        return [self.settings]

    def wanted(self):
        return [self.run] if self.run.is_open else []

    def spare(self):
        return []

    def most_runs_left(self):
        return len(self.wanted())


class BisectionTask:
    """Looks at the middle of what is left of the range until that is narrow, and at an end of the range only if it is
    left at last. A value is settled as soon as enough repetitions agree."""

    def __init__(self, folder, plan, number, kept=None):
        self.folder, self.plan, self.search, self.kept = folder, plan, plan.bisections[number], kept
        self.settings = plan.points[number]
        self.keys = plan.naming_keys + [self.search.key] + list(self.search.repetitions[0])
        self.known = {}   # runs by value

    @property
    def runs(self):
        return [run for runs in self.known.values() for run in runs]

    def ends(self):
        return [self.settings | {self.search.key: value} | self.search.repetitions[0]
                for value in (self.search.lower, self.search.upper)]

    def runs_at(self, value):
        if value not in self.known:
            self.known[value] = []
            for repetition in self.search.repetitions:
                settings = self.settings | {self.search.key: float(f"{value:.12g}")} | repetition
                self.known[value].append(
                    SweepRun(self.folder, name_of(settings, self.keys), self.plan, settings, self.kept)
                )
        return self.known[value]

    def verdict(self, value):
        """Whether the condition holds at a value; None while that is open."""
        runs = self.runs_at(value)
        shown = [self.search.condition.holds(run.summary) for run in runs if run.state == DONE]
        most_shown = self.search.most_shown(len(runs))
        if sum(shown) > most_shown:
            return True
        return False if sum(shown) + len(runs) - len(shown) <= most_shown else None

    def bracket(self):
        """The range in which the threshold is, as far as it is known, and the values that are to be settled next."""
        lower, upper = self.search.lower, self.search.upper
        while not self.search.narrow(lower, upper):
            middle = self.search.middle(lower, upper)
            verdict = self.verdict(middle)
            if verdict is None:
                return lower, upper, [middle]
            lower, upper = (lower, middle) if verdict else (middle, upper)
        return lower, upper, [value for value in (lower, upper) if self.is_end(value) and self.verdict(value) is None]

    def is_end(self, value):
        return value in (self.search.lower, self.search.upper)

    def open_at(self, value):
        return [run for run in self.runs_at(value) if run.is_open]

    def wanted(self):
        """As many repetitions as settle the next value if they agree."""
        return [run for value in self.bracket()[2] for run in self.open_at(value)[:self.least_to_settle(value)]]

    def spare(self):
        """The others, for cores that have nothing better to do."""
        return [run for value in self.bracket()[2] for run in self.open_at(value)[self.least_to_settle(value):]]

    def least_to_settle(self, value):
        runs = self.runs_at(value)
        shown = [self.search.condition.holds(run.summary) for run in runs if run.state == DONE]
        most_shown = self.search.most_shown(len(runs))
        failing = len(shown) - sum(shown)
        return max(1, min(most_shown + 1 - sum(shown), len(runs) - most_shown - failing))

    def most_runs_left(self):
        unsettled = self.bracket()[2]
        left, levels = len(self.wanted() + self.spare()), self.search.most_levels()
        settled = sum(self.verdict(value) is not None for value in self.known)
        if not unsettled or not left:
            return left
        return left + max(0, levels - settled - len(unsettled)) * len(self.search.repetitions)

    def result(self):
        """(state, lower, upper, threshold): the ends of the bracket and its middle, not numbers where there is none."""
        lower, upper, unsettled = self.bracket()
        if unsettled:
            stuck = not self.wanted()
            return "failed" if stuck else "unfinished", lower, upper, math.nan
        if self.is_end(lower) and self.verdict(lower):
            return "holds everywhere", math.nan, lower, math.nan
        if self.is_end(upper) and not self.verdict(upper):
            return "holds nowhere", upper, math.nan, math.nan
        return "found", lower, upper, self.search.middle(lower, upper)


def tasks_of(plan, folder):
    kind = BisectionTask if plan.bisections else PointTask
    kept = names_in(folder / "runs")
    return [kind(folder / "runs", plan, number, kept) for number in range(len(plan.points))]


def known_runs(tasks):
    """All runs of the tasks so far."""
    for task in tasks:
        task.wanted()   # a bisection comes to know its runs as it goes on
    return [run for task in tasks for run in task.runs]


def result_columns(plan, runs):
    """Paths in summary.json: those the plan names, else all that the observers of any run have measured, else the
    figures of the last state, which are all that a column of two continua has."""
    if plan.columns:
        return plan.columns
    columns = list(dict.fromkeys(path for run in runs for path in result_paths(run.summary or {})))
    return [column for column in columns if not column.startswith("figures.")] or columns
