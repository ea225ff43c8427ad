#include "dem/motion/cell_grid.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::dem {

namespace {

// Slab that a coordinate lies in, of those that divide one axis of the box; the first if it is not a number.
int slab_of(double coordinate, double size, int slabs) {
  const double place = coordinate / size * slabs;
  return place > 0.0 ? static_cast<int>(std::min(place, static_cast<double>(slabs - 1))) : 0;
}

}  // namespace

CellGrid::Axis CellGrid::occupied_part(const PeriodicBox& box, int axis, double width, double most,
                                       std::span<const Vec3> points) {
  Axis part;
  part.slabs = static_cast<int>(std::clamp(box.size[axis] / width, 1.0, most));
  std::vector<char> occupied(static_cast<std::size_t>(part.slabs), 0);
  for (const Vec3& point : points) occupied[slab_of(point[axis], box.size[axis], part.slabs)] = 1;
  const auto first = std::find(occupied.begin(), occupied.end(), 1);
  if (first == occupied.end()) return part;

  // The longest run of empty slabs is left out: between two points of a periodic axis, else at the ends.
  const int begin = static_cast<int>(first - occupied.begin()), slabs = part.slabs;
  int empty = 0, longest = 0, after = begin, last = begin;
  for (int n = 1; n <= slabs; ++n) {
    const int slab = (begin + n) % slabs;
    empty = occupied[slab] ? 0 : empty + 1;
    if (occupied[slab] && slab > last) last = slab;
    if (empty > longest) {
      longest = empty;
      after = (slab + 1) % slabs;
    }
  }
  part.first = box.periodic[axis] ? after : begin;
  part.count = box.periodic[axis] ? slabs - longest : last - begin + 1;
  part.around = box.periodic[axis] && part.count == slabs;
  if (part.around) part.first = 0;
  return part;
}

CellGrid::CellGrid(const PeriodicBox& box, double distance, std::span<const Vec3> points) : box_(box) {
  // Cells at least `distance` wide, and no more of them than a few for each point, however far apart these are.
  const double most = 8.0 * static_cast<double>(points.size()) + 64.0;
  for (double width = distance;; width *= 1.25) {
    double cells = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      axes_[axis] = occupied_part(box, axis, width, most, points);
      cells *= axes_[axis].count;
    }
    if (cells <= most) break;
  }

  start_.assign(index(0, 0, axes_[2].count) + 1, 0);
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
  const Axis& part = axes_[axis];
  const int cell = slab_of(coordinate, box_.size[axis], part.slabs) - part.first;
  return cell < 0 ? cell + part.slabs : cell;
}

CellGrid::Neighbours CellGrid::neighbours(int axis, int cell) const {
  const int count = axes_[axis].count;
  Neighbours near;
  if (count <= 2 || (axes_[axis].around && count == 3)) {
    for (int c = 0; c < count; ++c) near.cell[near.count++] = c;
    return near;
  }
  for (int c = cell - 1; c <= cell + 1; ++c) {
    if (axes_[axis].around)
      near.cell[near.count++] = (c + count) % count;
    else if (c >= 0 && c < count)
      near.cell[near.count++] = c;
  }
  return near;
}

}  // namespace thalweg::dem
