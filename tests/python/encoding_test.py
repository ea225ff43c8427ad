"""Text files are read and written as UTF-8, whatever the locale: every call that opens one says so. Python before 3.15
takes the encoding of the locale otherwise, and under an ISO-8859 locale a case with an "é" in it cannot be read."""
import ast
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("python", "scripts", "cases", "benchmarks", "docs")


def is_text(call):
    """Whether a call opens a text file: open(), or read_text(), write_text() or open() of a path."""
    name = (
        call.func.id
        if isinstance(call.func, ast.Name)
        else call.func.attr
        if isinstance(call.func, ast.Attribute)
        else ""
    )
    if name in ("read_text", "write_text"):
        return True
    if name != "open" or (isinstance(call.func, ast.Attribute) and isinstance(call.func.value, ast.Name) and
                          call.func.value.id in ("os", "Image", "gzip", "zipfile")):
        return False
    modes = call.args[1:2] if isinstance(call.func, ast.Name) else call.args[:1]
    modes += [keyword.value for keyword in call.keywords if keyword.arg == "mode"]
    return not any(isinstance(mode, ast.Constant) and "b" in str(mode.value) for mode in modes)


def calls_without_encoding(text):
    """The calls of a source that open a text file without naming an encoding."""
    return [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call) and is_text(node) and
            not any(keyword.arg == "encoding" for keyword in node.keywords)]


class Encoding(unittest.TestCase):
    def test_the_check_finds_what_it_should(self):
        found = calls_without_encoding(
            "open(p)\nopen(p, 'rb')\np.read_text()\nopen(p, encoding='utf-8')\nos.open(p, 0)\np.open('w')"
        )
        self.assertEqual([call.lineno for call in found], [1, 3, 6])

    def test_every_text_file_is_opened_as_utf_8(self):
        for source in sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.py")):
            for call in calls_without_encoding(source.read_text(encoding="utf-8")):
                self.fail(f"{source.relative_to(ROOT)}:{call.lineno}: name the encoding, \"utf-8\"")

    def test_a_run_is_read_where_the_locale_has_another_encoding(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "case.yaml").write_text("system: grains\nname: Chézy\n", encoding="utf-8")
            command = (
                "import sys, thalweg, locale; print(ascii(thalweg.Run(sys.argv[1]).name),"
                " locale.getpreferredencoding(False))"
            )
            # The C locale with Python's own ways out of it switched off: ASCII.
            environment = os.environ | {
                "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "PYTHONPATH": str(ROOT / "python"),
            }
            said = subprocess.run(
                [sys.executable, "-c", command, folder], env=environment, capture_output=True, encoding="utf-8"
            )
            self.assertEqual(said.stdout.split(), ["'Ch\\xe9zy'", "ANSI_X3.4-1968"], said.stderr)


if __name__ == "__main__":
    unittest.main()
