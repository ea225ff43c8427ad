// `thalweg analyze`: the Python package does it.
#pragma once

namespace thalweg::driver {

// Whether the command line begins with `analyze`.
bool is_analyze(int argc, const char* const* argv);

// Becomes `python -m thalweg analyze ...` with the package that belongs to this program; the interpreter is the one
// named at configuration, or in the environment variable THALWEG_PYTHON. Returns only if it cannot be started, with the
// exit code, having said why. To be called before MPI begins.
int analyze(int argc, char** argv);

}  // namespace thalweg::driver
