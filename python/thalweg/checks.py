"""What scripts share that check runs: numbers beside what is expected of them and beside the literature."""
import argparse
import sys
from pathlib import Path

from thalweg.errors import RunFolderError


class Verdict:
    """Called with whether something is as it should be, says "pass" or "FAIL"; `failed` counts the latter."""

    def __init__(self):
        self.failed = 0

    def __call__(self, good):
        self.failed += not good
        return "pass" if good else "FAIL"

    @property
    def exit_code(self):
        return 1 if self.failed else 0


class Checks(Verdict):
    """Prints each number; `failed` counts those that are not as expected."""

    def expect(self, name, value, low, high, unit="1"):
        """A number that a run of the tutorial must bring between two bounds."""
        print(f"{name}: {value:.4g} {unit}, expected {low:.4g} to {high:.4g}: {self(low <= value <= high)}")

    def compare(self, name, value, reference, source):
        """A number beside that of the literature; the difference is left to the reader's judgement."""
        print(f"{name}: {value:.4g}, {source}: {reference:.4g}, difference {100.0 * (value / reference - 1.0):+.1f} %")

    def finished(self, run):
        """Whether a run has come to its end."""
        good = bool(run.summary and run.summary["finished"])
        self.failed += not good
        print(f"{run.folder}: {'finished' if good else 'has not finished: FAIL'}")


def check_main(description, check, folders, figure=False):
    """The main function of a check script: calls check(checks, *folders, figure) with the folders from the command line
    or those that the tutorial's README uses, and returns the exit code, 0 if nothing failed. figure: whether it can
    draw one."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument(
        "folders", nargs="*", type=Path, metavar="FOLDER", help="of the runs; default: " + " ".join(folders)
    )
    if figure:
        parser.add_argument("--figure", type=Path, metavar="FILE", help="draw the result")
    arguments = parser.parse_args()
    given = arguments.folders or [Path(folder) for folder in folders]
    if len(given) != len(folders):
        parser.error(f"give {len(folders)} folders: those of " + ", ".join(folders))
    checks = Checks()
    try:
        check(checks, *given, *([arguments.figure] if figure else []))
    except RunFolderError as error:
        print(f"check: {error}", file=sys.stderr)
        return 1
    return checks.exit_code
