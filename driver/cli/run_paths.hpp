// Paths of a run: its output folder and the checkpoints it starts from.
#pragma once

#include "driver/cli/command_line.hpp"
#include "io/folder/run_folder.hpp"

#include <mpi.h>

#include <filesystem>
#include <vector>

namespace thalweg::driver {

struct RunPaths {
  std::vector<std::filesystem::path> checkpoints;  // to go on from, the best first; none: from the start
  std::filesystem::path origin;                    // the run folder they lie in; empty: none
  io::RunFolder folder;
  bool same_folder = false;  // the checkpoints are the folder's own: its series go on
};

// The folder of a run without --restart: --out, or `run` beside the case.
std::filesystem::path folder_without_restart(const Command& command);

// The paths found by the first rank. Throws InputError if --restart names no checkpoint. Collective.
RunPaths paths_of(const Command& command, MPI_Comm communicator);

}  // namespace thalweg::driver
