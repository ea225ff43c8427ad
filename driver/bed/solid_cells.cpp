#include "driver/bed/solid_cells.hpp"

#include "driver/case/solid_setup.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace thalweg::driver {

namespace {

constexpr int most_along_an_axis = 240;
constexpr double aside = 1.3e-7;  // steps; a line that passes no corner and no edge, but by chance

// Lines along z through the middle of columns, from the lowest to the highest that may meet a solid.
struct Columns {
  double step_x, step_y;  // m
  std::array<std::int64_t, 2> first, last;

  double x(std::int64_t i) const { return (static_cast<double>(i) + 0.5 + aside) * step_x; }
  double y(std::int64_t j) const { return (static_cast<double>(j) + 0.5 + 2.0 * aside) * step_y; }
};

Columns columns_of(const SolidCase& solid, const Case& c, double step_x, double step_y) {
  const bodies::Extent extent = extent_of(solid);
  Columns columns{step_x, step_y, {}, {}};
  for (int axis = 0; axis < 2; ++axis) {
    const double step = axis == 0 ? step_x : step_y, size = c.domain.size[axis];
    const bool periodic = periodic_axes(c.domain)[static_cast<std::size_t>(axis)];
    const double low = periodic ? extent.lower[axis] : std::max(0.0, extent.lower[axis]);
    const double high = periodic ? extent.upper[axis] : std::min(size, extent.upper[axis]);
    columns.first[static_cast<std::size_t>(axis)] = std::llround(std::floor(low / step));
    columns.last[static_cast<std::size_t>(axis)] =
        periodic ? std::llround(std::ceil(high / step)) : std::llround(std::ceil(high / step)) - 1;
  }
  return columns;
}

// The columns in parts no wider than the box, along whose periodic axes there may be many of them.
std::vector<Columns> parts_of(const Columns& whole, const std::array<int, 2>& most) {
  std::vector<Columns> parts;
  for (auto i = whole.first[0]; i <= whole.last[0]; i += most[0])
    for (auto j = whole.first[1]; j <= whole.last[1]; j += most[1]) {
      Columns& part = parts.emplace_back(whole);
      part.first = {i, j};
      part.last = {std::min(whole.last[0], i + most[0] - 1), std::min(whole.last[1], j + most[1] - 1)};
    }
  return parts;
}

using Crossings = std::map<std::pair<std::int64_t, std::int64_t>, std::vector<double>>;  // m, by column

// Heights at which the lines cross a triangle.
void cross(const Columns& columns, const Vec3& a, const Vec3& b, const Vec3& c, Crossings& crossings) {
  const double twice_area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
  if (twice_area == 0.0) return;
  const auto [least_x, most_x] = std::minmax({a.x(), b.x(), c.x()});
  const auto [least_y, most_y] = std::minmax({a.y(), b.y(), c.y()});
  const auto from = [](double low, double step, std::int64_t first) {
    return std::max(first, static_cast<std::int64_t>(std::floor(low / step)) - 1);
  };
  const auto to = [](double high, double step, std::int64_t last) {
    return std::min(last, static_cast<std::int64_t>(std::ceil(high / step)));
  };
  for (auto i = from(least_x, columns.step_x, columns.first[0]); i <= to(most_x, columns.step_x, columns.last[0]); ++i)
    for (auto j = from(least_y, columns.step_y, columns.first[1]); j <= to(most_y, columns.step_y, columns.last[1]);
         ++j) {
      const double x = columns.x(i), y = columns.y(j);
      const double of_b = ((x - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y - a.y())) / twice_area;
      const double of_c = ((b.x() - a.x()) * (y - a.y()) - (x - a.x()) * (b.y() - a.y())) / twice_area;
      if (of_b < 0.0 || of_c < 0.0 || of_b + of_c > 1.0) continue;
      crossings[{i, j}].push_back(a.z() + of_b * (b.z() - a.z()) + of_c * (c.z() - a.z()));
    }
}

Crossings crossings_of(const SolidCase& solid, const Columns& columns) {
  Crossings crossings;
  if (!solid.sphere) {
    for (const auto& triangle : solid.surface.triangles) {
      const auto corner = [&](std::size_t n) { return solid.surface.points[static_cast<std::size_t>(triangle[n])]; };
      cross(columns, corner(0), corner(1), corner(2), crossings);
    }
    return crossings;
  }
  const SphereCase& sphere = *solid.sphere;
  for (auto i = columns.first[0]; i <= columns.last[0]; ++i)
    for (auto j = columns.first[1]; j <= columns.last[1]; ++j) {
      const double x = columns.x(i) - sphere.centre.x(), y = columns.y(j) - sphere.centre.y();
      const double half = sphere.radius * sphere.radius - x * x - y * y;
      if (half > 0.0) crossings[{i, j}] = {sphere.centre.z() - std::sqrt(half), sphere.centre.z() + std::sqrt(half)};
    }
  return crossings;
}

// Calls visit(i, j, k) for the grid points of a step (m) within a solid, k counted from the bottom of the box, until it
// returns false.
template <typename Visit>
void for_points_inside(const SolidCase& solid, const Columns& columns, double step_z, const Visit& visit) {
  for (auto& [column, heights] : crossings_of(solid, columns)) {
    std::vector<double> sorted = heights;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t n = 0; n + 1 < sorted.size(); n += 2)
      for (auto k = std::llround(std::ceil(sorted[n] / step_z - 0.5));
           (static_cast<double>(k) + 0.5) * step_z < sorted[n + 1]; ++k)
        if (!visit(column.first, column.second, static_cast<std::int64_t>(k))) return;
  }
}

