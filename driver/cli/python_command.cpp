#include "driver/cli/python_command.hpp"

#include "driver/cost/cores.hpp"
#include "driver/cost/memory.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

namespace thalweg::driver {

namespace fs = std::filesystem;

// Empty if the system does not tell.
static fs::path this_program() {
  std::error_code unknown;
  return fs::read_symlink("/proc/self/exe", unknown);
}

// The Python package of this program: that of the source tree where it has not left its build folder, else
// PREFIX/share/thalweg/python beside PREFIX/bin.
static fs::path python_package(const fs::path& program) {
  std::error_code unknown;
  if (program.empty() || fs::equivalent(program, THALWEG_BUILT_PROGRAM, unknown)) return THALWEG_PYTHON_PACKAGE;
  return program.parent_path().parent_path() / "share/thalweg/python";
}

bool is_python_command(int argc, const char* const* argv) {
  return argc > 1 && std::any_of(std::begin(python_commands), std::end(python_commands),
                                 [&](const PythonCommand& known) { return std::strcmp(argv[1], known.name) == 0; });
}

int run_python_command(int argc, char** argv) {
  const fs::path program = this_program();
  const char* named = std::getenv("THALWEG_PYTHON");
  std::string interpreter = named ? named : THALWEG_PYTHON;
  std::string path = python_package(program);
  std::error_code unknown;
  if (!fs::exists(path + "/thalweg", unknown)) {
    std::fprintf(stderr,
                 "thalweg: %s needs the program's Python package, and there is none in %s; install the program with "
                 "cmake --install, or link to bin/thalweg of the installation instead of copying it.\n",
                 argv[1], path.c_str());
    return 2;
  }
  if (const char* more = std::getenv("PYTHONPATH"); more && *more) path.append(":").append(more);
  setenv("PYTHONPATH", path.c_str(), 1);
  if (!program.empty()) setenv("THALWEG_PROGRAM", program.c_str(), 1);
  // Resources available to the runs of a sweep (sweep/machine.py).
  setenv("THALWEG_CORES", std::to_string(available_cores()).c_str(), 1);
  setenv("THALWEG_MEMORY", fmt::format("{:.0f}", free_memory_for_runs()).c_str(), 1);
  std::string module_flag = "-m", module = "thalweg";
  std::vector<char*> arguments = {interpreter.data(), module_flag.data(), module.data()};
  arguments.insert(arguments.end(), argv + 1, argv + argc);
  arguments.push_back(nullptr);
  execvp(interpreter.c_str(), arguments.data());
  std::fprintf(
      stderr,
      "thalweg: %s needs Python, and %s cannot be started (%s); set THALWEG_PYTHON to an interpreter with numpy, h5py "
      "and PyYAML.\n",
      argv[1], interpreter.c_str(), std::strerror(errno));
  return 2;
}

}  // namespace thalweg::driver
