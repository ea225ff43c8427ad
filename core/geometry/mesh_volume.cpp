#include "core/geometry/mesh_volume.hpp"

#include "core/geometry/triangle_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

namespace thalweg {

namespace {

constexpr double most_columns = 90000.0;

struct Span {
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;

  double length() const { return std::max(0.0, upper - lower); }
};

// The part of an axis of the plan that the surfaces take: all of it where they cross a periodic face.
Span span_of(std::span<const TriangleMesh> meshes, const PeriodicBox& box, int axis) {
  Span span;
  for (const TriangleMesh& mesh : meshes)
    for (const Vec3& point : mesh.points) {
      span.lower = std::min(span.lower, point[axis]);
      span.upper = std::max(span.upper, point[axis]);
    }
  const bool is_inside = span.lower >= 0.0 && span.upper <= box.size[axis];
  if (box.periodic[axis] && !is_inside) return {0.0, box.size[axis]};
  return {std::max(span.lower, 0.0), std::min(span.upper, box.size[axis])};
}

// Midpoints of the columns along an axis of the plan.
struct ColumnAxis {
  double lower, width;  // m
  int count;
  bool wraps;  // the columns behind the last are the first again

  // Calls visit(column, midpoint) for those between two places and one beyond each.
  template <typename Visit>
  void for_each_between(double from, double to, const Visit& visit) const {
    double first = std::ceil((from - lower) / width - 1.5), last = std::floor((to - lower) / width + 0.5);
    if (!wraps) first = std::max(first, 0.0), last = std::min(last, count - 1.0);
    for (auto n = static_cast<std::int64_t>(first); n <= static_cast<std::int64_t>(last); ++n)
      visit(static_cast<int>((n % count + count) % count), lower + (static_cast<double>(n) + 0.5) * width);
  }
};

ColumnAxis column_axis(const Span& span, double width_wanted, bool periodic) {
  const int count = std::max(1, static_cast<int>(span.length() / width_wanted));
  return {span.lower, span.length() / count, count, periodic};
}

// Where a column enters a surface (winding 1) or leaves it (-1).
struct ColumnEnd {
  int column;
  double z;
  int winding;
};

void add_ends(const TriangleMesh& mesh, const ColumnAxis& x, const ColumnAxis& y, std::vector<ColumnEnd>& ends) {
  const int outwards = signed_volume(mesh) < 0.0 ? -1 : 1;
  for (const auto& triangle : mesh.triangles) {
    Corners turned;  // z along the first axis, that of the lines of crossing()
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& point = mesh.points[triangle[k]];
      turned[k] = {point.z(), point.x(), point.y()};
    }
    const Vec3 lower = turned[0].cwiseMin(turned[1]).cwiseMin(turned[2]),
               upper = turned[0].cwiseMax(turned[1]).cwiseMax(turned[2]);
    x.for_each_between(lower[1], upper[1], [&](int i, double at_x) {
      y.for_each_between(lower[2], upper[2], [&](int j, double at_y) {
        if (const auto hit = crossing(turned, at_x, at_y))
          ends.push_back({j * x.count + i, hit->x, outwards * hit->winding});
      });
    });
  }
}

// Sums over the beginnings of stretches below each of the heights, less those over their ends.
class LengthBelow {
public:
  LengthBelow(double thickness, int layers) : thickness_(thickness), from_(static_cast<std::size_t>(layers) + 1) {}

  void add(double beginning, double end) {
    add_end(beginning, 1.0);
    add_end(end, -1.0);
  }

  // At the heights from 0 on.
  std::vector<double> values() const {
    std::vector<double> lengths;
    Sums sums;
    for (const Sums& more : from_) {
      sums.number += more.number;
      sums.heights += more.heights;
      const double height = thickness_ * static_cast<double>(lengths.size());
      lengths.push_back(std::max(0.0, sums.number * height - sums.heights));
    }
    return lengths;
  }

private:
  struct Sums {
    double number = 0.0, heights = 0.0;  // 1, m
  };

  void add_end(double z, double sign) {
    const double top = thickness_ * static_cast<double>(from_.size() - 1), inside = std::clamp(z, 0.0, top);
    const auto first = std::min(from_.size() - 1, static_cast<std::size_t>(std::ceil(inside / thickness_)));
    from_[first].number += sign;
    from_[first].heights += sign * inside;
  }

  double thickness_;        // m
  std::vector<Sums> from_;  // by the first height that they count for
};

}  // namespace

std::vector<double> volume_below(std::span<const TriangleMesh> meshes, const PeriodicBox& box, int layers) {
  const Span along = span_of(meshes, box, 0), across = span_of(meshes, box, 1);
  const double area = along.length() * across.length();
  if (!(area > 0.0)) return std::vector<double>(static_cast<std::size_t>(layers) + 1, 0.0);
  const double width = std::sqrt(area / most_columns);
  const ColumnAxis x = column_axis(along, width, box.periodic[0]), y = column_axis(across, width, box.periodic[1]);
  std::vector<ColumnEnd> ends;
  for (const TriangleMesh& mesh : meshes) add_ends(mesh, x, y, ends);
  std::sort(ends.begin(), ends.end(), [](const ColumnEnd& a, const ColumnEnd& b) {
    return std::tuple(a.column, a.z) < std::tuple(b.column, b.z);
  });

  LengthBelow length(box.size.z() / layers, layers);
  double beginning = 0.0;
  int inside = 0;  // how many surfaces enclose what follows
  for (const ColumnEnd& end : ends) {
    if (inside == 0) beginning = end.z;
    inside += end.winding;
    if (inside == 0) length.add(beginning, end.z);
  }
  std::vector<double> below = length.values();
  for (double& volume : below) volume *= x.width * y.width;
  return below;
}

}  // namespace thalweg
