"""Scripts find a Python with what they need, though the first on the path may lack it, and Python commands name what is
missing."""
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import made_up_run  # noqa: E402
SCRIPT = ROOT / "scripts/compare_checkpoints.py"


class Interpreter(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", self.folder / "venv"], check=True)
        self.bare = self.folder / "venv/bin/python3"   # without numpy
        self.assertNotEqual(subprocess.run([self.bare, "-c", "import numpy"], capture_output=True).returncode, 0)

    def run_with(self, interpreter, **variables):
        environment = (
            os.environ
            | {"PATH": f"{interpreter.parent}:{os.environ['PATH']}", "PYTHONDONTWRITEBYTECODE": "1"}
            | variables
        )
        return subprocess.run(
            [SCRIPT, "--help"], env=environment, capture_output=True, encoding="utf-8", cwd=self.folder
        )

    def test_a_script_goes_on_in_the_python_that_has_what_it_needs(self):
        said = self.run_with(self.bare, THALWEG_PYTHON=sys.executable)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn("usage: compare_checkpoints.py", said.stdout)

    def test_a_python_without_it_is_tried_once_and_the_lack_is_named(self):
        # The bare interpreter is all there is: in place of Debian's as well.
        copy = (
            (ROOT / "python/thalweg_python.py")
            .read_text(encoding="utf-8")
            .replace("/usr/bin/python3", str(self.folder / "none"))
        )
        (self.folder / "thalweg_python.py").write_text(copy, encoding="utf-8")
        script = self.folder / "script.py"
        script.write_text("import thalweg_python\n", encoding="utf-8")
        other = self.folder / "venv/bin/other"
        other.symlink_to(self.bare)
        said = subprocess.run(
            [self.bare, script], env=os.environ | {"THALWEG_PYTHON": str(other)}, capture_output=True, encoding="utf-8",
            timeout=60,
        )
        self.assertEqual(said.returncode, 1)
        self.assertRegex(said.stderr, r"^script.py: \S+ lacks numpy, h5py, .*; install it, or set THALWEG_PYTHON")
        self.assertEqual(said.stderr.count("\n"), 1)

    def test_help_is_all_that_happens(self):
        empty = self.folder / "empty"
        empty.mkdir()
        for script in sorted(path for folder in ("scripts", "cases") for path in (ROOT / folder).rglob("*.py")):
            text = script.read_text(encoding="utf-8")
            if not text.startswith("#!/usr/bin/env python3"):
                continue
            with self.subTest(script=script):
                said = subprocess.run(
                    [sys.executable, "-B", script, "--help"], capture_output=True, encoding="utf-8", cwd=empty
                )
                self.assertEqual(said.returncode, 0, said.stderr)
                self.assertIn(text.split('"""')[1].split()[0], said.stdout)
        self.assertEqual(list(empty.iterdir()), [])

    def test_no_script_names_an_interpreter_of_one_system(self):
        for script in sorted(path for path in ROOT.rglob("*.py") if "build" not in path.relative_to(ROOT).parts):
            with open(script, encoding="utf-8") as file:
                first = file.readline()
            if first.startswith("#!"):
                self.assertIn(first.rstrip(), ("#!/usr/bin/env python3", "#!/usr/bin/env pvpython"), script)


class Package(unittest.TestCase):
    def test_the_package_names_the_oldest_python_that_the_documentation_names(self):
        with open(ROOT / "python/pyproject.toml", "rb") as file:
            project = tomllib.load(file)["project"]
        self.assertEqual(project["requires-python"], ">=3.11")
        self.assertRegex((ROOT / "docs/installing.md").read_text(encoding="utf-8"), r"\| Python with [^|]*\| 3\.11 \|")

    @unittest.skipUnless(
    all(importlib.util.find_spec(name) for name in ("pip", "setuptools", "wheel")), "needs pip and setuptools"
)
    def test_the_package_installs_without_a_network(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            shutil.copytree(ROOT / "python", folder / "python")   # pip builds in the source folder
            subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", folder / "venv"], check=True)
            # Debian has h5py under another name (h5py._debian_h5py_serial), which pip does not take for it: no
            # dependencies.
            subprocess.run(
                [
                    folder / "venv/bin/python", "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-index",
                    "--no-deps", folder / "python",
                ], check=True, capture_output=True,
            )
            made_up_run.write_run(folder / "run")
            for words, code, output in (
                (("analyze", folder), 2, "there is no case.yaml in it"),
                (("plot", "q", folder / "run"), 0, "transport_rate.png"),
                (("report", folder / "run"), 0, "report.html"),
            ):
                said = subprocess.run(
                    [folder / "venv/bin/thalweg-tools", *words], capture_output=True, encoding="utf-8",
                    env=os.environ | {"PYTHONPATH": ""}, cwd=folder,
                )
                self.assertEqual(said.returncode, code, said.stderr)
                self.assertIn(output, said.stdout + said.stderr)
            packages = next((folder / "venv/lib").glob("python*/site-packages/thalweg"))
            sources, installed = ({str(path.relative_to(root)) for path in root.rglob("*.py")}
                                  for root in (ROOT / "python/thalweg", packages))
            self.assertEqual(installed, sources)


if __name__ == "__main__":
    unittest.main()
