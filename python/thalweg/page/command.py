"""The command `thalweg report`."""
from pathlib import Path

from thalweg.plot import module
from thalweg.run import Run


def add_to(commands):
    parser = commands.add_parser(
        "report",
        description=(
            "One page about a run, finished or not: the case, where it comes from, pictures, transport, profiles, "
            "warnings, where the time went, and how to repeat it. A single HTML file that needs no network."
        ),
    )
    parser.add_argument("run", type=Path, metavar="RUN", help="Run folder")
    parser.add_argument("--out", type=Path, metavar="FILE", help="The page (default: report.html in the run folder)")


def report(wanted):
    path = wanted.out or wanted.run / "report.html"
    text = module("thalweg.page.sections").page_of(Run(wanted.run))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    print(path)
    return 0
