"""compare_checkpoints.py calls two files the same exactly if every bit of every dataset and attribute is."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "compare_checkpoints.py"


def write(path, change=lambda file: None):
    with h5py.File(path, "w") as file:
        file["fluid/populations"] = np.linspace(-1, 1, 7 * 5 * 3, dtype=np.float32).reshape(7, 5, 3)
        file["grains/position"] = np.array([[0.0, np.nan, 1e-300], [1.0, 2.0, 3.0]])
        file["grains/id"] = np.arange(2, dtype=np.int64)
        file["grains/spring"] = np.empty((0, 3))
        file["run"] = np.float64(0.5)
        file["grains"].attrs["step"] = np.int64(12)
        file["grains"].attrs["name"] = "flume"
        change(file)


class CompareCheckpoints(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        write(self.folder / "a.h5")

    def compare(self, first="a.h5", second="b.h5", *options):
        done = subprocess.run([sys.executable, SCRIPT, first, second, *options], cwd=self.folder, text=True,
                              capture_output=True)
        return done.returncode, done.stdout + done.stderr

    def test_the_same_data_in_two_files_is_the_same(self):
        write(self.folder / "b.h5")
        code, text = self.compare()
        self.assertEqual(code, 0, text)
        self.assertIn("7 datasets and attributes", text)

    def test_every_kind_of_difference_is_seen(self):
        def change_dataset(name, index, value):
            return lambda file: file[name].__setitem__(index, value)

        def replace(name, value):
            def act(file):
                del file[name]
                if value is not None:
                    file[name] = value
            return act

        above = np.nextafter(np.linspace(-1, 1, 105, dtype=np.float32)[-1], np.float32(2))
        changes = {
            "one unit in the last place": (change_dataset("fluid/populations", (6, 4, 2), above),
                                           "fluid/populations: 1 of 105", "[6, 4, 2]"),
            "the sign of zero": (change_dataset("grains/position", (0, 0), -0.0), "grains/position: 1 of 6", "[0, 0]"),
            "a number for none": (change_dataset("grains/position", (0, 1), 1.0), "grains/position: 1 of 6", "[0, 1]"),
            "an integer": (change_dataset("grains/id", 1, 5), "grains/id: 1 of 2", "by at most 4"),
            "a scalar": (change_dataset("run", (), 0.25), "run: 1 of 1", "0.5 against 0.25"),
            "the type": (replace("grains/id", np.arange(2, dtype=np.int32)), "grains/id: type", "int32"),
            "the shape": (replace("grains/spring", np.zeros((1, 3))), "grains/spring: shape", "(1, 3)"),
            "a missing dataset": (replace("grains/id", None), "grains/id: only in a.h5", ""),
            "an attribute": (lambda file: file["grains"].attrs.__setitem__("step", np.int64(13)), "grains@step:", "13"),
            "a text": (lambda file: file["grains"].attrs.__setitem__("name", "river"), "grains@name:", "river"),
        }
        for name, (change, first_piece, second_piece) in changes.items():
            with self.subTest(name):
                write(self.folder / "b.h5", change)
                code, text = self.compare()
                self.assertEqual(code, 1, text)
                self.assertIn(first_piece, text)
                self.assertIn(second_piece, text)
                self.assertIn("different: 1 of 7", text)

    def test_what_is_ignored_does_not_count(self):
        write(self.folder / "b.h5", lambda file: file["grains"].attrs.__setitem__("step", np.int64(13)))
        self.assertEqual(self.compare("a.h5", "b.h5", "--ignore", "grains@step")[0], 0)

    def test_a_run_folder_stands_for_its_latest_checkpoint(self):
        (self.folder / "r/checkpoints").mkdir(parents=True)
        write(self.folder / "r/checkpoints/step_3.h5")
        (self.folder / "r/checkpoints/latest").write_text("step_3.h5\n")
        code, text = self.compare("a.h5", "r")
        self.assertEqual(code, 0, text)
        self.assertIn("step_3.h5", text)

    def test_what_cannot_be_compared_is_no_match(self):
        (self.folder / "text.h5").write_text("not HDF5")
        (self.folder / "empty").mkdir()
        for second in ("missing.h5", "text.h5", "empty"):
            with self.subTest(second):
                self.assertEqual(self.compare("a.h5", second)[0], 2)
        write(self.folder / "damaged.h5")
        whole = (self.folder / "damaged.h5").read_bytes()
        place = whole.index(b"grains")   # in the index of the root
        (self.folder / "damaged.h5").write_bytes(whole[:place] + b"\xff" * 400 + whole[place + 400:])
        (self.folder / "folder/checkpoints").mkdir(parents=True)
        (self.folder / "folder/checkpoints/latest").write_bytes(b"\xff\xfe")
        for second, name in (("damaged.h5", "damaged.h5"), ("text.h5", "text.h5"), ("folder", "folder/checkpoints")):
            with self.subTest(second):
                code, text = self.compare("a.h5", second)
                self.assertEqual((code, text.count("\n")), (2, 1), text)
                self.assertIn(name, text)


if __name__ == "__main__":
    unittest.main()
