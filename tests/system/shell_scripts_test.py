"""The shell scripts: help and unknown words touch nothing, a stage shows one line and keeps the rest in its log."""
import os
import pathlib
import pty
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = ("setup", "build", "test", "run", "check", "coverage", "docs", "thread_sanitizer", "valgrind")


class Words(unittest.TestCase):
    """In a folder of programs that would install or build and here only leave a trace."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.trace = pathlib.Path(self.folder.name) / "trace"
        for name in ("apt-get", "sudo", "dpkg-query", "cmake", "ctest", "mpirun", "gcovr", "doxygen"):
            program = pathlib.Path(self.folder.name) / name
            program.write_text(f'#!/bin/sh\necho "$0" >>"{self.trace}"\nexit 1\n')
            program.chmod(0o755)

    def result_of(self, script, *words, **variables):
        environment = os.environ | {"PATH": f"{self.folder.name}:{os.environ['PATH']}"} | variables
        return subprocess.run([ROOT / "scripts" / script, *words], capture_output=True, text=True, env=environment,
                              stdin=subprocess.DEVNULL, timeout=60)

    def test_help_is_all_that_happens(self):
        for script in SCRIPTS:
            for word in ("--help", "-h"):
                with self.subTest(script=script, word=word):
                    result = self.result_of(script, word)
                    self.assertEqual((result.returncode, result.stderr), (0, ""))
                    first_comment = (ROOT / "scripts" / script).read_text().splitlines()[1]
                    self.assertEqual(result.stdout.splitlines()[0], first_comment.removeprefix("# "))
                    self.assertFalse(self.trace.exists())

    def test_unknown_words_are_refused_before_anything_happens(self):
        for script in SCRIPTS:
            for word in ("--nonsense", "nonsense"):
                with self.subTest(script=script, word=word):
                    result = self.result_of(script, word)
                    self.assertEqual(result.returncode, 2, result.stderr)
                    self.assertIn("nonsense", result.stderr.splitlines()[0])
                    self.assertFalse(self.trace.exists())

    def test_the_coverage_of_no_run_is_refused(self):
        shutil.copytree(ROOT / "scripts", pathlib.Path(self.folder.name) / "scripts")
        result = self.result_of(f"{self.folder.name}/scripts/coverage", "--again")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("there is no earlier run in build/coverage", result.stderr)
        self.assertFalse(self.trace.exists())

    def test_a_number_of_ranks_that_is_none_is_refused_before_anything_happens(self):
        for ranks in ("two", "0", "-1", "1.5"):
            result = self.result_of("run", THALWEG_RANKS=ranks)
            self.assertEqual((result.returncode, result.stdout), (2, ""))
            self.assertIn(f"THALWEG_RANKS={ranks} is not a number of ranks", result.stderr)
            self.assertFalse(self.trace.exists())


# As APT 3 does with the file it reports its progress to: whoever writes there is told that there is no room, instead of
# waiting.
APT = """#!/usr/bin/env python3
import os, re, sys
os.set_blocking(int(re.search("APT::Status-Fd=([0-9]+)", " ".join(sys.argv))[1]), False)
text = b"Unpacking something ...\\n" * 4000
while text:
    text = text[os.write(1, text):]
"""


class JobScripts(unittest.TestCase):
    def test_without_what_they_need_they_say_how_they_are_submitted(self):
        environment = {name: value for name, value in os.environ.items()
                       if not name.startswith(("CASE", "FOLDER", "SLURM", "PBS"))}
        for script, command in (("slurm.sh", "sbatch slurm.sh CASE"), ("pbs.sh", "qsub -v CASE,FOLDER pbs.sh")):
            for words in ([], ["--help"]):
                result = subprocess.run(["bash", ROOT / "scripts/cluster" / script, *words], capture_output=True, text=True,
                                        env=environment, timeout=60)
                self.assertNotEqual(result.returncode, 0)
                self.assertIn(command, result.stderr)


class Clocks(unittest.TestCase):
    def test_times_of_a_scheduler(self):
        for clock, seconds in {
            "1-12:30:05": 131405, "1-12:30": 131400, "1-12": 129600, "08:09:10": 29350, "12:30": 750, "45": 45,
            "UNLIMITED": None, "1-": None, "": None,
        }.items():
            said = subprocess.run(
                ["bash", "-euc", f'source "{ROOT}/scripts/cluster/turn.sh"; seconds_of "$1"', "bash", clock],
                capture_output=True, text=True, timeout=60,
            )
            self.assertEqual(said.stdout.strip(), "" if seconds is None else str(seconds), clock)
            self.assertEqual(said.returncode, 0, said.stderr)


class Setup(unittest.TestCase):
    def test_messages_of_packages_wait_until_there_is_room(self):
        with tempfile.TemporaryDirectory() as name:
            for program, text in {
                "apt-get": APT,
                "dpkg-query": "#!/bin/sh\nexit 1\n",
                "sudo": '#!/bin/sh\nshift\nexec "$@"\n',
            }.items():
                (pathlib.Path(name) / program).write_text(text)
                (pathlib.Path(name) / program).chmod(0o755)
            result = subprocess.run(
                [ROOT / "scripts/setup"], capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=120,
                env=os.environ | {"PATH": f"{name}:{os.environ['PATH']}"},
            )
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("== Installing packages", result.stdout)


class Stages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.log = pathlib.Path(folder.name) / "logs" / "work.log"

    def command_of(self, work):
        return [
            "bash", "-c",
            f'set -euo pipefail; source "{ROOT}/scripts/stages"; stage "Working" "{self.log}" bash -c "$1"; echo next',
            "a_script", work,
        ]

    def result_of(self, work):
        return subprocess.run(self.command_of(work), capture_output=True, text=True, timeout=60)

    def test_what_a_command_prints_goes_to_the_log(self):
        result = self.result_of("echo '[1/2] one'; echo 'pmstatus:x:50:y'; echo two >&2")
        self.assertEqual(result.stderr, "")
        self.assertRegex(result.stdout, r"^== Working \.\.\. done in 0:0\d\nnext\n$")
        self.assertEqual(self.log.read_text(), "[1/2] one\ntwo\n")

    def test_a_failure_names_the_log_and_shows_its_last_twenty_lines(self):
        result = self.result_of("seq 30; exit 7")
        self.assertEqual(result.returncode, 7)
        self.assertRegex(result.stdout, r"^== Working \.\.\. failed after 0:0\d\n$")
        self.assertEqual(result.stderr.splitlines()[1:], [str(n) for n in range(11, 31)])
        self.assertIn(str(self.log), result.stderr.splitlines()[0])

    def test_warnings_are_counted(self):
        result = self.result_of("echo 'a.cpp:1: warning: b'")
        self.assertIn(f"warnings: 1, see {self.log}; done", result.stdout)

    def test_a_terminal_shows_the_share_done(self):
        shown = bytearray()

        def read(descriptor):
            block = os.read(descriptor, 1024)
            shown.extend(block)
            return block

        quiet = os.open(os.devnull, os.O_WRONLY)
        kept = os.dup(1)
        os.dup2(quiet, 1)  # pty.spawn copies what it reads to the standard output
        try:
            pty.spawn(self.command_of("echo '[1/4] one'; echo '[4/4] four'"), read)
        finally:
            os.dup2(kept, 1)
            os.close(kept)
            os.close(quiet)
        text = shown.decode()
        self.assertIn("Working ... 25 %", text)
        self.assertIn("Working ... 100 %", text)
        self.assertRegex(text.splitlines()[-2], r"== Working \.\.\. done in 0:0\d$")


if __name__ == "__main__":
    unittest.main()
