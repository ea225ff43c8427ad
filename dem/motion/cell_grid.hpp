// Points sorted into the cells of a grid, to find all pairs within a distance. The grid covers the part of the box in
// which there are points, so its size depends on these and not on the box. Knows periodic axes, also those with fewer
// than three cells, and points on both sides of a periodic face: every pair is visited once.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::dem {

class CellGrid {
public:
  // distance: m. Points (m) must lie in the box on periodic axes; those beyond a non-periodic face go to the outermost
  // cells.
  CellGrid(const PeriodicBox& box, double distance, std::span<const Vec3> points);

  // Numbers of the points, cell by cell: data laid out in this order has the points of a cell next to each other.
  std::span<const std::uint32_t> order() const { return members_; }

  // Calls visit(m, n) for every pair of points order()[m], order()[n] that may be within `distance` of each other.
  template <typename Visitor>
  void for_each_near_pair(Visitor&& visit) const {
    for (int k = 0; k < axes_[2].count; ++k)
      for (int j = 0; j < axes_[1].count; ++j)
        for (int i = 0; i < axes_[0].count; ++i)
          if (const std::size_t cell = index(i, j, k); start_[cell] < start_[cell + 1])
            visit_pairs_of(cell, {neighbours(0, i), neighbours(1, j), neighbours(2, k)}, visit);
  }

private:
  struct Neighbours {
    int count = 0;
    std::array<int, 3> cell{};
  };

  // Visits pairs of neighbouring cells from the one with the lower number.
  template <typename Visitor>
  void visit_pairs_of(std::size_t cell, const std::array<Neighbours, 3>& near, Visitor&& visit) const {
    for (int k = 0; k < near[2].count; ++k)
      for (int j = 0; j < near[1].count; ++j)
        for (int i = 0; i < near[0].count; ++i) {
          const std::size_t other = index(near[0].cell[i], near[1].cell[j], near[2].cell[k]);
          if (other < cell) continue;
          for (std::uint32_t m = start_[cell]; m < start_[cell + 1]; ++m)
            for (std::uint32_t n = other == cell ? m + 1 : start_[other]; n < start_[other + 1]; ++n) visit(m, n);
        }
  }

  // The cells along an axis: of `slabs` that divide the box, `count` from the slab `first` on, across a periodic face
  // if need be.
  struct Axis {
    int slabs = 1, first = 0, count = 1;
    bool around = false;  // periodic, and every slab is a cell: the last one is next to the first
  };
  // width: m, of a slab at least; most: slabs at most.
  static Axis occupied_part(const PeriodicBox& box, int axis, double width, double most, std::span<const Vec3> points);

  int cell_along(int axis, double coordinate) const;
  Neighbours neighbours(int axis, int cell) const;
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * axes_[1].count + j) * axes_[0].count + i;
  }

  PeriodicBox box_;
  std::array<Axis, 3> axes_;
  std::vector<std::uint32_t> start_;    // first member of each cell, and one past the last
  std::vector<std::uint32_t> members_;  // points by cell
};

}  // namespace thalweg::dem
