// Cells and directions of the lattice as vectors, in cells.
#pragma once

#include "core/base/types.hpp"
#include "lbm/lattice/d3q19.hpp"

namespace thalweg::bodies {

inline Vec3 centre_of(const Index3& cell) { return {cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5}; }

inline Vec3 velocity_of(int direction) {
  const int(&c)[3] = lbm::D3Q19::c[direction];
  return {double(c[0]), double(c[1]), double(c[2])};
}

}  // namespace thalweg::bodies
