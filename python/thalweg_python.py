"""Scripts import this first: it goes on in another Python where the one that was started lacks what they need, and
prints the head of a script that has no options when it is asked for help. Figures that they draw need no screen.

The other Python is the interpreter named in the environment variable THALWEG_PYTHON, or Debian's own, whose packages
scripts/setup installs; on the path there is often a first Python without them. Where there is none with them, it says
what is missing.
"""
import importlib.util
import os
import sys

MODULES = {"numpy": "numpy", "h5py": "h5py", "yaml": "PyYAML", "matplotlib": "matplotlib"}
TRIED = "THALWEG_PYTHON_TRIED"   # interpreters that were found wanting


def missing_modules():
    return [package for module, package in MODULES.items() if importlib.util.find_spec(module) is None]


def go_on_elsewhere(missing):
    tried = [word for word in os.environ.pop(TRIED, "").split(os.pathsep) if word] + [sys.executable]
    for other in (os.environ.get("THALWEG_PYTHON", ""), "/usr/bin/python3"):
        if other not in tried and os.access(other, os.X_OK):
            os.environ[TRIED] = os.pathsep.join(tried + [other])
            os.execv(other, [other, *sys.orig_argv[1:]])
    sys.exit(
        f"{os.path.basename(sys.argv[0])}: {sys.executable} lacks {', '.join(missing)}; install it, or set"
        " THALWEG_PYTHON to an interpreter that has it."
    )


if "argparse" not in sys.modules and {"-h", "--help"} & set(sys.argv[1:]):
    print(sys.modules["__main__"].__doc__)
    sys.exit(0)
if missing_modules():
    go_on_elsewhere(missing_modules())
os.environ.pop(TRIED, None)
os.environ["MPLBACKEND"] = "Agg"   # figures go into files; no screen is needed
