#include "bodies/map/solid_shape.hpp"

#include "core/geometry/sphere.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::bodies {

namespace {

constexpr double slack = 1e-9;

// A fraction of a link at which its line meets a surface, if it is one of the link's, up to round-off.
std::optional<double> on_link(std::optional<double> way) {
  if (!way || *way < -slack || *way > 1.0 + slack) return std::nullopt;
  return std::clamp(*way, 0.0, 1.0);
}

}  // namespace

void move(const SolidShape& at_start, const RigidTransform& transform, SolidShape& moved) {
  if (const auto* sphere = std::get_if<SolidSphere>(&at_start)) {
    std::get<SolidSphere>(moved).centre = transform.of(sphere->centre);
    return;
  }
  const std::vector<Vec3>& points = std::get<TriangleMesh>(at_start).points;
  std::transform(points.begin(), points.end(), std::get<TriangleMesh>(moved).points.begin(),
                 [&](const Vec3& point) { return transform.of(point); });
}

Extent extent_of(const SolidShape& shape) {
  return std::visit([](const auto& s) { return extent_of(s); }, shape);
}

Extent extent_of(const SolidSphere& solid) {
  return {solid.centre.array() - solid.radius, solid.centre.array() + solid.radius};
}

Extent extent_of(const TriangleMesh& mesh) {
  Extent extent{mesh.points.front(), mesh.points.front()};
  for (const Vec3& point : mesh.points) {
    extent.lower = extent.lower.cwiseMin(point);
    extent.upper = extent.upper.cwiseMax(point);
  }
  return extent;
}

// Moeller and Trumbore 1997.
std::optional<double> meets(const Corners& t, const Vec3& from, const Vec3& along) {
  const Vec3 first = t[1] - t[0], second = t[2] - t[0], p = along.cross(second);
  const double determinant = first.dot(p);
  if (std::abs(determinant) < 1e-14 * first.norm() * second.norm()) return std::nullopt;  // parallel to the triangle
  const Vec3 offset = from - t[0], q = offset.cross(first);
  const double u = offset.dot(p) / determinant, v = along.dot(q) / determinant, way = second.dot(q) / determinant;
  if (u < -slack || v < -slack || u + v > 1.0 + slack) return std::nullopt;
  return on_link(way);
}

std::optional<double> meets(const SolidSphere& solid, const Vec3& from, const Vec3& along) {
  return on_link(Sphere{solid.radius}.crossing(from - solid.centre, along));
}

}  // namespace thalweg::bodies
