// Grain, or pair of grains, with the largest value of a quantity over all ranks.
#pragma once

#include "core/base/types.hpp"
#include "core/state/location.hpp"

#include <mpi.h>

#include <optional>

namespace thalweg::dem {

// value: above 0 if there is a candidate. first, second: ids; second is -1 for a single grain. position: m.
struct DistributedArgmax {
  double value = 0.0;
  GlobalId first = -1, second = -1;
  Vec3 position = Vec3::Zero();

  // Takes the candidate if it is larger; among equals the one with the lower ids.
  void consider(const DistributedArgmax& candidate);

  // The largest of all ranks, the same on each; empty if no rank has a candidate. Collective.
  std::optional<Location> over_ranks(MPI_Comm communicator) const;
};

}  // namespace thalweg::dem
