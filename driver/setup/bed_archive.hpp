// The beds that the populations of a case began with, in its checkpoints: a run goes on without the bed files.
#pragma once

#include "core/base/archive.hpp"
#include "driver/case/case.hpp"
#include "driver/input/bed_placement.hpp"

#include <mpi.h>

#include <filesystem>
#include <vector>

namespace thalweg::driver {

// Of every population placed by a file the rows that were taken from it (sizes, densities, places and clumps, without
// velocities), in datasets below bed_<number of the population>. Collective.
void save_beds(ArchiveWriter& archive, MPI_Comm communicator, const Case& c);

// Those of the first of these checkpoints that is not damaged; none of one that was written without.
KnownBeds beds_of(std::vector<std::filesystem::path> checkpoints);

}  // namespace thalweg::driver
