#!/usr/bin/env python3
"""The JSON schema that `thalweg defaults --schema` prints agrees with the reader: it accepts every case of the
repository and the documented cases of every system, and what it refuses the reader refuses, too.

Called by ctest: schema_test.py THALWEG MPIEXEC [unittest arguments]
"""
import copy
import json
import sys
from pathlib import Path

import jsonschema
import yaml

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import program
from program import ProgramTest
from thalweg.case_file import read_case

SYSTEMS = ["resolved", "fluid", "grains", "model_fluid", "continuum"]


def keys_in(node, path=()):
    """Paths of all keys of a case."""
    children = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in children:
        if isinstance(node, dict):
            yield (*path, key)
        yield from keys_in(value, (*path, key))


def at(node, path):
    for key in path:
        node = node[key]
    return node


class Schema(ProgramTest):
    def setUp(self):
        super().setUp()
        self.schema = json.loads(self.run_well("defaults", "--schema").stdout)
        jsonschema.Draft7Validator.check_schema(self.schema)
        self.validator = jsonschema.Draft7Validator(self.schema)

    def refusals(self, case):
        return [f"{list(error.absolute_path)}: {error.message[:200]}" for error in self.validator.iter_errors(case)]

    def test_it_accepts_every_case(self):
        paths = [
            path for folder in ("cases", "benchmarks/validation") for path in sorted((ROOT / folder).rglob("*.yaml"))
        ]
        accepted = 0
        for path in paths:
            case = read_case(path)
            if isinstance(case, dict) and "system" in case:
                with self.subTest(path=str(path.relative_to(ROOT))):
                    self.assertEqual(self.refusals(case), [])
                accepted += 1
        self.assertGreater(accepted, 50)

    def test_it_accepts_the_documented_cases(self):
        for system in SYSTEMS:
            self.case.write_text(self.run_well("defaults", system).stdout)
            with self.subTest(system=system):
                self.assertEqual(self.refusals(read_case(self.case)), [])

    def test_the_reader_refuses_what_it_refuses(self):
        """Each key of a documented case with another name, or with a text in place of what it is."""
        for system in ("resolved", "continuum"):
            text = self.run_well("defaults", system).stdout
            self.case.write_text(text)
            case = read_case(self.case)
            paths = [path for path in keys_in(case) if path != ("system",)]
            for path in paths[::5]:
                for change in ("name", "value"):
                    changed = copy.deepcopy(case)
                    holder = at(changed, path[:-1])
                    value = holder[path[-1]]
                    if change == "name":
                        del holder[path[-1]]
                        holder["no_such_key"] = value
                    else:
                        holder[path[-1]] = {"no_such_key": 1}
                    with self.subTest(system=system, path=path, change=change):
                        self.assertNotEqual(self.refusals(changed), [])
                        self.case.write_text(yaml.safe_dump(changed))
                        self.assertEqual(self.thalweg("check", self.case).returncode, 2)

    def test_ranges_and_words(self):
        base = yaml.safe_load((ROOT / "cases/quickstart/case.yaml").read_text())
        for path, value in [
            (("domain", "spacing"), -1.0), (("fluid", "collision"), "brk"), (("fluid", "density"), "water"),
            (("grains", 0, "count"), 1.5), (("domain", "boundaries", "y"), "wet"), (("contact", "restitution"), 2),
        ]:
            changed = copy.deepcopy(base)
            at(changed, path[:-1])[path[-1]] = value
            with self.subTest(path=path):
                self.assertNotEqual(self.refusals(changed), [])
                self.case.write_text(yaml.safe_dump(changed))
                self.assertEqual(self.thalweg("check", self.case).returncode, 2)
        self.assertEqual(self.refusals(base), [])


program.main()
