"""The commands of Thalweg that are written in Python: `thalweg analyze RUN` is `python -m thalweg analyze RUN`, and so
on."""
import argparse
import os
import sys
from pathlib import Path

INTERRUPTED = 130   # exit code, as shells have it for Ctrl-C

try:
    import thalweg.clump_picture
    import thalweg.plot
    import thalweg.page.command
    import thalweg.sweep.command
    from thalweg.errors import MissingName, RunFolderError
    from thalweg.report import report_of
    from thalweg.run import Run
except KeyboardInterrupt:
    sys.exit(INTERRUPTED)
except ModuleNotFoundError as missing:
    sys.exit(
        f"thalweg: {sys.executable} has no module {missing.name}; install it (python3-numpy, python3-h5py, python3-yaml"
        " on Debian), or set THALWEG_PYTHON to an interpreter that has it."
    )


def add_analyze_to(commands):
    parser = commands.add_parser(
        "analyze",
        description="Transport, surface, Shields number and profiles of a run between two times, from its "
        "stored output. The run may still be in progress.",
    )
    parser.add_argument("run", type=Path, metavar="RUN", help="Run folder")
    parser.add_argument("--from", dest="start", type=float, metavar="SECONDS",
                        help="Start of the averages (default: analysis.transport_rate.from, or half of the run)")
    parser.add_argument("--until", dest="stop", type=float, metavar="SECONDS", help="End of the averages (default: end of the run)")
    parser.add_argument("--out", type=Path, metavar="FOLDER",
                        help="Folder for summary.json and the tables (default: analysis in the run folder)")


def parser_of_commands():
    parser = argparse.ArgumentParser(prog="thalweg", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    add_analyze_to(commands)
    thalweg.clump_picture.add_to(commands)
    thalweg.plot.add_to(commands)
    thalweg.page.command.add_to(commands)
    thalweg.sweep.command.add_to(commands)
    return parser


def analyze(wanted):
    report = report_of(Run(wanted.run), wanted.start, wanted.stop)
    print("\n".join(report.lines), flush=True)
    files = report.write(wanted.out or wanted.run / "analysis")
    print(f"{'written':<11}{', '.join(str(file) for file in files)}")
    return 0


def main(arguments=None):
    wanted = parser_of_commands().parse_args(arguments)
    actions = {"analyze": analyze, "clump-picture": thalweg.clump_picture.clump_picture,
               "plot": thalweg.plot.plot, "report": thalweg.page.command.report,
               "sweep": thalweg.sweep.command.sweep}
    try:
        return actions[wanted.command](wanted)
    except (RunFolderError, MissingName) as error:
        print(f"thalweg: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:   # head, for example, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        print(f"thalweg: {error.filename or 'output'}: {error.strerror}.", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
