#!/usr/bin/env python3
"""The run (C++) and its reader (Python) find the same mean, error and trend in the same series.

Called by ctest: same_means_test.py SERIES_MEANS [unittest arguments]; that program writes what the run finds in the
numbers of its standard input.
"""
import subprocess
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
import thalweg

PROGRAM = sys.argv[1]


def chain(memory, count, seed):
    """x_n = memory x_n-1 + noise of variance 1."""
    noise, x = np.random.default_rng(seed).normal(size=count), np.zeros(count)
    for n in range(1, count):
        x[n] = memory * x[n - 1] + noise[n]
    return x


def series():
    """By name: worth few and many values, of all lengths about those at which batches merge, with a drift, with none,
    without scatter, with waves."""
    found = {f"{count} values, memory {memory}": 2.0 + chain(memory, count, count)
             for count in (2, 3, 4, 5, 7, 8, 19, 20, 21, 64, 183, 1000, 1023, 1024, 1025, 2047, 2048, 5000, 70001)
             for memory in (0.0, 0.5, 0.95)}
    found |= {f"{count} values of a slow chain": 50.0 + chain(0.999, count, 1) for count in (300, 3000)}
    found |= {
        f"rising by {rise}": 1.0 + 0.1 * chain(0.5, 600, 3) + np.linspace(0.0, rise, 600) for rise in (0.1, 0.3, 3.0)
    }
    found |= {
        "one": np.ones(1), "zeros": np.zeros(50), "equal": np.full(30, 0.3), "a line": np.linspace(1.0, 2.0, 100),
        "two in turn": 1.0 + 0.1 * (np.arange(101) % 2), "waves": 0.1 + 0.02 * np.sin(0.2 * np.pi * np.arange(201)),
        "bursts": np.exp(chain(0.9, 900, 5)), "small": 1e-9 * (3.0 + chain(0.8, 400, 6)),
    }
    return found


class SameMeans(unittest.TestCase):
    def test_the_same_digits(self):
        verdicts = set()
        for name, values in series().items():
            with self.subTest(name):
                text = "".join(f"{value:.17g}\n" for value in values)
                lines = subprocess.run(
                    [PROGRAM], input=text, capture_output=True, text=True, check=True
                ).stdout.splitlines()
                of_run = [float(line) for line in lines[:6]]
                mean, verdict = thalweg.mean_with_error(values), thalweg.steadiness(values)
                scale = np.max(np.abs(values))   # a drift is a difference of values of this size
                of_reader = [*mean, verdict.drift, verdict.error]
                # 1e-12 of what is compared; 1e-13 of the values themselves covers round-off where it is about nought.
                np.testing.assert_allclose(of_reader, of_run, rtol=1e-12, atol=1e-13 * scale)
                if name not in ("equal", "a line"):   # the sign of their round-off is free
                    self.assertEqual(verdict.sentence(), lines[6])
                verdicts.add(verdict.trend)
        self.assertEqual(len(verdicts), 4)   # every verdict occurs


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]] + sys.argv[2:])
