#!/usr/bin/env python3
"""Commands, options and help of the program, also where MPI cannot start.

Called by ctest: command_line_test.py THALWEG MPIEXEC [unittest arguments]
"""
import os
import sys
import unittest.mock
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
import program
from program import TUMBLING_GRAINS, ProgramTest

# As on the login nodes of some clusters: there is no such way to send messages, for Open MPI and for MPICH's libraries.
NO_MPI = {"OMPI_MCA_pml": "none_such", "FI_PROVIDER": "none_such", "UCX_TLS": "none_such"}


class CommandLine(ProgramTest):
    CASE = TUMBLING_GRAINS

    def test_help_and_version(self):
        self.assertIn("mpirun -n 8 thalweg run", self.run_well("--help").stdout)
        self.assertRegex(self.run_well("--version").stdout, r"^thalweg \d+\.\d+\.\d+")
        self.assertIn("--walltime", self.run_well("run", "--help").stdout)

    def test_wrong_words(self):
        self.assert_refused("fly", words=["fly"])
        self.assert_refused(words=["--help"])
        self.assert_refused("run", words=["CASE.yaml"])
        self.assert_refused("run", self.case, "--layout", "2,x,1", words=["--layout", "2,x,1"])
        self.assert_refused("run", self.case, "--walltime", "soon", words=["--walltime", "soon"])

    def test_on_several_ranks_only_one_speaks(self):
        self.assertEqual(self.run_well("--version", ranks=2).stdout.count("thalweg"), 1)
        self.assertEqual(self.run_well("defaults", ranks=2).stdout.count("system: resolved  "), 1)
        self.assertEqual(self.run_well("check", self.case, ranks=2).stdout.count("tumbling grains"), 1)

    def test_answers_where_mpi_cannot_start(self):
        with unittest.mock.patch.dict(os.environ, NO_MPI):
            self.assertNotEqual(self.thalweg("run", self.case).returncode, 0)   # the only command that needs MPI
            self.run_well("--help")
            self.run_well("defaults", "fluid")
            self.assert_refused("fly", words=["fly"])
            self.assertIn("tumbling grains", self.run_well("check", self.case).stdout)
            self.assert_refused("check", self.case, "--set", "grains.0.diameter=-0.005", words=["grains.0.diameter"])
            self.assert_refused("info", "nowhere", words=["nowhere"])

    def test_reads_a_run_where_mpi_cannot_start(self):
        self.run_well("run", self.case, "--out", "run")
        with_mpi = self.run_well("info", "run").stdout
        placed = ["--set", "grains.0={placement: {file: run/bed.h5}}"]
        bed = self.run_well("check", self.case, *placed).stdout
        with unittest.mock.patch.dict(os.environ, NO_MPI):
            self.assertEqual(self.run_well("info", "run").stdout, with_mpi)
            self.assertIn("grains/position", with_mpi)
            without_speed = [line for line in bed.splitlines() if not line.startswith("time ")]
            again = self.run_well("check", self.case, *placed).stdout
            self.assertEqual([line for line in again.splitlines() if not line.startswith("time ")], without_speed)
            self.assertIn("40 of", again)

    def test_defaults_are_a_case(self):
        text = self.run_well("defaults", "grains").stdout
        (self.folder / "defaults.yaml").write_text(text)
        self.run_well("check", "defaults.yaml")
        self.assert_refused("defaults", "plasma", words=["plasma"])
        section = self.run_well("defaults", "grains.contact").stdout
        self.assertIn("\ncontact: ", section)
        self.assertNotIn("\nrun:", section)


if __name__ == "__main__":
    program.main()
