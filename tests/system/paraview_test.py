"""scripts/paraview_view.py makes a picture and a state that ParaView opens again. Left out where there is no pvpython,
which Debian does not install beside VTK's Python (unpack its packages paraview and python3-paraview elsewhere)."""
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import matplotlib.image
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import made_up_run  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
PVPYTHON = os.environ.get("PVPYTHON") or shutil.which("pvpython")
AGAIN = """
from paraview import simple
simple.LoadState({state!r})
simple.SaveScreenshot({picture!r}, simple.GetActiveViewOrCreate("RenderView"), ImageResolution=[640, 360])
import os
os._exit(0)
"""


@unittest.skipUnless(PVPYTHON and shutil.which("xvfb-run"), "needs pvpython and xvfb-run")
class ParaviewView(unittest.TestCase):
    def pvpython(self, *arguments):
        return subprocess.run(
            ["xvfb-run", "-a", "-s", "-noreset -screen 0 1280x1024x24", PVPYTHON, *map(str, arguments)], text=True,
            capture_output=True, timeout=120,
        )

    def assert_drawn(self, path):
        """More than thirty colours: spheres with their shading, and scales."""
        pixels = matplotlib.image.imread(path)[..., :3]
        self.assertGreater(len(np.unique((pixels * 31).astype(int).reshape(-1, 3), axis=0)), 30)

    def test_a_picture_and_a_state(self):
        with tempfile.TemporaryDirectory() as folder:
            run = pathlib.Path(folder) / "run"
            made_up_run.write_run(run)
            done = self.pvpython(ROOT / "scripts/paraview_view.py", run, "--size", 640, 360)
            self.assertEqual(done.returncode, 0, done.stderr)
            picture, state = run / "paraview.png", run / "view.pvsm"
            self.assertEqual(done.stdout.split(), [str(picture), str(state)])
            self.assert_drawn(picture)
            script, again = pathlib.Path(folder) / "again.py", run / "again.png"
            script.write_text(AGAIN.format(state=str(state), picture=str(again)))
            done = self.pvpython(script)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assert_drawn(again)

    def test_a_run_without_frames(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.pvpython(ROOT / "scripts/paraview_view.py", folder)
            self.assertEqual(done.returncode, 1)
            self.assertIn("neither grains.pvd nor fluid.pvd", done.stderr)


@unittest.skipIf(importlib.util.find_spec("paraview"), "this Python has ParaView")
class OtherPython(unittest.TestCase):
    def test_a_python_without_paraview_is_told_what_has_it(self):
        done = subprocess.run(
            [sys.executable, ROOT / "scripts/paraview_view.py", "run"], text=True, capture_output=True, timeout=60
        )
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertIn("pvpython", done.stderr)


if __name__ == "__main__":
    unittest.main()
