"""What `thalweg sweep` does with its runs: errors, signals, cores and memory, results, units and warnings."""
import argparse
import contextlib
import io
import os
import unittest
import unittest.mock

from sweep_folder import BISECT, Folder
from thalweg.__main__ import main
from thalweg.history import sessions_of
from thalweg.sweep import command, machine, tables
from thalweg.sweep.inputs import SweepError
from thalweg.sweep.runner import Runner
from thalweg.sweep.runs import FAILED, launcher
from thalweg.sweep.tasks import PointTask, result_columns, tasks_of
from thalweg.sweep.warnings import grouped


class Failure(Folder):
    def test_how_the_program_ended_where_it_does_not_say(self):
        program = self.folder / "program"
        for line, words in (
            ("exit 7", "the program ended with exit code 7; see "), ("kill -9 $$", "the program was ended by signal 9; see "),
            ("echo thalweg: no room. >&2; exit 1", "no room."),
        ):
            program.write_text(f"#!/bin/sh\n{line}\n")
            program.chmod(0o755)
            run = tasks_of(self.plan(), self.folder)[0].run
            process = run.start(str(program))
            process.wait()
            run.ended(process.returncode)
            run.release()
            self.assertTrue(run.failure.startswith(words), run.failure)
            run.remember(None)


class AfterAnError(Folder):
    def test_runs_that_are_going_save_their_state_before_the_sweep_ends(self):
        program = self.folder / "program"
        program.write_text(f'#!/bin/sh\ntrap "sleep 0.5; echo saved > {self.folder}/saved; exit 3" USR1\n'
                           f'echo going > {self.folder}/going\nwhile true; do sleep 0.05; done\n')
        program.chmod(0o755)
        plan = self.plan()
        runner = Runner(plan, tasks_of(plan, self.folder), {}, str(program), self.folder, 1)

        def fail(last=False):
            if (self.folder / "going").exists():
                raise SweepError("the case has been changed")

        with unittest.mock.patch.object(runner, "report", fail), self.assertRaisesRegex(SweepError, "has been changed"):
            runner.work()
        self.assertEqual((self.folder / "saved").read_text(), "saved\n")


class Looks(Folder):
    def test_tasks_are_asked_what_they_want_when_a_run_has_ended(self):
        program = self.folder / "program"
        program.write_text("#!/bin/sh\nsleep 0.6\nexit 1\n")
        program.chmod(0o755)
        plan = self.plan(vary={"a": [1, 2]})
        runner = Runner(plan, tasks_of(plan, self.folder), {}, str(program), self.folder, 2)
        quiet = contextlib.redirect_stdout(io.StringIO())
        with unittest.mock.patch.object(PointTask, "spare", return_value=[]) as asked, quiet:
            self.assertTrue(runner.work())
        self.assertLessEqual(asked.call_count, 2 * 3)   # at the start and after each of the runs, of two tasks


class TwoSweepsOfAFolder(Folder):
    def test_a_run_is_not_taken_before_its_sweep_has_seen_how_it_ended(self):
        program = self.folder / "program"
        program.write_text("#!/bin/sh\nexit 1\n")
        program.chmod(0o755)
        plan = self.plan()
        here, there = (tasks_of(plan, self.folder)[0].run for _ in range(2))
        process = here.start(str(program))
        self.assertIsNone(there.start(str(program)))   # going
        process.wait()
        self.assertIsNone(there.start(str(program)))   # ended, and nobody has looked
        here.ended(process.returncode)
        here.release()
        self.assertIsNone(there.start(str(program)))
        self.assertEqual(there.state, FAILED)


class Interrupted(unittest.TestCase):
    def test_ctrl_c_before_or_after_the_runs_ends_it_without_a_word(self):
        with unittest.mock.patch("thalweg.sweep.command.sweep", side_effect=KeyboardInterrupt):
            self.assertEqual(main(["sweep", "sweep.yaml"]), 130)


class Launcher(unittest.TestCase):
    def test_what_starts_the_ranks(self):
        for given, words in (("", ["mpirun"]), ("srun --mpi=pmix", ["srun", "--mpi=pmix"]), ("'my run' -v", ["my run", "-v"])):
            with unittest.mock.patch.dict(os.environ, THALWEG_LAUNCH=given):
                self.assertEqual(launcher(), words)
        with unittest.mock.patch.dict(os.environ, THALWEG_LAUNCH="srun '"), self.assertRaisesRegex(SweepError, "quote"):
            launcher()


