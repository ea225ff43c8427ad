#!/usr/bin/env python3
"""Checkpoints that are damaged: a run goes on from the newest that is whole, to the same bits, and says so.

Called by ctest: damage_run_test.py THALWEG MPIEXEC [unittest arguments]
"""
import shutil
import sys
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import program
from program import SLIDING_GRAINS, ProgramTest


def flip(at):
    """A bit of the byte at a share of the file's length."""
    def damage(path):
        text = bytearray(path.read_bytes())
        text[int(at * len(text))] ^= 4
        path.write_bytes(text)
    return damage


def cut(length):
    return lambda path: path.write_bytes(path.read_bytes()[:int(length * path.stat().st_size)])


def lost_block(start):
    """Zeros in place of a kilobyte, as a file system leaves them after a crash; of the first from there on that is not
    all zeros, as room is that HDF5 has not used."""
    def damage(path):
        text = bytearray(path.read_bytes())
        begin = next(n for n in range(int(start * len(text)), len(text)) if any(text[n:n + 64]))
        text[begin:begin + 1024] = bytes(len(text[begin:begin + 1024]))
        path.write_bytes(text)
    return damage


def exchanged(dataset):
    """Two values of a dataset have changed places."""
    def damage(path):
        with h5py.File(path, "r+") as file:
            values = file[dataset][()]
            values[[0, 1]] = values[[1, 0]]
            file[dataset][...] = values
    return damage


def without_checksum(dataset):
    """As another program would write it."""
    def damage(path):
        with h5py.File(path, "r+") as file:
            del file[dataset].attrs["checksum"]
    return damage


