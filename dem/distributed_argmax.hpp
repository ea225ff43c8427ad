// The grain, or the pair of grains, with the largest value of something: looked for on every rank, agreed by all.
#pragma once

#include "core/base/types.hpp"
#include "core/state/location.hpp"

#include <mpi.h>

#include <optional>

namespace thalweg::dem {

// value: above 0 where there is anything. first, second: ids, second -1 where it is one grain. position: m.
struct DistributedArgmax {
  double value = 0.0;
  GlobalId first = -1, second = -1;
  Vec3 position = Vec3::Zero();

  // Takes the candidate if it is larger; of equals the one with the lower ids.
  void consider(const DistributedArgmax& candidate);

  // That of all ranks, the same on each; empty where no rank has any. Collective.
  std::optional<Location> over_ranks(MPI_Comm communicator) const;
};

}  // namespace thalweg::dem
