// The beds that the populations of a case began with, in its checkpoints: a run goes on without the bed files.
#pragma once

#include "core/base/archive.hpp"
#include "driver/case/case.hpp"
#include "driver/input/bed_placement.hpp"

#include <mpi.h>

#include <filesystem>
#include <vector>

namespace thalweg::driver {

// Saves the rows of each population that was placed by a file (sizes, densities, positions and clumps, without
// velocities), in datasets below bed_<number of the population>. Collective.
void save_beds(ArchiveWriter& archive, MPI_Comm communicator, const Case& c);

// Beds of the first undamaged checkpoint; none if it was written without.
KnownBeds beds_of(std::vector<std::filesystem::path> checkpoints);

}  // namespace thalweg::driver
