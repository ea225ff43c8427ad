// The box [0, size) and which of its axes are periodic. All positions in the code are global and unshifted, also those
// of ghosts; differences are taken with the minimum image, so that every rank computes the same bits for a pair.
#pragma once

#include "core/base/types.hpp"

#include <cmath>

namespace thalweg {

// Sides of a box are whole numbers of cells to within this share of them: those of cells of a third of a millimetre are
// not quite the lengths that were asked for.
inline constexpr double whole_number_tolerance = 1e-6;

// True for a point in a box of this size, on its faces, and beyond them by no more than that.
inline bool lies_in_box(const Vec3& point, const Vec3& size) {
  return (point.array() >= 0.0).all() && (point.array() <= (1.0 + whole_number_tolerance) * size.array()).all();
}

struct PeriodicBox {
  Vec3 size = Vec3::Zero();  // in the caller's unit of length
  std::array<bool, 3> periodic{false, false, false};

  // a - b, brought to the nearest periodic image. Needs |a - b| < 3/2 size on periodic axes.
  Vec3 difference(const Vec3& a, const Vec3& b) const {
    Vec3 d = a - b;
    for (int axis = 0; axis < 3; ++axis) {
      if (!periodic[axis]) continue;
      if (d[axis] > 0.5 * size[axis])
        d[axis] -= size[axis];
      else if (d[axis] < -0.5 * size[axis])
        d[axis] += size[axis];
    }
    return d;
  }

  // Image of a point inside [0, size) on the periodic axes; the point must be less than one size outside.
  Vec3 wrapped(Vec3 p) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (!periodic[axis]) continue;
      if (p[axis] >= size[axis])
        p[axis] -= size[axis];
      else if (p[axis] < 0.0)
        p[axis] += size[axis];
      if (p[axis] >= size[axis]) p[axis] = 0.0;  // -1e-20 + size rounds to size
    }
    return p;
  }

  // The same as wrapped(), for a point at any distance.
  Vec3 wrapped_from_afar(Vec3 p) const {
    for (int axis = 0; axis < 3; ++axis)
      if (periodic[axis]) p[axis] -= size[axis] * std::floor(p[axis] / size[axis]);
    return wrapped(p);
  }
};

}  // namespace thalweg
