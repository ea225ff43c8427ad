// Way of a grain from one look to the next, as far as its places and velocities at both tell.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"

#include <cmath>

namespace thalweg::analysis {

struct Look {
  Vec3 position = Vec3::Zero();  // m, of any periodic image
  Vec3 velocity = Vec3::Zero();  // m/s
};

struct Way {
  Vec3 way;     // m, through periodic faces where it went there
  Vec3 boxes;   // 1, along each axis: so many lie between the new place and the one that the way leads to
  double away;  // m: from the place where the mean of both velocities would have taken the grain to where it went
};

// To the periodic image of the new place that lies nearest to where the mean of both velocities would have taken the
// grain in the duration (s), which is right as long as its speed changes by less than a box in that time.
inline Way way_between(const Look& before, const Look& now, double duration, const PeriodicBox& box) {
  const Vec3 expected = 0.5 * duration * (before.velocity + now.velocity);
  Vec3 way = now.position - before.position, boxes = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (!box.periodic[static_cast<std::size_t>(axis)]) continue;
    boxes[axis] = std::round((expected[axis] - way[axis]) / box.size[axis]);
    way[axis] += boxes[axis] * box.size[axis];
  }
  return {way, boxes, (way - expected).norm()};
}

// m: a grain that was farther away than this was taken out meanwhile and put in elsewhere. diameter: m. fastest: m/s,
// the largest speed of any grain at both looks. duration: s.
inline double farthest_away(double diameter, double fastest, double duration) {
  return diameter + 2.0 * fastest * duration;
}

}  // namespace thalweg::analysis
