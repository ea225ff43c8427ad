"""A folder with a case of its own, in which tests plan sweeps."""
import tempfile
import unittest
from pathlib import Path

import made_up_folder   # noqa: F401  finds the package
from thalweg.sweep.plan import plan_of

BISECT = {"key": "gravity.slope", "from": 0.0, "to": 1.0, "width": 0.2, "holds": "transport_rate.q_star_mean > 0.1"}


class Folder(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        (self.folder / "case.yaml").write_text("system: grains\n")

    def plan(self, **content):
        return plan_of({"case": "case.yaml"} | content, self.folder)
