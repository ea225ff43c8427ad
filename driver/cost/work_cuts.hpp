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

// The same layout with cuts that share the work of cells, links and sub-steps of grains, where the fullest slab of the
// even cuts has more than a tenth more than the mean. grains: each on one of the ranks, positions wrapped. Collective.
Decomposition cuts_by_work(const Case& c, const Decomposition& even, std::span<const dem::PlacedSphere> grains,
                           MPI_Comm communicator);

// Those for grains that lie evenly on the floor where gravity takes them there, and else evenly in the box. Systems
// that are not resolved have even cuts.
Decomposition planned_cuts(const Case& c, const Index3& layout);

// Those of a run that begins from this state; where that is empty, the planned ones. For a state that cannot be read
// they are even: loading it will report why. Collective.
Decomposition cuts_of_run(const Case& c, MPI_Comm communicator, const Index3& layout,
                          const std::filesystem::path& state);

// Says where cuts that are not even are; empty where they are.
std::string cuts_text(const Case& c, const Decomposition& cuts);

}  // namespace thalweg::driver
