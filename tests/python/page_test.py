"""thalweg report makes one page of a run of every kind that needs nothing beside it, and says what the run says."""
import html.parser
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/support")]
import made_up_profiles  # noqa: E402
import made_up_run  # noqa: E402
import thalweg  # noqa: E402
from thalweg.figures import overview  # noqa: E402
from thalweg.history import Session, last_change, sessions_of, settings_in, warnings_of  # noqa: E402
from thalweg.page.sections import page_of  # noqa: E402

LOG = """Thalweg 0.1.0 (aaa): Made up
resolved on 2 ranks, layout 2 x 1 x 1; 7 grains, 99 cells; 1e-05 s a step, 100 steps to 1 s
writing run
warning: The step is <long>.
t 0.5       of 1 s    50 %  left 1 s   9 steps/s  warning: 3 grains overlap
not finished, stopped by SIGTERM: at 0.5 s; to continue, repeat the command with --resume (and without --restart)
Thalweg 0.1.0 (bbb): Made up
resolved on 2 ranks, layout 2 x 1 x 1; 7 grains, 99 cells; 1e-05 s a step, 200 steps to 2 s
resuming from run/checkpoints/step_50.h5 at 0.5 s
changed since then: run.until: 1 -> 2
warning: The step is <long>.
"""
VOID = {"meta", "img", "br"}


class Page(html.parser.HTMLParser):
    """Checks that the tags are nested, and gathers headings, links to elsewhere and text."""

    def __init__(self, text):
        super().__init__()
        self.open, self.sections, self.elsewhere, self.pictures, self.words = [], [], [], 0, []
        self.feed(text)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        for name in ("src", "href"):
            if name in attributes and not attributes[name].startswith("data:image/png;base64,"):
                self.elsewhere.append(attributes[name])
        self.pictures += tag == "img"
        if tag in ("script", "link", "iframe"):
            self.elsewhere.append(tag)
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, (tag, self.open)
        self.open.pop()

    def handle_data(self, data):
        if self.open and self.open[-1] == "h2":
            self.sections.append(data)
        if self.open and self.open[-1] != "style":
            self.words.append(data)

    @property
    def text(self):
        return re.sub(r"\s+", " ", " ".join(self.words))


