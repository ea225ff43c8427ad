// Spheres sorted into the cells of a grid as they arrive, to find whether one overlaps any of them. Cells without
// spheres take no memory.
#pragma once

#include "beds/packing/packing.hpp"
#include "core/geometry/periodic_box.hpp"
#include "dem/clumps/placed_sphere.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace thalweg::beds {

class SphereCells {
public:
  // largest_radius: m, of all spheres that come or are asked about.
  SphereCells(const PeriodicBox& box, double largest_radius) : box_(box) {
    for (int axis = 0; axis < 3; ++axis)
      count_[axis] = std::max<std::int64_t>(1, static_cast<std::int64_t>(box.size[axis] / (2.0 * largest_radius)));
  }

  // number: by which overlaps() identifies the sphere.
  void add(const dem::PlacedSphere& sphere, std::int64_t number = 0) {
    auto [head, empty] = last_.try_emplace(key(cell_of(sphere.position)), -1);
    spheres_.push_back({sphere, number, head->second});
    head->second = static_cast<std::int64_t>(spheres_.size()) - 1;
  }

  // True if it overlaps a sphere for whose number `counts` is true. Touching is not overlapping.
  template <typename Counts>
  bool overlaps(const dem::PlacedSphere& sphere, Counts&& counts) const {
    const Cell home = cell_of(sphere.position);
    for (int k = -1; k <= 1; ++k)
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          Cell cell{home[0] + i, home[1] + j, home[2] + k};
          if (bring_inside(cell) && overlaps_in(cell, sphere, counts)) return true;
        }
    return false;
  }
  bool overlaps(const dem::PlacedSphere& sphere) const {
    return overlaps(sphere, [](std::int64_t) { return true; });
  }

private:
  using Cell = std::array<std::int64_t, 3>;
  struct Entry {
    dem::PlacedSphere sphere;
    std::int64_t number, next;  // next: of the same cell; -1: none
  };

  template <typename Counts>
  bool overlaps_in(const Cell& cell, const dem::PlacedSphere& sphere, Counts&& counts) const {
    const auto head = last_.find(key(cell));
    if (head == last_.end()) return false;
    for (std::int64_t at = head->second; at >= 0; at = spheres_[static_cast<std::size_t>(at)].next) {
      const Entry& other = spheres_[static_cast<std::size_t>(at)];
      const double touching = sphere.radius + other.sphere.radius;
      const Vec3 apart = box_.difference(sphere.position, other.sphere.position);
      if (apart.squaredNorm() < touching * touching && counts(other.number)) return true;
    }
    return false;
  }

  Cell cell_of(const Vec3& point) const {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      const double share = point[axis] / box_.size[axis] * static_cast<double>(count_[axis]);
      cell[axis] = std::clamp<std::int64_t>(static_cast<std::int64_t>(share), 0, count_[axis] - 1);
    }
    return cell;
  }
  bool bring_inside(Cell& cell) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (box_.periodic[axis]) cell[axis] = (cell[axis] + count_[axis]) % count_[axis];
      if (cell[axis] < 0 || cell[axis] >= count_[axis]) return false;
    }
    return true;
  }
  std::int64_t key(const Cell& cell) const { return (cell[2] * count_[1] + cell[1]) * count_[0] + cell[0]; }

  PeriodicBox box_;
  Cell count_{};                                         // cells along each axis
  std::unordered_map<std::int64_t, std::int64_t> last_;  // entry of the sphere that came last into a cell
  std::vector<Entry> spheres_;
};

}  // namespace thalweg::beds
