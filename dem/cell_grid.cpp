#include "dem/cell_grid.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::dem {

CellGrid::CellGrid(const PeriodicBox& box, double distance, std::span<const Vec3> points) : box_(box) {
  // Cells at least `distance` wide, and no more of them than a few for each point, however large the box is.
  const double most = 8.0 * static_cast<double>(points.size()) + 64.0;
  for (double width = distance;; width *= 1.25) {
    double cells = 1.0;
    for (int axis = 0; axis < 3; ++axis) cells *= std::max(1.0, std::floor(box.size[axis] / width));
    if (cells > most) continue;
    for (int axis = 0; axis < 3; ++axis) count_[axis] = std::max(1, static_cast<int>(box.size[axis] / width));
    break;
  }

  start_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
  std::vector<std::size_t> cell_of(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    cell_of[p] = index(cell_along(0, points[p][0]), cell_along(1, points[p][1]), cell_along(2, points[p][2]));
    ++start_[cell_of[p] + 1];
  }
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  members_.resize(points.size());
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t p = 0; p < points.size(); ++p) members_[next[cell_of[p]]++] = static_cast<std::uint32_t>(p);
}

int CellGrid::cell_along(int axis, double coordinate) const {
  const double cell = coordinate / box_.size[axis] * count_[axis];
  return static_cast<int>(std::clamp(cell, 0.0, static_cast<double>(count_[axis] - 1)));
}

CellGrid::Neighbours CellGrid::neighbours(int axis, int cell) const {
  const int count = count_[axis];
  Neighbours near;
  if (count <= 2 || (box_.periodic[axis] && count == 3)) {
    for (int c = 0; c < count; ++c) near.cell[near.count++] = c;
    return near;
  }
  for (int c = cell - 1; c <= cell + 1; ++c) {
    if (box_.periodic[axis])
      near.cell[near.count++] = (c + count) % count;
    else if (c >= 0 && c < count)
      near.cell[near.count++] = c;
  }
  return near;
}

}  // namespace thalweg::dem