class Report(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name) / "run"
        made_up_run.write_run(self.folder)
        (self.folder / "run.log").write_text(LOG)

    def case(self, *replacements, head=""):
        path = self.folder / "case.yaml"
        text = path.read_text()
        for old, new in replacements:
            self.assertIn(old, text)
            text = text.replace(old, new)
        path.write_text(head + text)

    def page(self):
        return Page(page_of(thalweg.Run(self.folder)))

    def test_a_bed_that_is_not_finished(self):
        self.case(
            head="# command thalweg run x.yaml --out run --set fluid.time_step=1e-05 --until 2\n# version 0.1.0\n"
        )
        page = self.page()
        self.assertEqual(page.elsewhere, [])
        for title in ("Picture", "Transport", "Warnings", "Case, as it was run", "Provenance", "How to repeat it"):
            self.assertIn(title, page.sections)
        self.assertNotIn("Where the time went", page.sections)   # no summary yet
        for words in (
            "it is still running, has failed or was killed", "fluid.time_step=1e-05", "run.until=2", "run.until: 1 -> 2",
            "The step is <long>.", "3 grains overlap (at 0.5 s)", "0.1.0 (aaa)", "--resume", "standard error",
            "in front of the flow in the middle plane, at the last time of which both are stored",
        ):
            self.assertIn(words, page.text)
        self.assertEqual(page.text.count("The step is <long>."), 1)   # of two sessions

    def test_a_run_that_ended(self):
        phases = {"links": {"mean_seconds": 30.0, "largest_seconds": 31.0, "share": 0.75},
                  "sweep": {"mean_seconds": 10.0, "largest_seconds": 11.0, "share": 0.25}}
        summary = {
            "finished": True, "reason": "", "simulated_time": 2.0, "until": 2.0, "version": "0.1.0 (bbb)", "ranks": 2,
            "wall_seconds": 40.0, "steps_in_this_session": 100, "steps_per_second": 2.5, "phases": phases,
            "bed": {"porosity": 0.4, "bed_height": 0.0123}, "units": {"bed_height": "m", "porosity": "1"},
            "provenance": {"host": "node7", "compiler": "GNU 12.2.0", "inputs": [
                {"key": "solids.0.stl", "path": "../sill.stl", "sha256": "ab12"}]},
        }
        for finished, words in (
            (True, "Finished at 2 s."), (False, "Not finished, stopped by thalweg stop: at 2 of 2 s."),
        ):
            summary |= {"finished": finished, "reason": "" if finished else "stopped by thalweg stop"}
            (self.folder / "summary.json").write_text(json.dumps(summary))
            page = self.page()
            self.assertIn(words, page.text)
            self.assertRegex(page.text, r"links 30\.00 31\.00 75\.0 %")
            self.assertRegex(page.text, r"height of the bed 0\.0123 m")
            self.assertIn("host node7 compiler GNU 12.2.0 solids.0.stl ../sill.stl, SHA-256 ab12", page.text)
            self.assertIn("mpirun -n 2 thalweg run", page.text)
            self.assertEqual(re.search(r"--out \S+ --resume", page.text) is not None, not finished)

    def test_a_run_whose_case_was_changed_is_not_repeated_by_its_last_case(self):
        self.assertIn("the same run once more", self.page().text)
        with open(self.folder / "run.log", "a") as log:
            log.write("changed since then: contact.friction: 0.3 -> 0.5\n")
        text = self.page().text
        self.assertNotIn("the same run once more", text)
        self.assertIn("this is another run", text)

    def test_files_that_were_saved_on_windows(self):
        """With a byte-order mark and other ends of lines they say the same."""
        self.case(head="# command thalweg run x.yaml --out run --set fluid.time_step=1e-05\n# version 0.1.0\n")
        (self.folder / "summary.json").write_text(json.dumps({"finished": True, "simulated_time": 2.0}))
        log = self.folder / "run.log"
        seconds, before = log.stat().st_mtime, self.page().text
        for name in ("case.yaml", "run.log", "series.csv", "summary.json"):
            path = self.folder / name
            path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"\n", b"\r\n"))
        os.utime(log, (seconds, seconds))
        self.assertEqual(self.page().text, before)

    def test_the_versions_of_a_run_that_went_back_to_the_first(self):
        with open(self.folder / "run.log", "a") as log:
            log.write("Thalweg 0.1.0 (aaa): Made up\nresolved on 2 ranks\n")
        self.assertIn("version 0.1.0 (aaa) versions before 0.1.0 (bbb) ", self.page().text)

    def test_the_balance_of_stresses(self):
        diameter = made_up_run.DIAMETER
        self.case(
            head=(
                f"fluid: {{density: 1000}}\ngravity: {{magnitude: 9.8, slope: 0.06}}\ngrains: [{{diameter: {diameter},"
                " density: 2550}]\n"
            )
        )
        made_up_profiles.write_grain_profiles(self.folder / "profiles.h5", diameter)
        made_up_profiles.add_stress_balance(self.folder / "profiles.h5", diameter)
        page = self.page()
        self.assertIn("Profiles", page.sections)
        # Total and driving stress are 1 Pa everywhere, and side walls take 1 Pa: the gap is all of it, and the driving
        # stress is nought.
        self.assertIn("The balance of stresses has not been measured yet.", page.text)
        with h5py.File(self.folder / "profiles.h5", "a") as file:
            file["stress_balance/side_wall_stress"][...] = 0.75
        self.assertIn("by 0.75 Pa at most, 3e+02 % of its largest value", self.page().text)

    def test_a_fluid_alone(self):
        self.case(("transport_rate: {from: 1.0}", "fluid_statistics: {from: 0}"), head="system: fluid\n")
        (self.folder / "grains.pvd").unlink()
        (self.folder / "series.csv").write_text("time [s],largest_fluid_speed [m/s]\n0,1\n1,2\n")
        page = self.page()
        self.assertNotIn("Transport", page.sections)
        self.assertIn("Course of the run", page.sections)
        self.assertEqual(page.pictures, 2)
        for velocity, pictures in ((0.0, 2), (1.0, 3)):   # means that have not begun are not drawn
            with h5py.File(self.folder / "profiles.h5", "w") as file:
                file["fluid_statistics/z"], file["fluid_statistics/velocity"] = np.arange(4.0), np.full(
                    (4, 3), velocity
                )
                file["fluid_statistics/reynolds_stress"] = np.zeros((4, 6))
            self.assertEqual(self.page().pictures, pictures)

    def test_a_continuum(self):
        self.case(head="system: continuum\n")
        for name in ("grains.pvd", "fluid.pvd"):
            (self.folder / name).unlink()
        with h5py.File(self.folder / "profiles.h5", "w") as file:
            for name in (
                "z", "solid_fraction", "grain_shear_stress", "fluid_shear_stress", "total_stress", "driving_stress",
            ):
                file[f"continuum/{name}"] = np.linspace(0.0, 1.0, 5)
            for name in ("grain_velocity", "fluid_velocity"):
                file[f"continuum/{name}"] = np.ones((5, 3))
        (self.folder / "series.csv").write_text(
            "time [s],q_star [1],unsteadiness [1]\n0,0,1\n5,0.06,1\n10,0.08,1e-5\n"
        )
        page = self.page()
        self.assertIn("q* = 0.08 at 10 s, unsteadiness 1e-05.", page.text)
        self.assertEqual([name for name, _ in overview.figures_of(thalweg.Run(self.folder))],
                         ["transport_rate", "profiles"])
        self.assertNotIn("too short", page.text)
        self.assertNotIn("standard error", page.text)
        self.assertNotIn("Picture", page.sections)
        self.assertIn("Profiles", page.sections)

    def test_captions_of_dry_grains(self):
        self.case(head="system: grains\n")
        (self.folder / "fluid.pvd").unlink()
        series = self.folder / "series.csv"
        series.write_text(series.read_text().replace("q_star [1]", "q_s [m^2/s]"))
        text = self.page().text
        self.assertNotIn("in front of the flow", text)
        self.assertIn("q_s is the volume of grains that passes per unit width and time;", text)
        # Where no mean has begun, none is shaded.
        self.case(("from: 1.0", "from: 1000"))
        text = self.page().text
        self.assertIn("q_s is the volume of grains that passes per unit width and time. There is no mean:", text)

    def test_a_run_with_nothing_yet(self):
        for path in self.folder.iterdir():
            if path.name != "case.yaml":
                shutil.rmtree(path) if path.is_dir() else path.unlink()
        page = self.page()
        self.assertIn("Left out: ", page.text)
        self.assertEqual(page.pictures, 0)

    def test_the_command(self):
        done = subprocess.run(
            [sys.executable, "-B", "-m", "thalweg", "report", self.folder], text=True, capture_output=True,
            env=os.environ | {"PYTHONPATH": str(ROOT / "python")},
        )
        self.assertEqual((done.returncode, done.stdout), (0, f"{self.folder / 'report.html'}\n"), done.stderr)
        Page((self.folder / "report.html").read_text(encoding="utf-8"))

    @unittest.skipUnless(shutil.which("chromium"), "needs chromium (package chromium on Debian)")
    def test_a_browser_shows_it(self):
        import matplotlib.image
        (self.folder / "report.html").write_text(page_of(thalweg.Run(self.folder)), encoding="utf-8")
        shot = self.folder / "shot.png"
        subprocess.run(
            [
                "chromium", "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={self.folder / 'browser'}",
                "--window-size=1000,2400", f"--screenshot={shot}", (self.folder / "report.html").as_uri(),
            ], check=True, capture_output=True, timeout=100,
        )
        pixels = matplotlib.image.imread(shot)[..., :3]
        np.testing.assert_array_equal(pixels[5, 5], 1.0)   # a white page with text and coloured grains on it
        self.assertGreater(float((pixels.max(axis=2) < 0.4).mean()), 0.005)
        self.assertGreater(float((pixels[..., 0] > pixels[..., 2] + 0.3).mean()), 0.005)


