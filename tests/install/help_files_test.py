"""Completion and manual page name what the program's help names: help_files_test.py THALWEG"""
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "thalweg"
SCRIPT = Path(__file__).resolve().parents[2] / "cmake/help_files.py"


class HelpFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.folder = Path(holder.name)
        subprocess.run([sys.executable, "-B", SCRIPT, PROGRAM, cls.folder], check=True)

    def completed(self, *words):
        """What bash offers for the last of the words."""
        words = ["thalweg", *words]
        script = (f"source {self.folder / 'thalweg.bash'}; COMP_WORDS=({' '.join(repr(word) for word in words)}); "
                  f"COMP_CWORD={len(words) - 1}; _thalweg; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
        return subprocess.run(
            ["bash", "-euc", script], check=True, capture_output=True, encoding="utf-8", cwd=self.folder
        ).stdout.split()

    def said(self, *words):
        return subprocess.run([PROGRAM, *words], check=True, capture_output=True, encoding="utf-8").stdout

    def test_bash(self):
        commands = re.findall(
            r"^  ([a-z]+)  ", self.said("--help").split("Subcommands:")[1].split("Examples")[0], re.MULTILINE
        )
        self.assertGreater(len(commands), 8)
        self.assertEqual(self.completed(""), commands)
        self.assertEqual(self.completed("sw"), ["sweep"])
        for command in commands:   # every option of the help, and nothing else
            options = re.findall(r"^  (?:-h, ?)?(--[a-z-]+)", self.said(command, "--help"), re.MULTILINE)
            self.assertEqual(self.completed(command, "--"), options, command)
        self.assertEqual(self.completed("run", "case.yaml", "--wall"), ["--walltime"])
        self.assertEqual(self.completed("plot", "fi"), ["film"])
        self.assertEqual(self.completed("plot", "film", "run", "--ev"), ["--every"])
        (self.folder / "case.yaml").touch()
        self.assertEqual(self.completed("run", "ca"), ["case.yaml"])

    @unittest.skipUnless(shutil.which("zsh"), "needs zsh")
    def test_zsh(self):

        done = subprocess.run(["zsh", "-n", self.folder / "_thalweg"], capture_output=True, encoding="utf-8")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_zsh_names_every_option(self):
        text = (self.folder / "_thalweg").read_text(encoding="utf-8")
        self.assertTrue(text.startswith("#compdef thalweg\n"))
        functions = dict(re.findall(r"^(_\w+)\(\) {\n(.*?)^}", text, re.MULTILINE | re.DOTALL))
        self.assertIn("'--walltime[", functions["_thalweg_run"])
        self.assertIn("]:HH\\:MM\\:SS:_files'", functions["_thalweg_run"])
        self.assertIn("'--overwrite[Replace an existing run folder]' ", functions["_thalweg_run"])   # takes no value
        self.assertIn("'--every[", functions["_thalweg_plot_film"])
        self.assertIn("film) _thalweg_plot_film ;;", functions["_thalweg_plot"])

    @unittest.skipUnless(shutil.which("groff"), "needs groff")
    def test_the_manual_page(self):
        done = subprocess.run(
            ["groff", "-man", "-Tutf8", "-ww", "-P-c", self.folder / "thalweg.1"], capture_output=True, encoding="utf-8"
        )
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        text = " ".join(re.sub(".\b", "", done.stdout).split())   # without overstrikes
        for words in (
            "SYNOPSIS", "thalweg run CASE.yaml", "--walltime HH:MM:SS", "thalweg plot film RUN", "--every SECONDS",
            "EXIT STATUS", "0 done; 1 the run failed", "thalweg check cases/quickstart/case.yaml",
        ):
            self.assertIn(words, text)


if __name__ == "__main__":
    unittest.main()
