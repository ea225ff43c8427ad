// Files that a case reads: beds, surfaces, other runs.
#pragma once

#include "driver/case/case.hpp"

#include <mpi.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::driver {

// Keys and paths of the files of a case.
std::vector<std::pair<std::string, std::string>> inputs_by_key(const Case& c);

// A path relative to a folder that exists, so that both can be moved together. One that has nothing in common with the
// path of the folder but the root stays absolute.
std::string path_from(const std::filesystem::path& folder, const std::string& path);

// The case with such paths.
Case with_paths_from(const std::filesystem::path& folder, Case c);

// The case with the checkpoint that `initial.from` finds now in place of a run folder, which may get later ones; a path
// that leads to none stays. Collective.
Case with_checkpoints_found(Case c, MPI_Comm communicator);

// The case with `initial.from` of the case.yaml (its text) in a run folder: where a run that goes on came from.
Case with_sources_of(const std::filesystem::path& folder, const std::string& yaml, Case c);

}  // namespace thalweg::driver
