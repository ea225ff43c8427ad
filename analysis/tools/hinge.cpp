#include "analysis/tools/hinge.hpp"

#include <algorithm>

namespace thalweg::analysis {

namespace {

std::vector<Touch> loaded_touches(const GrainSample& sample) {
  std::vector<Touch> loaded;
  std::copy_if(sample.touches.begin(), sample.touches.end(), std::back_inserter(loaded),
               [](const Touch& touch) { return touch.loaded(); });
  return loaded;
}

bool has(const std::vector<Touch>& touches, const Touch& wanted) {
  return std::any_of(touches.begin(), touches.end(), [&](const Touch& touch) { return touch.is(wanted); });
}

// Contacts at the start that are still loaded in the latest sample in which two of them are.
std::vector<Touch> still_loaded(const GrainRing& ring, std::size_t start, const std::vector<Touch>& at_start) {
  for (std::size_t n = ring.size(); n-- > start;) {
    const std::vector<Touch> now = loaded_touches(ring[n]);
    std::vector<Touch> left;
    for (const Touch& touch : at_start)
      if (has(now, touch)) left.push_back(touch);
    if (left.size() >= 2) return left;
  }
  return at_start;
}

}  // namespace

std::optional<std::size_t> onset_of(const GrainRing& ring, double moving_speed) {
  for (std::size_t n = ring.size(); n-- > 0;)
    if (ring[n][GrainRecord::velocity].norm() <= moving_speed) return n;
  return std::nullopt;
}

std::optional<Hinge> hinge_of(const GrainRing& ring, std::size_t onset, const Vec3& way) {
  std::size_t start = onset;
  std::vector<Touch> at_start = loaded_touches(ring[start]);
  while (at_start.size() < 2 && start > 0) at_start = loaded_touches(ring[--start]);
  if (at_start.size() < 2) return std::nullopt;
  std::vector<Touch> touches = still_loaded(ring, start, at_start);
  const double along = way.x() < 0.0 ? -1.0 : 1.0;
  std::stable_sort(touches.begin(), touches.end(),
                   [along](const Touch& a, const Touch& b) { return along * a.point().x() > along * b.point().x(); });
  const Vec3 centre = ring[start][GrainRecord::position];
  Hinge hinge{{touches[0].partner, touches[1].partner},
              {centre + touches[0].point(), centre + touches[1].point()},
              touches[1].point() - touches[0].point()};
  if (hinge.axis.isZero(0.0)) return std::nullopt;
  hinge.axis.normalize();
  if (hinge.axis.cross(centre - hinge.points[0]).dot(way) < 0.0) hinge.axis = -hinge.axis;
  return hinge;
}

HingeTorques torques_about(const Hinge& hinge, const GrainSample& sample, const Vec3& weight, const Vec3& buoyancy) {
  const Vec3 arm = sample[GrainRecord::position] - hinge.points[0];
  const double couple = hinge.axis.dot(sample[GrainRecord::fluid_couple]);
  const double force = hinge.axis.dot(arm.cross(sample[GrainRecord::fluid_force] - buoyancy));
  return {force + couple, couple, -hinge.axis.dot(arm.cross(weight))};
}

}  // namespace thalweg::analysis
