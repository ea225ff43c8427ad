"""check_includes.py accepts correct dependencies and reports every kind of violation, each planted alone."""
import pathlib
import tempfile
import unittest

import check_includes

CORRECT = {
    "core/base/types.hpp": "#pragma once\n#include <vector>\n",
    "core/base/error.hpp": '#include "core/base/types.hpp"\n',
    "core/CMakeLists.txt": "thalweg_library(core types.cpp)\n",
    "CMakeLists.txt": (
        "foreach(module core lbm bodies dem beds model_fluid coupling continuum analysis io loop driver)\n"
    ),
    "cmake/install.cmake": "foreach(module core lbm bodies dem beds model_fluid coupling continuum analysis loop io)\n",
    "core/sums/wide.hpp": '#include "core/base/types.hpp"\n',
    "core/whole.hpp": '#include "core/sums/wide.hpp"\n',
    "lbm/collision/sweep.hpp": '#include "core/base/types.hpp"\n',
    "dem/motion/grain_store.hpp": '#include "core/base/error.hpp"\n',
    "dem/CMakeLists.txt": "thalweg_library(dem a.cpp)\ntarget_link_libraries(thalweg_dem PUBLIC thalweg::core)\n",
    "coupling/links.cpp": '#include "dem/motion/grain_store.hpp"\n#include "lbm/collision/sweep.hpp"\n',
    "analysis/rate.hpp": '#include "core/base/types.hpp"\n',
    "io/hdf5/hdf5_handle.hpp": "#include <hdf5.h>\n",
    "io/hdf5_arrays.hpp": '#include "io/hdf5/hdf5_handle.hpp"\n',
    "io/archive.hpp": '#include "core/base/types.hpp"\n',
    "io/archive.cpp": '#include "io/archive.hpp"\n#include "io/hdf5_arrays.hpp"\n',
    "io/vtk_series.cpp": '#include "core/base/types.hpp"\n#include <vtkImageData.h>\n#include <hdf5.h>\n',
    "io/text/yaml_document.hpp": "#include <yaml-cpp/yaml.h>\n",
    "driver/main.cpp": '#include "lbm/collision/sweep.hpp"\n#include <yaml-cpp/yaml.h>\n',
    "driver/case/case.hpp": '#include "analysis/rate.hpp"\n#include "io/archive.hpp"\n',
    "tests/driver/case/case_test.cpp": '#include "driver/case/case.hpp"\n',
    "tests/io/vtk_test.cpp": "#include <vtkImageData.h>\n",
    "build/release/lbm/generated.hpp": '#include "dem/motion/grain_store.hpp"\n',  # not ours to check
}

# (file, text, a piece of the complaint)
PLANTED = [
    ("core/bad.hpp", '#include "lbm/collision/sweep.hpp"\n', "core must not include"),
    ("lbm/bad.cpp", '#include "dem/motion/grain_store.hpp"\n', "lbm must not include"),
    ("bodies/bad.cpp", '#include "dem/motion/grain_store.hpp"\n', "bodies must not include"),
    ("dem/bad.cpp", '  #  include "lbm/collision/sweep.hpp"\n', "dem must not include"),
    ("analysis/bad.cpp", '#include "dem/motion/grain_store.hpp"\n', "analysis must not include"),
    ("io/bad.cpp", '#include "analysis/rate.hpp"\n', "io must not include"),
    ("coupling/bad.cpp", '#include "analysis/rate.hpp"\n', "coupling must not include"),
    ("coupling/bad.hpp", '#include "driver/case/case.hpp"\n', "coupling must not include"),
    ("loop/bad.hpp", '#include "io/archive.hpp"\n', "loop must not include"),
    ("tests/lbm/bad_test.cpp", '#include "driver/case/case.hpp"\n', "include the driver"),
    ("dem/bad.cpp", "#include <vtkPolyData.h>\n", "belongs in io alone"),
    ("core/bad.hpp", "#include <hdf5.h>\n", "belongs in io alone"),
    ("driver/bad.cpp", '#include "io/hdf5/hdf5_handle.hpp"\n', "private to io"),
    ("driver/bad.cpp", '#include "io/hdf5_arrays.hpp"\n', "private to io"),
    ("tests/driver/bad_test.cpp", '#include "io/hdf5_arrays.hpp"\n', "private to io"),
    ("driver/bad.cpp", "#include <H5Cpp.h>\n", "belongs in io alone"),
    ("analysis/bad.cpp", "#include <yaml-cpp/yaml.h>\n", "belongs in io and driver alone"),
    ("lbm/bad.cpp", '#include "sweep.hpp"\n', "not written from the repository root"),
    ("lbm/bad.cpp", '#include "../core/base/types.hpp"\n', "not written from the repository root"),
    ("lbm/bad.cpp", '#include "core/gone.hpp"\n', "does not exist"),
    ("lbm/bad.cpp", "#include <dem/motion/grain_store.hpp>\n", "is a header of this repository"),
    ("lbm/CMakeLists.txt", "target_link_libraries(thalweg_lbm PUBLIC thalweg::dem)\n", "must not link thalweg::dem"),
    (
        "CMakeLists.txt",
        "foreach(module core lbm bodies dem beds model_fluid coupling continuum analysis io driver)\n",
        "leaves out loop",
    ),
    (
        "CMakeLists.txt",
        "foreach(module core lbm bodies dem beds model_fluid coupling continuum analysis io loop waves driver)\n",
        "does not know what the module waves",
    ),
    (
        "cmake/install.cmake", "foreach(module core lbm bodies dem beds model_fluid coupling analysis loop io)\n",
        "leaves out continuum",
    ),
    ("core/base/bad.hpp", '#include "core/sums/wide.hpp"\n', "comes after it"),
    ("core/sums/bad.hpp", '#include "core/whole.hpp"\n', "comes after it"),
    ("docs/bad.md", "One day. " + "TO" + "DO: say more.\n", "finish it"),
    ("lbm/bad.cpp", "// FIX" + "ME\n", "finish it"),
]


class CheckIncludes(unittest.TestCase):
    def violations(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            return [(relative.as_posix(), line, what) for relative, line, what in check_includes.violations(root)]

    def test_correct_dependencies_pass(self):
        self.assertEqual(self.violations(CORRECT), [])

    def test_every_planted_violation_is_seen_alone_and_in_its_place(self):
        for name, text, complaint in PLANTED:
            with self.subTest(file=name, text=text):
                found = self.violations(CORRECT | {name: "\n" + text})
                self.assertEqual(len(found), 1, found)
                self.assertEqual(found[0][:2], (name, 2))
                self.assertIn(complaint, found[0][2])

    def test_a_folder_that_is_no_room_is_seen(self):
        for name, folder in (("core/odds/bad.hpp", "core/odds"), ("core/base/deep/bad.hpp", "core/base/deep")):
            with self.subTest(file=name):
                (found,) = self.violations(CORRECT | {name: "#pragma once\n"})
                self.assertEqual(found[0], folder)
                self.assertIn("does not know this room", found[2])

    def test_a_room_with_too_many_files_is_seen(self):
        most = check_includes.MOST_FILES - 2   # two are there
        full = CORRECT | {f"core/base/more_{n}.hpp": "#pragma once\n" for n in range(most)}
        self.assertEqual(self.violations(full), [])
        (found,) = self.violations(full | {"core/base/one_more.hpp": "#pragma once\n"})
        self.assertIn("no room has more than", found[2])


if __name__ == "__main__":
    unittest.main()