class Machine(unittest.TestCase):
    def runs_at_a_time(self, cores, memory, ranks, needed):
        said = io.StringIO()
        with unittest.mock.patch.dict(
            os.environ, THALWEG_CORES=str(cores), THALWEG_MEMORY=str(memory)
        ), contextlib.redirect_stdout(said):
            return machine.runs_at_a_time(ranks, needed), said.getvalue()

    def test_as_many_runs_as_cores_and_memory_allow(self):
        self.assertEqual(self.runs_at_a_time(8, 64e9, 1, 1e9), (8, ""))
        self.assertEqual(self.runs_at_a_time(8, 64e9, 3, 1e9), (2, ""))
        self.assertEqual(self.runs_at_a_time(2, 64e9, 4, 0.0), (1, ""))
        self.assertEqual(
            self.runs_at_a_time(8, 25e9, 1, 10e9),
            (
                2,
                "2 runs at a time, though there are cores for 8: a run takes up to "
                "10 GB of memory, and 25 GB are free (--jobs overrides this)\n",
            ),
        )
        self.assertEqual(self.runs_at_a_time(8, 5e9, 2, 10e9)[0], 1)

    def test_memory_by_what_check_prints(self):
        self.assertEqual(machine.memory_needed('{"figures": {"memory": 1.2e8}}'), 120e6)
        self.assertEqual(machine.memory_needed('{"figures": {}}'), 0.0)
        self.assertEqual(machine.memory_needed("thalweg: no memory about"), 0.0)

    def test_without_the_program_jobs_must_be_given(self):
        with unittest.mock.patch.dict(os.environ, clear=True), self.assertRaisesRegex(
            SweepError, "THALWEG_CORES.*--jobs"
        ):
            machine.runs_at_a_time(1, 0.0)


class Memory(Folder):
    """The program says of each run that it takes as many bytes as its first setting, `size`, and refuses those with a
    negative friction."""

    def setUp(self):
        super().setUp()
        program = self.folder / "program"
        program.write_text(
            f'#!/bin/sh\necho "$*" >> "{self.folder}/asked"\n[ "$1" = check ] || exit 1\n'
            'case "$*" in *friction=-*) echo thalweg: negative. >&2; exit 2;; esac\n'
            'echo "{\\"figures\\": {\\"memory\\": ${5#size=}}}"\n'
        )
        program.chmod(0o755)
        environment = unittest.mock.patch.dict(
            os.environ, THALWEG_PROGRAM=str(program), THALWEG_CORES="4", THALWEG_MEMORY="1e9"
        )
        environment.start()
        self.addCleanup(environment.stop)

    def checks(self):
        return [line for line in (self.folder / "asked").read_text().splitlines() if line.startswith("check ")]

    def test_the_largest_run_counts_wherever_it_stands(self):
        plan = self.plan(vary={"size": [10, 1000, 30], "a.seed": [1, 2]})
        tasks = tasks_of(plan, self.folder)
        self.assertEqual(command.most_memory(tasks, command.Checks(plan.case)), 1000.0)
        self.assertEqual(len(self.checks()), 3)   # seeds make no difference
        for task in tasks:
            if task.settings["size"] == 1000:
                task.run.failure = "it has been made"
        self.assertEqual(command.most_memory(tasks, command.Checks(plan.case)), 30.0)

    def test_a_run_that_is_refused_takes_no_other_ones_memory_away(self):
        for frictions in ([0.3, -1], [-1, 0.3]):
            plan = self.plan(vary={"size": [10, 1000], "contact.friction": frictions})
            self.assertEqual(command.most_memory(tasks_of(plan, self.folder), command.Checks(plan.case)), 1000.0)

    def test_no_run_is_checked_twice(self):
        sweep = self.folder / "sweep.yaml"
        for text, count in (
            ("vary: {size: [10, 1000, 30], a.seed: [1, 2]}", 3), ("vary: {size: [10]}", 1),
            ("vary: {size: [10, 1000]}\nbisect: {key: slope, from: 0, to: 1, width: 0.2, holds: q > 0.1}", 4),
        ):
            sweep.write_text(f"case: case.yaml\n{text}\n")
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
                self.assertEqual(main(["sweep", str(sweep)]), 1)   # as no run works
            self.assertEqual(len(self.checks()), count)
            self.assertEqual(len(set(self.checks())), count)
            (self.folder / "asked").unlink()


class Slurm(Folder):
    def test_a_task_has_room_for_the_ranks_of_its_runs(self):
        wanted = argparse.Namespace(sweep=self.folder / "my sweep.yaml", jobs=2, retry=False)
        os.environ["THALWEG_PROGRAM"] = "/opt/thalweg"
        self.addCleanup(os.environ.pop, "THALWEG_PROGRAM")
        job = command.slurm_job(wanted, 10, 4, self.folder / "out")
        self.assertIn("--ntasks=8\n", job)
        self.assertIn("--array=0-9\n", job)
        self.assertIn("/my sweep.yaml' --out", job)
        self.assertIn("--jobs 2 &\n", job)


