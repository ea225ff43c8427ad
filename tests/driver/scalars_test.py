"""Words of a case file mean the same to the solver and to a sweep.

Called by ctest: scalars_test.py THALWEG MPIEXEC [unittest arguments]

A sweep reads values by python/thalweg/case_file.py and hands them to the program with --set. Each word stands at a
text, a whole number, a real number and a truth value, once in the case file and once as a sweep hands it over: the
program must refuse both or make the same of them, as the case.yaml of the run shows.
"""
import sys
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import ProgramTest
from thalweg.case_file import CaseLoader, WordLoader, setting_of

CASE = """
system: grains
name: words
domain: {size: [0.02, 0.02, 0.02], spacing: 1.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}}
gravity: {magnitude: 9.8}
grains: [{count: 1, diameter: 5.0e-3, density: 2550, fixed: false, placement: {seed: 1}}]
contact: {normal_stiffness: 20000, restitution: 0.5}
run: {until: 5.0e-6, time_step: 5.0e-6}
"""

# Sexagesimal, octal and hexadecimal numbers, dates, underlines and yes or no are YAML 1.1.
NUMBERS = [
    "010", "-010", "08", "+3", "0o17", "0x10", "1_000", "1:30", "190:20:30", "1e3", "1e-3", "1.5E+3", "1.", ".5",
    "1e400", "1e-400", "99999999999999999999", ".inf", "inf", ".nan", "nan", "'010'", '"1e-3"', "!!int 7", "!!str 7",
    "1 2",
]
TRUTHS = ["no", "yes", "on", "off", "y", "true", "True", "TRUE", "'true'", "false", "1"]
TEXTS = ["010", "1e-3", "1:30", "no", "true", "2026-01-01", "=", "<<", "'a: b'", "é", "null", "~", "Null"]
WORDS = sorted({*NUMBERS, *TRUTHS, *TEXTS})

# Each key with what stands there in the case and the words that are tried; `seed` takes whole numbers, `density` real
# ones.
KEYS = {"name": ("name: words", TEXTS), "grains.0.placement.seed": ("seed: 1", NUMBERS),
        "grains.0.density": ("density: 2550", NUMBERS), "grains.0.fixed": ("fixed: false", TRUTHS)}


class Scalars(ProgramTest):
    CASE = CASE

    def outcome(self, number, text, *settings):
        """What case.yaml of a run has, or None where it is refused."""
        self.case.write_text(text, encoding="utf-8")
        out = self.folder / f"run_{number}"
        result = self.thalweg("run", "case.yaml", "--out", out, *settings)
        if result.returncode == 2:
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
            return None
        self.assertEqual(result.returncode, 0, result.stderr)
        kept = (out / "case.yaml").read_text(encoding="utf-8")
        return [line for line in kept.splitlines() if not line.startswith("#")]

    def test_words_mean_the_same(self):
        number, taken = 0, 0
        for key, (here, words) in KEYS.items():
            for word in words:
                with self.subTest(key=key, word=word):
                    line = here.split(":")[0] + ": " + word
                    value = yaml.load(line, WordLoader)[here.split(":")[0]]
                    if value is None:   # null takes a key out of the case, in a sweep as on the command line
                        self.assertIn(word, ("null", "~", "Null"))
                        continue
                    direct = self.outcome(number, CASE.replace(here, line))
                    swept = self.outcome(number + 1, CASE, "--set", f"{key}={setting_of(value)}")
                    self.assertEqual(direct, swept)
                    number, taken = number + 2, taken + (direct is not None)
        self.assertGreater(taken, 20)

    def test_what_words_are(self):
        read = {
            word: yaml.load(f"a: {word}", CaseLoader)["a"] for word in WORDS
        }  # as YAML 1.2 (section 10.3) has them, if decimal
        self.assertEqual({word: read[word] for word in ("010", "-010", "08", "+3", "1e3", ".5", "1e-3")},
                         {"010": 10, "-010": -10, "08": 8, "+3": 3, "1e3": 1000.0, ".5": 0.5, "1e-3": 0.001})
        self.assertEqual({word: read[word] for word in ("true", "false", "null", "~")},
                         {"true": True, "false": False, "null": None, "~": None})
        for word in (
            "0x10", "0o17", "1_000", "1:30", "no", "yes", "on", "True", "2026-01-01", "=", "<<", ".inf", "inf", "1e400",
        ):
            self.assertEqual(read[word], word)
        for word in ("'010'", "!!int 7"):
            self.assertIsInstance(read[word], str)

    def test_a_key_given_twice_is_an_error(self):
        with self.assertRaisesRegex(yaml.YAMLError, "given twice"):
            yaml.load("a: 1\na: 2\n", CaseLoader)
        with self.assertRaisesRegex(yaml.YAMLError, "a key is not a word"):
            yaml.load("? [a]\n: 1\n", CaseLoader)
        for endless in ("a: &b [1, *b]", "a: &b {c: {d: *b}}"):
            with self.assertRaisesRegex(yaml.YAMLError, "part of what it stands for"):
                yaml.load(endless, CaseLoader)
        self.assertEqual(yaml.load("a: &b [1]\nc: *b\n", CaseLoader), {"a": [1], "c": [1]})
        self.assertEqual(yaml.load("<<: {a: 1}\nb: 2\n", CaseLoader), {"<<": {"a": 1}, "b": 2})


if __name__ == "__main__":
    program.main()
