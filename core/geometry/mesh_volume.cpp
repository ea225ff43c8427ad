#include "core/geometry/mesh_volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace thalweg {

namespace {

using Polygon = std::vector<Vec3>;

// The part of a convex polygon where sign x[axis] <= sign limit.
Polygon cut(const Polygon& whole, int axis, double limit, double sign) {
  Polygon part;
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const Vec3 &here = whole[n], &next = whole[(n + 1) % whole.size()];
    const double in = sign * (limit - here[axis]), in_next = sign * (limit - next[axis]);
    if (in >= 0.0) part.push_back(here);
    if ((in > 0.0 && in_next < 0.0) || (in < 0.0 && in_next > 0.0)) {
      part.push_back(here + in / (in - in_next) * (next - here));
      part.back()[axis] = limit;
    }
  }
  return part;
}

// Integrals over a polygon.
struct Moments {
  double area = 0.0;    // of n_z
  double moment = 0.0;  // of z n_z

  double flux_below(double height) const { return moment - height * area; }
  Moments& operator+=(const Moments& other) {
    area += other.area;
    moment += other.moment;
    return *this;
  }
};

Moments moments_of(const Polygon& polygon) {
  Moments sum;
  for (std::size_t n = 1; n + 1 < polygon.size(); ++n) {
    const Vec3 &a = polygon[0], b = polygon[n] - a, c = polygon[n + 1] - a;
    const double area = 0.5 * (b.x() * c.y() - b.y() * c.x());
    sum += {area, area * (a.z() + (b.z() + c.z()) / 3.0)};
  }
  return sum;
}

struct HeightRange {
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
};

HeightRange range_of(const Polygon& polygon) {
  HeightRange range;
  for (const Vec3& point : polygon) {
    range.lower = std::min(range.lower, point.z());
    range.upper = std::max(range.upper, point.z());
  }
  return range;
}

// True for the axes across the height on which only what lies between the faces counts.
std::array<bool, 2> cut_at_faces(const TriangleMesh& mesh, const PeriodicBox& box) {
  std::array<bool, 2> cuts;
  for (int axis = 0; axis < 2; ++axis) {
    double lower = std::numeric_limits<double>::infinity(), upper = -lower;
    for (const Vec3& point : mesh.points) {
      lower = std::min(lower, point[axis]);
      upper = std::max(upper, point[axis]);
    }
    cuts[axis] = !box.periodic[axis] || upper - lower > box.size[axis];
  }
  return cuts;
}

}  // namespace

// A polygon is cut at the heights that cross it, and whole below all higher ones.
std::vector<double> volume_below(const TriangleMesh& mesh, const PeriodicBox& box, int layers) {
  const std::array<bool, 2> cuts = cut_at_faces(mesh, box);
  const double thickness = box.size.z() / layers;
  const auto count = static_cast<std::size_t>(layers) + 1;
  std::vector<double> below(count, 0.0);
  std::vector<Moments> whole_from(count + 1);
  for (const auto& triangle : mesh.triangles) {
    Polygon polygon{mesh.points[triangle[0]], mesh.points[triangle[1]], mesh.points[triangle[2]]};
    for (int axis = 0; axis < 2; ++axis)
      if (cuts[axis]) polygon = cut(cut(polygon, axis, 0.0, -1.0), axis, box.size[axis], 1.0);
    if (polygon.size() < 3) continue;
    const auto [lower, upper] = range_of(polygon);
    const auto first_at_least = [&](double z) {
      return static_cast<std::size_t>(std::clamp(std::ceil(z / thickness), 0.0, static_cast<double>(count)));
    };
    const std::size_t whole = first_at_least(upper);
    for (std::size_t k = first_at_least(lower); k < whole; ++k) {
      const double height = thickness * static_cast<double>(k);
      below[k] += moments_of(cut(polygon, 2, height, 1.0)).flux_below(height);
    }
    whole_from[whole] += moments_of(polygon);
  }
  Moments whole;
  for (std::size_t k = 0; k < count; ++k) {
    whole += whole_from[k];
    below[k] += whole.flux_below(thickness * static_cast<double>(k));
  }
  const double beneath = below.front(), outwards = signed_volume(mesh) < 0.0 ? -1.0 : 1.0;
  for (double& volume : below) volume = std::max(0.0, outwards * (volume - beneath));
  return below;
}

}  // namespace thalweg