class Results(Folder):
    """Columns and conditions, from summaries like those of runs."""
    CONTINUUM = {"finished": True, "steps": 7, "system": "continuum", "phases": {"column": {"share": 0.9}},
                 "figures": {"q_star": 0.081, "unsteadiness": 5e-5}, "largest": {"q_star": 0.09},
                 "units": {"q_star": "1"}, "provenance": {"nodes": 1}}
    RESOLVED = CONTINUUM | {"figures": {"largest_overlap": 0.01}, "bed": {"porosity": 0.4},
                            "transport_rate": {"q_star_mean": 0.1, "steady": None}}

    def columns(self, *summaries, **content):
        runs = [unittest.mock.Mock(summary=summary) for summary in summaries]
        return result_columns(self.plan(**content), runs)

    def test_values_are_those_of_a_case(self):
        values = [{"every": 0.5}, None, True, 1e-7, [1, "ü"], "no", 3]
        plan = self.plan(vary={"output.grains": values})
        tasks = tasks_of(plan, self.folder)
        found = [row[1] for row in tables.runs_table(plan, [task.run for task in tasks], {})[1:]]
        self.assertEqual(sorted(found), sorted(['{"every": 0.5}', "null", "true", "1e-07", '[1, "ü"]', "no", "3"]))
        self.assertEqual(command.describe(tasks[1], plan.keys), "output.grains = null")

    def test_a_column_of_two_continua_has_its_figures(self):
        self.assertEqual(self.columns(None, self.CONTINUUM), ["figures.q_star", "figures.unsteadiness"])
        condition = self.plan(bisect=BISECT | {"holds": "figures.q_star > 0.05"}).bisections[0].condition
        self.assertTrue(condition.holds(self.CONTINUUM))

    def test_where_observers_measure_their_results_are_the_columns(self):
        self.assertEqual(self.columns(self.RESOLVED, self.RESOLVED), ["bed.porosity", "transport_rate.q_star_mean"])
        self.assertEqual(self.columns(self.RESOLVED, columns=["steps"]), ["steps"])

    def test_a_result_without_its_section_is_told_where_it_is(self):
        plan = self.plan(bisect=BISECT | {"holds": "q_star > 0.05"})
        self.assertIn("no number q_star in summary.json, but figures.q_star.", plan.lacks(self.CONTINUUM))
        self.assertIn("only finished, steps,", plan.lacks(self.RESOLVED))
        self.assertIsNone(self.plan(bisect=BISECT).lacks(self.RESOLVED))


class Logs(Folder):
    def test_a_log_is_read_once_for_all_tables(self):
        """They are written whenever a run ends."""
        plan = self.plan(vary={"a": [1, 2]})
        tasks = tasks_of(plan, self.folder)
        for task in tasks:
            task.run.folder.mkdir(parents=True)
            (task.run.folder / "run.log").write_text("Thalweg 0.1.0 (aaa): a\nshape\nwarning: It is long.\n")
        with unittest.mock.patch("thalweg.sweep.runs.sessions_of", side_effect=sessions_of) as read:
            for _ in range(3):
                tables.write_tables(plan, tasks, {}, self.folder)
            self.assertEqual(read.call_count, 2)
            self.assertEqual(tasks[0].run.warnings, ["It is long."])
            with open(tasks[0].run.folder / "run.log", "a") as log:
                log.write("warning: It is wide.\n")
            self.assertEqual(tasks[0].run.warnings, ["It is long.", "It is wide."])


class Units(unittest.TestCase):
    def test_units_of_keys_from_the_schema(self):
        length = {"type": "number", "unit": "m"}
        case = {
            "properties": {
                "gravity": {
                    "anyOf": [
                        {"properties": {"magnitude": {"unit": "m/s^2"}, "vector": {"type": "array", "unit": "m/s^2"}}}
                    ]
                },
                "grains": {
                    "items": {
                        "properties": {
                            "count": {"type": "integer"},
                            "diameter": {"anyOf": [{"properties": {"value": length}}, {"type": "null"}, length]},
                            "contact": {"anyOf": [{"properties": {"damping": {"unit": "kg/(s m^1/2)"}}}]},
                        }
                    }
                },
            }
        }
        other = {"if": {"properties": {"system": {"const": "fluid"}}}, "then": {"properties": {"name": {"unit": "s"}}}}
        schema = {"allOf": [other, {"if": {"properties": {"system": {"const": "resolved"}}}, "then": case}]}
        units = tables.units_of_keys(schema, "resolved")
        self.assertEqual(units, {"gravity.magnitude": "m/s^2", "gravity.vector": "m/s^2", "grains.diameter.value": "m",
                                 "grains.diameter": "m", "grains.contact.damping": "kg/(s m^1/2)"})
        self.assertEqual(tables.headed("grains.0.diameter", units), "grains.0.diameter [m]")


class Warnings(unittest.TestCase):
    def test_those_of_several_runs_that_differ_in_numbers_alone_are_one(self):
        two = ["Grains of 2.65 kg/m^3 float.", "Grains of 1.4 kg/m^3 float."]   # of two populations
        self.assertEqual(
            grouped([("a", two), ("b", ["Grains of 1 kg/m^3 float."]), ("c", ["No water."])]),
            [(two[0], ["a", "b"]), (two[1], ["a"]), ("No water.", ["c"])],
        )


if __name__ == "__main__":
    unittest.main()
