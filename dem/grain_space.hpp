// Space in which grains may be: the box, extended or reduced by walls that have moved.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "dem/motion/walls.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace thalweg::dem {

class GrainSpace {
public:
  // walls: where they are now.
  GrainSpace(const PeriodicBox& box, std::span<const Plane> walls) : box_(box), upper_(box.size) {
    for (const Plane& wall : walls) {
      if (wall.plate) {
        plates_.push_back(wall);
        continue;
      }
      whole_.push_back(wall);
      for (int axis = 0; axis < 3; ++axis) {  // a face that has moved outwards
        if (wall.normal == Vec3::Unit(axis)) lower_[axis] = std::min(lower_[axis], wall.point[axis]);
        if (wall.normal == -Vec3::Unit(axis)) upper_[axis] = std::max(upper_[axis], wall.point[axis]);
      }
    }
  }

  const Vec3& lower() const { return lower_; }  // m
  const Vec3& upper() const { return upper_; }

  // True if the position is nowhere beyond an end of the space by more than the radius (m).
  bool holds(const Vec3& position, double radius) const {
    for (int axis = 0; axis < 3; ++axis)
      if (!box_.periodic[axis] && (position[axis] < lower_[axis] - radius || position[axis] > upper_[axis] + radius))
        return false;
    return true;
  }

  // True if the position is behind a wall by more than the radius (m): a wall has moved across it, or it has gone round
  // a periodic face behind a wall across that axis, which has no images.
  bool beyond_wall(const Vec3& position, double radius) const {
    return std::any_of(whole_.begin(), whole_.end(),
                       [&](const Plane& wall) { return (position - wall.point).dot(wall.normal) < -radius; });
  }

  // True if the centre is nearer to a plate than half its radius, so that it might come out on the other side.
  bool deep_in_plate(const Vec3& position, double radius) const {
    return std::any_of(plates_.begin(), plates_.end(),
                       [&](const Plane& plate) { return plate.seen_from(position, box_).distance < 0.5 * radius; });
  }

private:
  PeriodicBox box_;
  Vec3 lower_ = Vec3::Zero(), upper_;
  std::vector<Plane> whole_, plates_;
};

}  // namespace thalweg::dem
