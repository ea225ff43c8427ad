// Momentum (lattice units) that the fluid gives to bodies in a step, by the height at which it does.
#pragma once

#include "core/sums/fixed_point.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace thalweg::bodies {

// 2 n_z + 1 sums for the n_z planes of this rank, of solids, of all other bodies, and of the obstacles among these once
// more (BodyOptions): entry h lies h half cells above the block's lower face.
struct MomentumByHeight {
  int solids = 0;                                             // number of solids, which are the first bodies
  std::vector<FixedVec3> on_solids, on_grains, on_obstacles;  // the last: empty where there are none

  MomentumByHeight() = default;
  MomentumByHeight(int solid_count, int planes, bool has_obstacles = false)
      : solids(solid_count), on_solids(static_cast<std::size_t>(2 * planes + 1)), on_grains(on_solids) {
    if (has_obstacles) on_obstacles = on_solids;
  }

  void add(std::ptrdiff_t body, bool is_obstacle, int half_cells, const FixedVec3& momentum) {
    const auto h = static_cast<std::size_t>(half_cells);
    (body < solids ? on_solids : on_grains)[h] += momentum;
    if (is_obstacle) on_obstacles[h] += momentum;
  }
};

}  // namespace thalweg::bodies
