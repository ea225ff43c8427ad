// The minimum image of core/geometry/periodic_box.hpp (same bits), all axes at once and with their rules turned into
// numbers: for loops over many pairs.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "dem/motion/packed_grain_state.hpp"

#include <limits>

namespace thalweg::dem {

class MinimumImage {
public:
  explicit MinimumImage(const PeriodicBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
      size_[axis] = box.periodic[axis] ? box.size[axis] : 0.0;
      half_[axis] = box.periodic[axis] ? 0.5 * box.size[axis] : std::numeric_limits<double>::infinity();
    }
  }
  Double4 operator()(const Double4& d) const { return d > half_ ? d - size_ : d < -half_ ? d + size_ : d; }

private:
  Double4 size_{}, half_{0.0, 0.0, 0.0, std::numeric_limits<double>::infinity()};
};

}  // namespace thalweg::dem