class History(unittest.TestCase):
    def test_sessions(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            self.assertEqual(sessions_of(folder), [])
            (folder / "run.log").write_text(LOG)
            first, second = sessions_of(folder)
        self.assertEqual((first.version, second.version), ("0.1.0 (aaa)", "0.1.0 (bbb)"))
        self.assertTrue(first.shape.startswith("resolved on 2 ranks") and second.shape.endswith("to 2 s"))
        self.assertEqual(second.origin, "run/checkpoints/step_50.h5 at 0.5 s")
        self.assertTrue(first.outcome.startswith("not finished, stopped by SIGTERM"))
        self.assertEqual(second.outcome, "")
        self.assertEqual(warnings_of([first, second]), ["The step is <long>.", "3 grains overlap (at 0.5 s)"])

    def test_a_change_that_a_later_restart_left_behind_does_not_count(self):
        def session(time, *changes):
            return Session("0.1.0", origin=f"run/checkpoints/step_1.h5 at {time} s" if time else "", changes=list(changes))
        slope = "gravity.slope: 0.1 -> 0.2"
        course = [session(None), session(2, slope), session(3, "run.until: 3 -> 4")]
        self.assertEqual(last_change(course, ("gravity.",)), 2.0)
        steered = session(4, "fluid.mean_velocity.velocity: 0.02 -> none")
        self.assertEqual(last_change([*course, steered], ("gravity.", "fluid.mean_velocity")), 4.0)
        self.assertEqual(last_change([*course, session(1)], ("gravity.",)), -math.inf)
        self.assertEqual(last_change([*course, session(1), session(1.5, slope)], ("gravity.",)), 1.5)
        self.assertEqual(last_change([*course, session(None)], ("gravity.",)), -math.inf)   # from the start again

    def test_settings(self):
        self.assertEqual(
            settings_in("thalweg run a.yaml --set 'domain.size=[1, 2]' --set=x=1 --until 3 --out --until=4"),
            ["domain.size=[1, 2]", "x=1", "run.until=3", "run.until=4"],
        )


if __name__ == "__main__":
    unittest.main()
