// Cuts between the ranks of a resolved run that balance their work. Results do not depend on cuts.
#pragma once

#include "core/parallel/decomposition.hpp"
#include "dem/clumps/placed_sphere.hpp"
#include "driver/case/case.hpp"

#include <mpi.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace thalweg::driver {

// Partition of the same layout that balances the work of cells, links and sub-steps of grains; the even one if its
// fullest slab exceeds the mean by less than a tenth. grains: each on one rank, positions wrapped. Collective.
Decomposition balanced_partition(const Case& c, const Decomposition& even, std::span<const dem::PlacedSphere> grains,
                                 MPI_Comm communicator);

// Balanced partition for grains spread evenly over the floor if gravity pulls them there, otherwise over the box. Even
// for systems that are not resolved.
Decomposition planned_partition(const Case& c, const Index3& layout);

// Balanced partition of a run that starts from this state; the planned one if the path is empty. Even if the state
// cannot be read: loading it reports why. Collective.
Decomposition partition_of_run(const Case& c, MPI_Comm communicator, const Index3& layout,
                               const std::filesystem::path& state);

// Says where cuts that are not even are; empty where they are.
std::string partition_text(const Case& c, const Decomposition& cuts);

}  // namespace thalweg::driver
