"""Tables of runs that outlive the folders of the runs."""
import tempfile
import unittest
from pathlib import Path

import made_up_folder   # noqa: F401  finds the package
from thalweg.errors import RunFolderError
from thalweg.tables import merged_rows, read_rows


class MergedRows(unittest.TestCase):
    def test_what_is_given_takes_the_place_of_the_same_run(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "table.csv"
            first = [{"run": "a", "q": "1"}, {"run": "b", "q": "2"}, {"run": "b", "q": "3"}, {"run": "c", "q": "4"}]
            self.assertEqual(merged_rows(path, first), first)
            merged = merged_rows(path, [{"run": "d", "q": "6"}, {"run": "b", "q": "5"}])
            self.assertEqual(
                [(row["run"], row["q"]) for row in merged], [("a", "1"), ("b", "5"), ("c", "4"), ("d", "6")]
            )
            self.assertEqual(read_rows(path), merged)
            self.assertEqual(merged_rows(path, []), merged)

    def test_a_new_table_of_no_runs_is_not_written(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "table.csv"
            with self.assertRaisesRegex(RunFolderError, "table.csv: there is no run"):
                merged_rows(path, [])
            self.assertFalse(path.exists())

    def test_without_a_table_nothing_is_kept(self):
        self.assertEqual(merged_rows(None, [{"run": "a"}]), [{"run": "a"}])


if __name__ == "__main__":
    unittest.main()
