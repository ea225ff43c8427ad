"""The packaging files say the same of versions and needs as the build: packaging_test.py THALWEG"""
import ast
import json
import re
import subprocess
import sys
import tomllib
import unittest
from pathlib import Path

import yaml

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else None
ROOT = Path(__file__).resolve().parents[2]
DEBIAN = Path("/etc/debian_version").read_text().strip() if Path("/etc/debian_version").exists() else ""


def text(name):
    return (ROOT / name).read_text(encoding="utf-8")


class Packaging(unittest.TestCase):
    def test_one_version_everywhere(self):
        version = re.search(r"project\(thalweg VERSION (\S+)", text("CMakeLists.txt"))[1]
        said = {
            "CITATION.cff": str(yaml.safe_load(text("CITATION.cff"))["version"]),
            "CITATION.bib": re.search(r"version = \{(.*?)\}", text("CITATION.bib"))[1],
            "codemeta.json": json.loads(text("codemeta.json"))["version"],
            "python/pyproject.toml": tomllib.loads(text("python/pyproject.toml"))["project"]["version"],
            "packaging/spack": re.search(r'version\("(.*?)"\)', text("packaging/spack/packages/thalweg/package.py"))[1],
            "packaging/modulefile": re.search(r"Thalweg (\d\S*),", text("packaging/modulefile"))[1],
            "CHANGELOG.md": re.search(r"^## (\S+)", text("CHANGELOG.md"), re.MULTILINE)[1],
        }
        self.assertEqual(said, dict.fromkeys(said, version))

    def test_licence_and_authors_agree(self):
        citation, meta = yaml.safe_load(text("CITATION.cff")), json.loads(text("codemeta.json"))
        self.assertEqual(meta["license"], f"https://spdx.org/licenses/{citation['license']}")
        self.assertEqual(
            [author["name"] for author in meta["author"]], [author["name"] for author in citation["authors"]]
        )
        self.assertEqual(meta["keywords"], citation["keywords"])
        self.assertEqual(
            tomllib.loads(text("python/pyproject.toml"))["project"]["license"]["text"], citation["license"]
        )

    def test_continuous_integration_calls_the_script(self):
        jobs = yaml.safe_load(text(".github/workflows/ci.yml"))["jobs"]
        self.assertEqual(jobs["test"]["steps"][-1], {"run": ".ci/run"})
        self.assertEqual(yaml.safe_load(text(".gitlab-ci.yml"))["test"]["script"], [".ci/run"])
        self.assertTrue((ROOT / ".ci/run").stat().st_mode & 0o111)

    def test_minimum_versions_are_those_of_the_build(self):
        """What cmake/dependencies.cmake asks for, in the spellings of conda and Spack."""
        build = dict(re.findall(r"find_package\((\S+) (\d[\d.]*)", text("cmake/dependencies.cmake")))
        build |= {"cmake": re.search(r"VERSION (\S+)\)", text("CMakeLists.txt"))[1],
                  "SUNDIALS": re.search(r"SUNDIALS_VERSION VERSION_LESS (\S+)\)", text("cmake/dependencies.cmake"))[1]}
        conda = {
            words.split()[0]: re.search(r">=([\d.]+)", words)[1]
            for words in yaml.safe_load(text("packaging/environment.yml"))["dependencies"]
            if ">=" in words
        }
        spack = dict(
            re.findall(r'depends_on\("([a-z0-9-]+)@([\d.]+):', text("packaging/spack/packages/thalweg/package.py"))
        )
        for name, other in (
            ("cmake", "cmake"), ("Eigen3", "eigen"), ("HDF5", "hdf5"), ("SUNDIALS", "sundials"),
            ("yaml-cpp", "yaml-cpp"), ("fmt", "fmt"), ("CLI11", "cli11"), ("VTK", "vtk"),
        ):
            for packages in (conda, spack):
                self.assertEqual(float(packages[other]), float(build[name]), other)
        python = tomllib.loads(text("python/pyproject.toml"))["project"]["requires-python"].removeprefix(">=")
        self.assertEqual({conda["python"], spack["python"]}, {python})

    def test_the_python_packages_are_all_named(self):
        project = tomllib.loads(text("python/pyproject.toml"))["project"]
        wanted = {*project["dependencies"], *project["optional-dependencies"]["figures"]}
        conda = {
            words.split()[0].removesuffix("-base")
            for words in yaml.safe_load(text("packaging/environment.yml"))["dependencies"]
        }
        spack = set(re.findall(r'depends_on\("py-([a-z0-9]+)"', text("packaging/spack/packages/thalweg/package.py")))
        debian = {
            name.replace("yaml", "pyyaml") for name in re.findall(r"python3-(\w+)", text("packaging/Containerfile"))
        }
        for there in (conda, spack, debian):
            self.assertLessEqual(wanted, there)

    def test_the_package_of_spack_is_python(self):
        tree = ast.parse(text("packaging/spack/packages/thalweg/package.py"))
        self.assertEqual([node.name for node in tree.body if isinstance(node, ast.ClassDef)], ["Thalweg"])

    @unittest.skipUnless(DEBIAN.startswith("12") and PROGRAM, "needs Debian 12, whose packages the image has")
    def test_the_image_has_what_the_program_is_linked_with(self):
        needed = re.findall(
            r"\(NEEDED\).*\[(.*?)\]",
            subprocess.run(["readelf", "-d", PROGRAM], check=True, capture_output=True, text=True).stdout,
        )
        paths = dict(
            re.findall(
                r"(\S+) => (/\S+)", subprocess.run(["ldd", PROGRAM], check=True, capture_output=True, text=True).stdout
            )
        )
        owners = set()
        for name in needed:
            if name in paths:
                said = subprocess.run(
                    ["dpkg", "-S", Path(paths[name]).resolve()], capture_output=True, text=True
                ).stdout
                owners.add(said.partition(":")[0])
        owners -= {
            "libc6", "libstdc++6", "libgcc-s1", "libopenmpi3", "libssl3", "", "libasan8", "libubsan1",
        }  # libopenmpi3: of openmpi-bin
        self.assertGreater(len(owners), 3)
        self.assertLessEqual(owners, set(text("packaging/Containerfile").split()))


if __name__ == "__main__":
    unittest.main()