int wrapped(std::int64_t n, int size) { return static_cast<int>(((n % size) + size) % size); }

bool is_inside(std::int64_t n, int size, bool periodic) { return periodic || (n >= 0 && n < size); }

}  // namespace

SolidCells::SolidCells(const Case& c) : periodic_(periodic_axes(c.domain)) {
  const Index3 cells = cells_of(c.domain);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size_[axis] = std::clamp(cells[axis], 1, most_along_an_axis);
    step_[static_cast<int>(axis)] = c.domain.size[static_cast<int>(axis)] / size_[axis];
  }
  covered_.resize(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                  static_cast<std::size_t>(size_[2]));
  const auto cover = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    if (is_inside(i, size_[0], periodic_[0]) && is_inside(j, size_[1], periodic_[1]) &&
        is_inside(k, size_[2], periodic_[2]))
      covered_[index({wrapped(i, size_[0]), wrapped(j, size_[1]), wrapped(k, size_[2])})] = true;
    return true;
  };
  for (const SolidCase& solid : c.solids)
    for (const Columns& part : parts_of(columns_of(solid, c, step_.x(), step_.y()), {size_[0], size_[1]})) {
      for_points_inside(solid, part, step_.z(), cover);
      if (!any_open()) return;
    }
}

bool SolidCells::any_open() const { return std::find(covered_.begin(), covered_.end(), false) != covered_.end(); }

std::size_t SolidCells::index(const Index3& cell) const {
  return static_cast<std::size_t>(cell[0]) +
         static_cast<std::size_t>(size_[0]) * (static_cast<std::size_t>(cell[1]) +
                                               static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(cell[2]));
}

double SolidCells::lowest_opening(const Vec3& lower, const Vec3& upper) const {
  constexpr double rounding = 1e-9;  // cells
  Index3 first, last;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    first[n] = std::max(0, static_cast<int>(std::floor(lower[axis] / step_[axis] + rounding)));
    last[n] = std::min(size_[n], static_cast<int>(std::ceil(upper[axis] / step_[axis] - rounding))) - 1;
  }
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i)
        if (!covered({i, j, k})) return std::max(lower.z(), k * step_.z());
  return std::numeric_limits<double>::infinity();
}

int SolidCells::most_open_plane() const {
  std::vector<std::int64_t> closed(static_cast<std::size_t>(size_[0]));
  for (std::size_t n = 0; n < covered_.size(); ++n) closed[n % closed.size()] += covered_[n];
  return static_cast<int>(std::min_element(closed.begin(), closed.end()) - closed.begin());
}

std::optional<Index3> SolidCells::neighbour(const Index3& cell, int direction, int cut) const {
  const auto axis = static_cast<std::size_t>(direction / 2);
  const int by = direction % 2 == 0 ? -1 : 1, next = cell[axis] + by;
  if (!is_inside(next, size_[axis], periodic_[axis])) return std::nullopt;
  Index3 there = cell;
  there[axis] = wrapped(next, size_[axis]);
  const bool through_the_cut = axis == 0 && (by > 0 ? there[0] : cell[0]) == cut;
  return through_the_cut ? std::nullopt : std::optional(there);
}

bool SolidCells::opens_along_x(double least_height) const {
  const int cut = periodic_[0] ? most_open_plane() : 0, end = wrapped(cut - 1, size_[0]);
  std::vector<bool> seen(covered_);
  std::vector<Index3> front;
  const auto reach = [&](const Index3& cell) {
    if (height(cell[2]) < least_height || seen[index(cell)]) return;
    seen[index(cell)] = true;
    front.push_back(cell);
  };
  for (int j = 0; j < size_[1]; ++j)
    for (int k = 0; k < size_[2]; ++k) reach({cut, j, k});
  while (!front.empty()) {
    const Index3 cell = front.back();
    front.pop_back();
    if (cell[0] == end) return true;
    for (int direction = 0; direction < 6; ++direction)
      if (const std::optional<Index3> next = neighbour(cell, direction, cut)) reach(*next);
  }
  return false;
}

bool lies_within(const Case& c, const SolidCase& inner, const SolidCase& outer) {
  Vec3 step;
  for (int axis = 0; axis < 3; ++axis)
    step[axis] = std::max(c.domain.spacing, c.domain.size[axis] / most_along_an_axis);
  const Columns columns = columns_of(inner, c, step.x(), step.y());
  const Crossings around = crossings_of(outer, columns);
  bool any = false, all = true;
  for_points_inside(inner, columns, step.z(), [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    const double height = (static_cast<double>(k) + 0.5) * step.z();
    const auto found = around.find({i, j});
    any = true;
    all =
        found != around.end() &&
        std::count_if(found->second.begin(), found->second.end(), [height](double z) { return z <= height; }) % 2 == 1;
    return all;
  });
  return any && all;
}

bool covers_a_cell(const Case& c, const SolidCase& solid) {
  const Index3 cells = cells_of(c.domain);
  const std::array<bool, 3> periodic = periodic_axes(c.domain);
  bool found = false;
  for_points_inside(solid, columns_of(solid, c, c.domain.spacing, c.domain.spacing), c.domain.spacing,
                    [&](std::int64_t, std::int64_t, std::int64_t k) {
                      found = is_inside(k, cells[2], periodic[2]);
                      return !found;
                    });
  return found;
}

}  // namespace thalweg::driver
