"""Tables of runs that outlive the folders of the runs."""
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import made_up_folder   # noqa: F401  finds the package
from thalweg.errors import RunFolderError
from thalweg.run import Run
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

    def test_a_table_is_kept_where_the_disk_is_full(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "table.csv"
            merged_rows(path, [{"run": "a", "q": "1"}])
            before = path.read_bytes()
            with mock.patch("os.fsync", side_effect=OSError(28, "No space left on device")), self.assertRaises(OSError):
                merged_rows(path, [{"run": "b", "q": "2"}])
            self.assertEqual(path.read_bytes(), before)
            self.assertEqual(list(path.parent.iterdir()), [path])

    def test_a_link_to_a_table_stays_one(self):
        with tempfile.TemporaryDirectory() as folder:
            path, link = Path(folder) / "table.csv", Path(folder) / "link.csv"
            merged_rows(path, [{"run": "a", "q": "1"}])
            path.chmod(0o664)
            link.symlink_to("table.csv")
            merged_rows(link, [{"run": "b", "q": "2"}])
            self.assertTrue(link.is_symlink())
            self.assertEqual(read_rows(path), [{"run": "a", "q": "1"}, {"run": "b", "q": "2"}])
            self.assertEqual(path.stat().st_mode & 0o777, 0o664)

    def test_a_table_of_something_else_is_left_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "series.csv"
            for text, needed in (
                ("time [s]\n0\n", ("run",)), ("time [s]\n", ("run",)), ("run,q\na,1\n", ("run", "error")),
            ):
                path.write_text(text, encoding="utf-8")
                with self.assertRaisesRegex(RunFolderError, f"it has no column {needed[-1]}"):
                    merged_rows(path, [{"run": "b", "q": "1", "error": "2"}], needed)
                self.assertEqual(path.read_text(encoding="utf-8"), text)

    def test_a_table_that_cannot_be_read_is_left_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "table.csv"
            for content, words in ((b"run,q\na,1,2,3\n", "the row a,1,2,3 has more values"),
                                   (b"run,q\nb\xe9d,1\n", "table.csv is not UTF-8")):
                path.write_bytes(content)
                with self.assertRaisesRegex(RunFolderError, words):
                    merged_rows(path, [{"run": "b", "q": "1"}])
                self.assertEqual(path.read_bytes(), content)

    def test_a_run_whose_name_looks_like_a_comment_is_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "table.csv"
            merged_rows(path, [{"run": "#3", "q": "1"}])
            self.assertEqual(read_rows(path), [{"run": "#3", "q": "1"}])

    def test_columns_of_one_run_alone_are_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "table.csv"
            path.write_text("run,remark\na,good\n", encoding="utf-8")
            merged_rows(path, [{"run": "b", "q": "1"}])
            self.assertEqual(read_rows(path), [{"run": "a", "q": "", "remark": "good"}, {"run": "b", "q": "1", "remark": ""}])

    def test_comments_stay_where_they_stood(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "table.csv"
            head = "# q as printed\nrun,q\n# narrow boxes\na,1\n"
            rest = "# wide boxes\nc,4\n# checked\n"
            path.write_text(f"{head}b,2\n# cut short,\n# 3 s of 9\nb,3\n{rest}", encoding="utf-8")
            merged_rows(path, [{"run": "d", "q": "6"}, {"run": "b", "q": "5"}])
            text = f"{head}b,5\n# cut short,\n# 3 s of 9\n{rest}d,6\n"
            self.assertEqual(path.read_text(encoding="utf-8"), text)
            merged_rows(path, [])
            self.assertEqual(path.read_text(encoding="utf-8"), text)

    def test_comments_of_a_table_without_rows_are_kept(self):
        for before, after in (("# a\n", "# a\nrun,q\nb,1\n"), ("# a\nrun,q\n# c\n", "# a\nrun,q\n# c\nb,1\n")):
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "table.csv"
                path.write_text(before, encoding="utf-8")
                merged_rows(path, [{"run": "b", "q": "1"}])
                self.assertEqual(path.read_text(encoding="utf-8"), after)

    def test_a_value_of_several_lines_is_no_comment(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "table.csv"
            path.write_text('run,remark\na,"one\n# two"\n', encoding="utf-8")
            merged_rows(path, [{"run": "b", "remark": ""}])
            self.assertEqual(read_rows(path), [{"run": "a", "remark": "one\n# two"}, {"run": "b", "remark": ""}])

    def test_without_a_table_nothing_is_kept(self):
        self.assertEqual(merged_rows(None, [{"run": "a"}]), [{"run": "a"}])


class FromWindows(unittest.TestCase):
    """Files that git or an editor has saved with other ends of lines or a byte-order mark."""

    def test_a_series(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "case.yaml").write_text("system: grains\n", encoding="utf-8")
            for mark in (b"", b"\xef\xbb\xbf"):
                for end in (b"\n", b"\r\n"):
                    rows = (b"time [s],q_s [m^2/s]", b"0,0.5", b"1,0.25", b"2,0.2")   # the last is being written
                    (Path(folder) / "series.csv").write_bytes(mark + end.join(rows))
                    series = Run(folder).series
                    self.assertEqual({name: list(values) for name, values in series.items()},
                                     {"time": [0.0, 1.0], "q_s": [0.5, 0.25]})
                    self.assertEqual(series.units, {"time": "s", "q_s": "m^2/s"})

    def test_a_table_of_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "table.csv"
            for mark in (b"", b"\xef\xbb\xbf"):
                for end in (b"\n", b"\r\n"):
                    path.write_bytes(mark + end.join((b"# d\xc3\xbcnn", b"run,q", b"a,1", b"# b", b"b,2", b"")))
                    merged_rows(path, [{"run": "b", "q": "3"}])
                    self.assertEqual(read_rows(path), [{"run": "a", "q": "1"}, {"run": "b", "q": "3"}])
                    self.assertEqual(path.read_bytes(), "# dünn\nrun,q\na,1\n# b\nb,3\n".encode())


if __name__ == "__main__":
    unittest.main()
