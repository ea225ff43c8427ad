// The commands that the Python package does, such as `thalweg analyze`.
#pragma once

namespace thalweg::driver {

struct PythonCommand {
  const char* name;
  const char* summary;  // for the help
};

inline constexpr PythonCommand python_commands[] = {
    {"analyze", "Summarise a run's sediment transport between two times (analyze --help)"},
    {"plot", "Draw figures, a film or a picture of runs (plot --help)"},
    {"report", "Describe a run on one page, an HTML file (report --help)"},
    {"sweep", "Run a case with many values of its keys, on all cores (sweep --help)"},
};

// True if the command line begins with one of them.
bool is_python_command(int argc, const char* const* argv);

// Becomes `python -m thalweg analyze ...` with the package that belongs to this program, whose own path is then in the
// environment variable THALWEG_PROGRAM; the interpreter is the one named at configuration, or in the environment
// variable THALWEG_PYTHON. Returns only if it cannot be started, with the exit code, having said why. To be called
// before MPI begins.
int run_python_command(int argc, char** argv);

}  // namespace thalweg::driver
