"""What a sweep file means, and what is said of one that means nothing."""
import contextlib
import datetime
import io
import json
import math
import tempfile
import unittest
from pathlib import Path

import h5py
from sweep_folder import BISECT, Folder
from thalweg.sweep import command
from thalweg.sweep.inputs import SweepError, inputs_of, named_files
from thalweg.sweep.runner import Runner
from thalweg.sweep.runs import BEGUN, WAITING, name_of, short_keys
from thalweg.sweep.tasks import BisectionTask, tasks_of


class Points(Folder):
    def test_every_combination_with_the_last_key_fastest(self):
        plan = self.plan(set={"contact.friction": 0.3}, vary={"a.x": [1, 2], "b": {"from": 3, "to": 5}},
                         together=[{"c": "wide", "d": [1, 2]}, {"c": "narrow"}])
        self.assertEqual(len(plan.points), 12)
        self.assertEqual(plan.points[0], {"contact.friction": 0.3, "a.x": 1, "b": 3, "c": "wide", "d": [1, 2]})
        self.assertEqual(plan.points[-1], {"contact.friction": 0.3, "a.x": 2, "b": 5, "c": "narrow"})
        self.assertEqual(plan.keys, ["a.x", "b", "c", "d"])
        self.assertEqual(self.plan().points, [{}])

    def test_ranges(self):
        points = self.plan(vary={"a": {"from": 0.01, "to": 1, "count": 3, "spacing": "log"}}).points
        self.assertEqual([point["a"] for point in points], [0.01, 0.1, 1.0])
        points = self.plan(vary={"a": {"from": 0, "to": 0.3, "step": 0.1}}).points
        self.assertEqual([point["a"] for point in points], [0.0, 0.1, 0.2, 0.3])
        counts = [point["a"] for point in self.plan(vary={"a": {"from": 100, "to": 300, "count": 3}}).points]
        self.assertEqual(json.dumps(counts), "[100, 200, 300]")   # a key for whole numbers takes no 100.0

    def test_names_tell_the_runs_apart(self):
        self.assertEqual(short_keys(["grains.0.count", "grains.1.count", "gravity.slope"]),
                         {"grains.0.count": "0.count", "grains.1.count": "1.count", "gravity.slope": "slope"})
        self.assertEqual(name_of({"gravity.slope": 1e-3, "name": "a/b"}, ["gravity.slope", "name"]),
                         "slope_0.001-name_a_b")

    def test_a_name_too_long_for_a_folder_is_cut_off(self):
        keys = ["grains.0.placement.positions", "ü"]
        long = [{keys[0]: [[0.1 * n, 0.2, 0.3] for n in range(60)], keys[1]: end} for end in (1, 2)]
        names = [name_of(settings, keys) for settings in long]
        self.assertNotEqual(*names)
        self.assertEqual(names[0][:100], names[1][:100])
        self.assertEqual(name_of({"ü": "ü" * 200}, ["ü"])[:10], "ü_üüüüüüüü")
        for name in names + [name_of({"ü": "ü" * 200}, ["ü"]), name_of({"ab": "ü" * 200}, ["ab"])]:
            (self.folder / f"{name}.{'h' * 64}.1234567.partial").write_text("")   # 255 bytes at most

    def test_what_changes_together_is_named_by_its_first_key(self):
        plan = self.plan(vary={"a": [1, 2]}, together=[{"b": 1, "c": [1, 2]}, {"b": 2, "c": [3, 4]}])
        self.assertEqual((plan.keys, plan.naming_keys), (["a", "b", "c"], ["a", "b"]))
        self.assertEqual(self.plan(together=[{"b": 1, "c": 1}, {"b": 1, "c": 2}]).naming_keys, ["b", "c"])
        self.assertEqual(
            self.plan(bisect=BISECT, together=[{"bisect.from": 0.1, "b": 1}, {"bisect.from": 0.2, "b": 2}]).naming_keys,
            ["b"],
        )

    def test_a_run_keeps_its_name_when_an_entry_is_added_that_needs_other_names(self):
        entries = [{"b": 1, "c": 1}, {"b": 2, "c": 1}]
        for task in tasks_of(self.plan(together=entries), self.folder):
            task.run.folder.mkdir(parents=True)
            task.run.remember(None)
        names = [task.run.name for task in tasks_of(self.plan(together=entries + [{"b": 2, "c": 2}]), self.folder)]
        self.assertEqual(names, ["b_1", "b_2", "b_2-c_2"])

    def test_runs_that_would_share_a_folder_are_refused(self):
        repeated = {"bisect": BISECT | {"repeat": {"seed": [1, 2]}}}
        for content in ({"vary": {"a": [1, 2]}}, {"vary": {"a": [1, 2]}} | repeated):
            command.refuse_same_names(self.plan(**content), "sweep.yaml")
        for content, name in (
            ({"vary": {"a": [1, 1]}}, "a_1"), ({"vary": {"a": ["x y", "x_y"]}}, "a_x_y"), ({"together": [{}, {}]}, None),
            ({"vary": {"a": [3]}, "bisect": BISECT | {"repeat": {"seed": [1, 2, 1]}}}, "a_3-seed_1"),
        ):
            with self.subTest(content=content), self.assertRaisesRegex(SweepError, name or "give a list of sections"):
                command.refuse_same_names(self.plan(**content), "sweep.yaml")

    def test_names_stay_when_values_are_added(self):
        one, two = self.plan(vary={"a": [1]}, together=[{"b": 1}]), self.plan(
            vary={"a": [1, 2]}, together=[{"b": 1}, {"b": 2}]
        )
        self.assertEqual(name_of(one.points[0], one.naming_keys), name_of(two.points[0], two.naming_keys))
        self.assertEqual(name_of(one.points[0], one.naming_keys), "a_1-b_1")
        self.assertEqual(one.keys, two.keys)   # the columns of thresholds.csv

    def test_a_file_that_the_case_names_is_one_of_its_inputs(self):
        case, bed, begun = self.folder / "case.yaml", self.folder / "bed.h5", self.folder / "begun" / "checkpoints"
        case.write_text("system: grains\ngrains: [{placement: {file: bed.h5}}]\ninitial: {from: begun}\n")
        begun.mkdir(parents=True)
        seen = []
        for change in (
            lambda: bed.write_text("some"), lambda: bed.write_text("more"),
            lambda: (begun / "step_1.h5").write_text("1"),
        ):
            change()
            seen.append(inputs_of(case, {}))
        self.assertEqual(len({json.dumps(inputs) for inputs in seen}), 3)
        self.assertEqual(inputs_of(case, {}), seen[-1])
        (begun / "step_1.h5").write_text("2")   # as long as before
        self.assertNotEqual(inputs_of(case, {}), seen[-1])
        for source in ("grains", "fluid"):
            self.assertEqual(named_files({"initial": {"from": {source: "../bed"}}}), {"../bed"})
            self.assertEqual(named_files({f"initial.from.{source}": "../bed"}), {"../bed"})
        self.assertEqual(named_files({"grains": "../bed", "fluid": {"density": "x"}}), set())
        other = self.folder / "other.stl"
        other.write_text("solid")
        self.assertEqual(
            set(inputs_of(case, {"obstacles.0.stl": "other.stl"})["files"]), {"bed.h5", "begun", "other.stl"}
        )

    def test_files_are_beside_the_case_where_that_is_a_link(self):
        (self.folder / "kept").mkdir()
        case = (self.folder / "case.yaml").rename(self.folder / "kept/case.yaml")
        (self.folder / "case.yaml").symlink_to(case)
        (self.folder / "bed.h5").write_text("bed")
        plan = self.plan(vary={"grains.0.placement.file": ["bed.h5"]})
        self.assertEqual(plan.case, self.folder / "case.yaml")
        self.assertEqual(set(inputs_of(plan.case, plan.points[0])["files"]), {"bed.h5"})

    def test_of_a_run_to_begin_from_only_the_latest_checkpoint_counts(self):
        case, begun = self.folder / "case.yaml", self.folder / "begun/checkpoints"
        case.write_text("system: grains\ninitial: {from: begun}\n")
        begun.mkdir(parents=True)
        for step in (9, 10, 11):
            (begun / f"step_{step}.h5").write_text(f"{step}")
        (begun / "latest").write_text("step_10.h5\n")
        at_10 = inputs_of(case, {})
        (begun / "step_9.h5").unlink()
        (begun / "step_11.h5").write_text("other")
        self.assertEqual(inputs_of(case, {}), at_10)
        (begun / "latest").unlink()
        self.assertNotEqual(inputs_of(case, {}), at_10)
        # What a checkpoint says of its data is enough: the data are not read.
        seen = []
        for checksum, time in ((1, 0.5), (2, 0.5), (2, 0.6)):
            with h5py.File(begun / "step_11.h5", "w") as file:
                file.create_group("run").attrs["time"] = time
                file["grains/radius"] = [0.1, 0.2]
                file["grains/radius"].attrs["checksum"] = checksum
            seen.append(json.dumps(inputs_of(case, {})))
        self.assertEqual(len(set(seen)), 3)
        with h5py.File(begun / "step_11.h5", "r+") as file:
            file["grains/radius"][0] = 0.3
        self.assertEqual(json.dumps(inputs_of(case, {})), seen[-1])

    def test_what_cannot_be_meant_is_refused_with_its_key(self):
        for content, words in (
            ({"very": 1}, "very is not a key here"), ({"case": "gone.yaml"}, "gone.yaml cannot be read"),
            ({"vary": {"a": []}}, "a: give a list of values"),
            ({"vary": {"a": {"from": 2, "to": 1}}}, "from a smaller to a larger"),
            ({"vary": {"a": {"from": 0, "to": 1, "count": 3, "spacing": "log"}}}, "above 0"),
            ({"vary": {"a": {"from": 1, "to": "x"}}}, "a.to: x is not a number"),
            ({"vary": {"a": [1]}, "set": {"a": 2}}, "a is given twice"), ({"ranks": 0}, "ranks: 0"),
            ({"bisect": {"key": "a"}}, "bisect.from is missing"),
            ({"bisect": BISECT | {"from": 2}}, "not a range to search"),
            ({"bisect": BISECT | {"width": 1e-18}}, "give at least 1e-09"),
            ({"bisect": BISECT | {"width": 0}}, "width above 0"), ({"bisect": BISECT | {"spacing": "log"}}, "above 0"),
            ({"bisect": BISECT | {"holds": "q_star"}}, "compared with"),
            ({"bisect": BISECT, "vary": {"gravity.slope": [1, 2]}}, "bisect.key: gravity.slope is also"),
            ({"bisect": BISECT | {"repeat": {"a": [1]}}, "vary": {"a": [1, 2]}}, "bisect.repeat: a is also"),
            ({"bisect": BISECT | {"repeat": {"gravity.slope": [1]}}}, "is the key that is searched"),
            ({"bisect": BISECT | {"holds": "q > 1e"}}, "1e is not a number"),
            ({"bisect": "slope"}, "bisect: give keys"), ({"together": 5}, "together: give a list"),
            ({"columns": "simulated_time"}, "columns: give a list"), ({"case": 5}, "case is missing"),
            ({"vary": {"a": {"from": 0.1, "to": 0.5}}}, "takes a count or a step"),
            ({"vary": {"a": {"from": 1, "to": 6, "spacing": "log"}}}, "takes a count"),
            ({"vary": {"a": {"from": 1, "to": 6, "step": 1, "count": 2}}}, "a count or a step; remove one"),
            ({"vary": {"a": {"from": 0, "to": 1e9, "step": 1e-300}}}, "give at most 100000"),
            ({"vary": {"a": {"from": 1, "to": math.inf}}}, "inf is not a number"),
            ({"vary": {1: [2]}}, "1 is not a key of the case"),
            ({"set": {"a": datetime.date(2026, 1, 1)}}, "neither a number nor text"),
        ):
            with self.subTest(content=content), self.assertRaisesRegex(SweepError, words.replace("(", r"\(")):
                self.plan(**content)


