"""What the check scripts of the tutorials share, and the drag law one of them compares with."""
import contextlib
import io
import json
import sys
import unittest
from unittest import mock

import made_up_folder as made_up
from thalweg import Run, RunFolderError
from thalweg.checks import Checks, check_main
from thalweg.literature import schiller_naumann_drag, settling_speed
from thalweg.run import runs_of_sweep


def printed(action, *arguments):
    """What an action prints, and what it returns."""
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(out):
        result = action(*arguments)
    return out.getvalue(), result


class TheChecks(made_up.MadeUpFolder):
    def test_bounds_belong_to_the_range(self):
        checks = Checks()
        for value, failed in ((1.0, 0), (2.0, 0), (0.99, 1), (2.01, 2), (float("nan"), 3)):
            text, _ = printed(checks.expect, "rate", value, 1.0, 2.0)
            self.assertEqual(checks.failed, failed, value)
            self.assertIn("expected 1 to 2", text)

    def test_the_literature_fails_nothing(self):
        checks = Checks()
        text, _ = printed(checks.compare, "speed", 0.5, 2.0, "somebody")
        self.assertEqual(text, "speed: 0.5, somebody: 2, difference -75.0 %\n")
        self.assertEqual(checks.failed, 0)

    def main_with(self, check, *words):
        with mock.patch.object(sys, "argv", ["check.py", *map(str, words)]):
            return printed(check_main, "A check.", check, [str(self.folder)])

    def test_the_exit_code(self):
        self.assertEqual(self.main_with(lambda checks, folder: checks.expect("x", 1.0, 0.0, 2.0))[1], 0)
        self.assertEqual(self.main_with(lambda checks, folder: checks.expect("x", 3.0, 0.0, 2.0))[1], 1)
        self.assertEqual(
            self.main_with(lambda checks, folder: checks.finished(Run(folder)))[1], 1
        )  # no summary.json yet
        text, code = self.main_with(lambda checks, folder: Run(folder), self.folder / "nowhere")
        self.assertEqual(code, 1)
        self.assertRegex(text, "^check: .*no case.yaml")

    def test_the_finished_runs_of_a_sweep(self):
        sweep = self.folder / "sweep"
        for name, summary in (("a", {"finished": True}), ("b", {"finished": False}), ("c", None)):
            (sweep / "runs" / name).mkdir(parents=True)
            (sweep / "runs" / name / "case.yaml").write_text(made_up.CASE)
            if summary:
                (sweep / "runs" / name / "summary.json").write_text(json.dumps(summary))
        self.assertEqual([run.folder.name for run in runs_of_sweep(sweep)], ["a"])
        with self.assertRaises(RunFolderError):
            runs_of_sweep(self.folder)


class DragOfASphere(unittest.TestCase):
    def test_schiller_and_naumann(self):
        self.assertAlmostEqual(schiller_naumann_drag(1e-6) * 1e-6, 24.0, delta=1e-3)   # Stokes
        self.assertAlmostEqual(schiller_naumann_drag(100.0), 0.24 * (1.0 + 0.15 * 100.0**0.687), delta=1e-12)   # 1.09
        self.assertEqual(schiller_naumann_drag(2e5), 0.44)

    def test_settling(self):
        # Glass of 5 mm in water: benchmarks/validation/settle_in_water. In thick oil the speed of Stokes, less 15 %
        # Re^0.687.
        self.assertAlmostEqual(settling_speed(5e-3, 2.55, 9.8, 1e-6), 0.480, delta=5e-4)
        stokes = 1.55 * 9.8 * 5e-3**2 / (18.0 * 1.0)
        self.assertAlmostEqual(settling_speed(5e-3, 2.55, 9.8, 1.0) / stokes, 1.0, delta=1e-3)


if __name__ == "__main__":
    unittest.main()
