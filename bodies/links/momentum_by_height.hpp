// Momentum (lattice units) that the fluid gives to bodies in a step, by the height at which it does.
#pragma once

#include "core/sums/fixed_point.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace thalweg::bodies {

// 2 n_z + 1 sums for the n_z planes of this rank, of solids and of all other bodies: entry h lies h half cells above
// the block's lower face.
struct MomentumByHeight {
  int solids = 0;  // number of solids, which are the first bodies
  std::vector<FixedVec3> on_solids, on_grains;

  MomentumByHeight() = default;
  MomentumByHeight(int solid_count, int planes)
      : solids(solid_count), on_solids(static_cast<std::size_t>(2 * planes + 1)), on_grains(on_solids) {}

  FixedVec3& at(std::ptrdiff_t body, int half_cells) {
    return (body < solids ? on_solids : on_grains)[static_cast<std::size_t>(half_cells)];
  }
};

}  // namespace thalweg::bodies