class Bisection(Folder):
    """The runs are answered here: a run at a slope moves where the slope is above the threshold of its seed."""

    def search(self, threshold, **more):
        task = BisectionTask(self.folder, self.plan(bisect=BISECT | more), 0)
        asked = []
        while wanted := task.wanted():
            run = wanted[0]
            slope = run.settings["gravity.slope"]
            asked.append(slope)
            self.answer(run, 1.0 if slope > threshold(run.settings) else 0.0)
        return task, asked

    def answer(self, run, rate):
        run.folder.mkdir()
        run.remember(None)
        (run.folder / "summary.json").write_text(
            json.dumps({"finished": True, "wall_seconds": 1.0, "transport_rate": {"q_star_mean": rate}}))
        run.look()

    def test_halves_the_range_until_it_is_narrow(self):
        task, asked = self.search(lambda settings: 0.3)
        self.assertEqual(asked, [0.5, 0.25, 0.375])
        self.assertEqual(task.result(), ("found", 0.25, 0.375, 0.3125))

    def test_looks_at_an_end_before_it_believes_it(self):
        for threshold, state, looked in ((-1.0, "holds everywhere", [0.5, 0.25, 0.125, 0.0]),
                                         (0.1, "found", [0.5, 0.25, 0.125, 0.0]),
                                         (2.0, "holds nowhere", [0.5, 0.75, 0.875, 1.0])):
            with tempfile.TemporaryDirectory() as folder:
                self.folder, outer = Path(folder), self.folder
                (self.folder / "case.yaml").write_text("system: grains\n")
                task, asked = self.search(lambda settings: threshold)
                self.folder = outer
            self.assertEqual((task.result()[0], asked), (state, looked))

    def test_a_combination_with_a_range_of_its_own(self):
        plan = self.plan(bisect=BISECT, together=[{"a": 1, "bisect.from": 0.4, "bisect.to": 0.6}, {"a": 2}])
        self.assertEqual(plan.points, [{"a": 1}, {"a": 2}])
        self.assertEqual([(search.lower, search.upper) for search in plan.bisections], [(0.4, 0.6), (0.0, 1.0)])
        with self.assertRaisesRegex(SweepError, "need a section bisect"):
            self.plan(together=[{"a": 1, "bisect.from": 0.4}])

    def test_a_figure_compared_with_another(self):
        condition = self.plan(bisect=BISECT | {"holds": "simulated_time >= until"}).bisections[0].condition
        self.assertTrue(condition.holds({"simulated_time": 2.1, "until": 2.0}))
        self.assertFalse(condition.holds({"simulated_time": 1.9, "until": 2.0}))
        # 1050 steps of 7e-4 s are one unit in the last place short of 0.735 s.
        self.assertTrue(condition.holds({"simulated_time": 0.7349999999999999, "until": 0.735}))
        below = self.plan(bisect=BISECT | {"holds": "simulated_time < until"}).bisections[0].condition
        self.assertFalse(below.holds({"simulated_time": 0.7349999999999999, "until": 0.735}))
        with self.assertRaisesRegex(SweepError, "no number until"):
            condition.holds({"simulated_time": 1.9})

    def test_what_a_crash_of_the_machine_may_have_left(self):
        task = BisectionTask(self.folder, self.plan(bisect=BISECT), 0)
        run = task.wanted()[0]
        self.answer(run, 1.0)
        (run.folder / "summary.json").write_text("")
        run.look()
        self.assertEqual(run.state, BEGUN)
        run.note.write_text("")
        with self.assertRaisesRegex(SweepError, "is damaged"):
            run.look()
        run.note.unlink()
        with self.assertRaisesRegex(SweepError, "is missing"):
            run.look()

    def test_a_run_that_was_stopped_before_it_began_may_have_other_settings(self):
        run = BisectionTask(self.folder, self.plan(bisect=BISECT, set={"a": 1}), 0).wanted()[0]
        run.remember(None)   # of its start; the program has made no folder yet
        other = BisectionTask(self.folder, self.plan(bisect=BISECT, set={"a": 2}), 0).wanted()[0]
        self.assertEqual((other.note, other.state), (run.note, WAITING))

    def test_geometric_steps(self):
        task, _ = self.search(lambda settings: 0.03, **{"from": 0.01, "spacing": "log", "width": 0.5})
        state, lower, upper, threshold = task.result()
        self.assertEqual(state, "found")
        self.assertTrue(lower < 0.03 <= upper <= 1.5 * lower)
        self.assertAlmostEqual(threshold, math.sqrt(lower * upper), 15)

    def test_the_majority_of_the_repetitions_decides_and_no_more_are_run_than_it_needs(self):
        # Seeds 1 to 5 begin to move at 0.1, 0.2, 0.3, 0.4 and 0.9: more than half of them above 0.3.
        thresholds = [0.1, 0.2, 0.3, 0.4, 0.9]
        task, asked = self.search(lambda settings: thresholds[settings["seed"] - 1], width=0.05,
                                  repeat={"seed": {"from": 1, "to": 5}})
        state, lower, upper, _ = task.result()
        self.assertEqual(state, "found")
        self.assertTrue(lower <= 0.3 < upper, (lower, upper))
        self.assertEqual(asked.count(0.5), 3)   # three that move decide
        self.assertLess(len(asked), task.search.most_levels() * 5)

    def test_a_share_that_is_exactly_met_is_not_exceeded(self):
        # 0.58 of 50 is 28.999999999999996 in floating-point numbers.
        task = BisectionTask(
            self.folder, self.plan(bisect=BISECT | {"share": 0.58, "repeat": {"seed": {"from": 1, "to": 50}}}), 0
        )
        self.assertEqual(task.least_to_settle(0.5), 21)   # that do not show it
        for number, run in enumerate(task.runs_at(0.5)):
            self.answer(run, 1.0 if number < 29 else 0.0)
        self.assertIs(task.verdict(0.5), False)

    def test_asks_first_for_as_many_repetitions_as_may_settle_a_value(self):
        task = BisectionTask(self.folder, self.plan(bisect=BISECT | {"repeat": {"seed": {"from": 1, "to": 5}}}), 0)
        self.assertEqual(
            ([run.settings["seed"] for run in task.wanted()], [run.settings["seed"] for run in task.spare()]),
            ([1, 2, 3], [4, 5]),
        )
        self.answer(task.wanted()[0], 1.0)
        self.assertEqual(
            ([run.settings["seed"] for run in task.wanted()], [run.settings["seed"] for run in task.spare()]),
            ([2, 3], [4, 5]),
        )
        self.answer(task.wanted()[0], 0.0)
        self.assertEqual(
            ([run.settings["seed"] for run in task.wanted()], [run.settings["seed"] for run in task.spare()]),
            ([3, 4], [5]),
        )

    def test_the_count_of_what_is_left_is_never_too_small(self):
        task = BisectionTask(self.folder, self.plan(bisect=BISECT), 0)
        self.assertEqual(task.search.most_levels(), 4)
        self.assertEqual(task.most_runs_left(), 4)

    def test_a_file_gets_a_line_of_progress_where_the_counts_have_changed(self):
        runner = Runner(self.plan(), [], {}, "thalweg", self.folder, 1)
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            runner.say("1 of 3 runs done", ", left about 9 s", passing=True)
            runner.say("1 of 3 runs done", ", left about 4 s", passing=True)
            runner.say("2 of 3 runs done", ", left about 5 s", passing=True)
        self.assertEqual(printed.getvalue(), "1 of 3 runs done, left about 9 s\n2 of 3 runs done, left about 5 s\n")


if __name__ == "__main__":
    unittest.main()
