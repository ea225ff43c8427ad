// profiles.h5: the results of observers that are arrays, with their units.
#pragma once

#include "core/state/profile.hpp"

#include <mpi.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::io {

// The profiles of each observer, under its name.
using ProfileGroups = std::vector<std::pair<std::string, std::vector<Profile>>>;

// Writes a new file, or replaces one at once. time: s. One float64 dataset a profile, with its labels
// (labelled_arrays.hpp). Profiles are the same on every rank. Throws RunError on
// every rank. Collective.
void write_profiles(MPI_Comm communicator, const std::filesystem::path& path, double time, const ProfileGroups& groups);

}  // namespace thalweg::io
