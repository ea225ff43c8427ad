// `thalweg analyze` and `thalweg sweep`: the Python package does them.
#pragma once

namespace thalweg::driver {

// True if the command line begins with one of them.
bool is_python_command(int argc, const char* const* argv);

// Becomes `python -m thalweg analyze ...` with the package that belongs to this program, whose own path is then in the
// environment variable THALWEG_PROGRAM; the interpreter is the one named at configuration, or in the environment
// variable THALWEG_PYTHON. Returns only if it cannot be started, with the exit code, having said why. To be called
// before MPI begins.
int run_python_command(int argc, char** argv);

}  // namespace thalweg::driver