class DamageRun(ProgramTest):
    CASE = SLIDING_GRAINS + """
run: {until: 0.2, time_step: 1.0e-5}
output: {series: {every: 0.01}, checkpoint: {every: 0.05, keep: 2}}
"""

    # What has happened to the newest checkpoint.
    DAMAGE = {
        "a bit of the positions": flip(0.2), "a bit early": flip(0.05), "a bit in the middle": flip(0.5),
        "a bit late": flip(0.8), "the signature": flip(0.0), "all but the last byte": cut(0.9999),
        "three quarters": cut(0.75), "a quarter": cut(0.25), "a few bytes": cut(0.002), "nothing": cut(0.0),
        "zeros at the beginning": lost_block(0.0), "zeros in the middle": lost_block(0.4),
        "zeros late": lost_block(0.7), "two grains exchanged": exchanged("grains/position"),
        "two velocities exchanged": exchanged("grains/velocity"),
        "positions without a checksum": without_checksum("grains/position"),
        "a text": lambda path: path.write_text("state"),
    }

    # What has happened to the file that names the newest one.
    NAMES = {"no name": lambda path: path.unlink(), "an empty name": lambda path: path.write_text(""),
             "a name of nothing": lambda path: path.write_text("step_7.h5\n")}

    def setUp(self):
        super().setUp()
        self.run_well("run", self.case, "--out", "whole")
        self.run_well("run", self.case, "--out", "half", "--until", "0.1")

    def copy(self, name):
        folder = self.folder / name.replace(" ", "_")
        shutil.copytree(self.folder / "half", folder)
        return folder

    def test_goes_on_from_the_one_before(self):
        for name, damage in self.DAMAGE.items():
            with self.subTest(damage=name):
                folder = self.copy(name)
                newest = self.last_checkpoint(folder)
                damage(newest)
                said = self.run_well("run", self.case, "--restart", folder).stdout
                self.assertIn("warning: ", said)
                self.assertIn(f"{newest.name}: ", said)
                self.assertIn("damaged", said)
                self.assertIn("at 0.05 s", said)
                self.assert_same_bed("whole", folder.name)
                self.assertEqual(list(self.series("whole")["time"]), list(self.series(folder.name)["time"]))

    def test_on_two_ranks_too(self):
        folder = self.copy("ranks")
        flip(0.2)(self.last_checkpoint(folder))
        said = self.run_well("run", self.case, "--restart", folder, ranks=2).stdout
        self.assertIn("at 0.05 s", said)
        self.assert_same_bed("whole", folder.name)

    def test_means_of_another_interval_begin_at_the_older_one(self):
        def measured(every):
            return ["--set", f"analysis={{bed_surface: {{every: {every}}}, grain_profiles: {{every: 0.001}}}}"]
        folder = self.folder / "measured"
        self.run_well("run", self.case, "--out", folder, "--until", "0.05", *measured(0.02))
        shutil.copytree(folder, self.folder / "straight")
        self.run_well("run", self.case, "--out", "straight", "--restart", "straight", *measured(0.01))
        self.run_well("run", self.case, "--out", folder, "--restart", folder, "--until", "0.1", *measured(0.01),
                      "--set", "contact.friction=0.05")   # so that the course that is left is another one
        exchanged("grain_profiles/sums")(self.last_checkpoint(folder))   # read after the sums of the surface
        said = self.run_well("run", self.case, "--out", folder, "--restart", folder, *measured(0.01)).stdout
        self.assertIn("at 0.05 s", said)
        known, straight = self.summary(folder), self.summary("straight")
        self.assertEqual(known["bed_surface"]["measurements"], 15)
        for section in ("bed_surface", "grain_profiles"):
            self.assertEqual(known[section], straight[section])

    def test_a_damaged_name_costs_nothing(self):
        for name, damage in self.NAMES.items():
            with self.subTest(damage=name):
                folder = self.copy(name)
                damage(folder / "checkpoints/latest")
                said = self.run_well("run", self.case, "--restart", folder).stdout
                self.assertIn("at 0.1 s", said)
                self.assert_same_bed("whole", folder.name)

    def test_a_checkpoint_that_is_named_is_refused(self):
        folder = self.copy("named")
        newest = self.last_checkpoint(folder)
        flip(0.2)(newest)
        self.assert_refused("run", self.case, "--restart", newest, "--out", "other",
                            words=[newest.name, "damaged", "take an earlier checkpoint"])
        self.assert_refused("run", self.case, "--restart", newest, "--out", "other", ranks=2,
                            words=[newest.name, "damaged", "take an earlier checkpoint"])

    def test_nothing_whole_is_a_refusal(self):
        folder = self.copy("all")
        for path in (folder / "checkpoints").glob("step_*.h5"):
            flip(0.2)(path)
        self.assert_refused("run", self.case, "--restart", folder, words=["damaged"])

    def test_a_later_format_is_refused(self):
        folder = self.copy("later")
        newest = self.last_checkpoint(folder)
        with h5py.File(newest, "r+") as file:
            file["run"].attrs.modify("format", 77)
        self.assert_refused("run", self.case, "--restart", folder, words=["format 77", "continue with that version"])

    def test_leftovers_of_killed_writes_go(self):
        folder = self.copy("leftover")
        (folder / "checkpoints/step_10003.h5.partial").write_bytes(bytes(1000))
        self.run_well("run", self.case, "--restart", folder)
        self.assertEqual([path.name for path in (folder / "checkpoints").iterdir() if "partial" in path.name], [])

    def test_attributes_of_several_values_are_refused(self):
        """As another program may write them, where one number belongs."""
        self.run_well("run", self.case, "--until", "0.05")
        path = self.last_checkpoint("run")
        with h5py.File(path, "r+") as file:
            for holder in (file, *(item for item in file.values() if isinstance(item, h5py.Group))):
                for name, value in list(holder.attrs.items()):
                    if numpy.issubdtype(getattr(value, "dtype", object), numpy.number):
                        holder.attrs[name] = numpy.full(1000, value)
        self.assert_refused("run", self.case, "--restart", path, "--out", "more", words=["is not a single value"])


if __name__ == "__main__":
    program.main()
