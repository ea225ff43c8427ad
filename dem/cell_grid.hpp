// Points sorted into the cells of a grid over the box, to find all neighbours within a distance. Knows periodic axes,
// also those with fewer than three cells: every neighbouring cell is visited once.
#pragma once

#include "core/periodic_box.hpp"
#include "core/types.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::dem {

class CellGrid {
public:
  // Points (m) must lie in the box on periodic axes; beyond a non-periodic face they count to the outermost cells.
  CellGrid(const PeriodicBox& box, double distance, std::span<const Vec3> points);

  // Calls visit(index) for every point that may be within `distance` of `point`, itself included if it is one of them.
  template <typename Visitor>
  void for_each_near(const Vec3& point, Visitor&& visit) const {
    std::array<Neighbours, 3> near;
    for (int axis = 0; axis < 3; ++axis) near[axis] = neighbours(axis, cell_along(axis, point[axis]));
    for (int k = 0; k < near[2].count; ++k)
      for (int j = 0; j < near[1].count; ++j)
        for (int i = 0; i < near[0].count; ++i) {
          const std::size_t cell = index(near[0].cell[i], near[1].cell[j], near[2].cell[k]);
          for (std::uint32_t m = start_[cell]; m < start_[cell + 1]; ++m) visit(members_[m]);
        }
  }

private:
  struct Neighbours {
    int count = 0;
    std::array<int, 3> cell{};
  };

  int cell_along(int axis, double coordinate) const;
  Neighbours neighbours(int axis, int cell) const;
  std::size_t index(int i, int j, int k) const { return (static_cast<std::size_t>(k) * count_[1] + j) * count_[0] + i; }

  PeriodicBox box_;
  Index3 count_{1, 1, 1};
  std::vector<std::uint32_t> start_;    // first member of each cell, and one past the last
  std::vector<std::uint32_t> members_;  // points by cell
};

}  // namespace thalweg::dem
