#include "beds/shapes/surface_points.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::beds {

std::vector<SurfacePoint> points_of(const TriangleMesh& mesh, double size) {
  std::vector<SurfacePoint> points;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.points[static_cast<std::size_t>(t[0])];
    const Vec3 u = mesh.points[static_cast<std::size_t>(t[1])] - a, v = mesh.points[static_cast<std::size_t>(t[2])] - a;
    const double longest = std::max({u.norm(), v.norm(), (u - v).norm()});
    const int parts = std::max(1, static_cast<int>(std::ceil(longest / size)));
    const double area = 0.5 * u.cross(v).norm() / (parts * parts);
    // Parallel lines cut it in parts^2 triangles: those that stand as it does, and those turned over between them.
    for (int i = 0; i < parts; ++i)
      for (int j = 0; i + j < parts; ++j) {
        points.push_back({a + ((i + 1.0 / 3.0) * u + (j + 1.0 / 3.0) * v) / parts, area});
        if (i + j + 1 < parts) points.push_back({a + ((i + 2.0 / 3.0) * u + (j + 2.0 / 3.0) * v) / parts, area});
      }
  }
  return points;
}

std::vector<SurfacePoint> points_of(std::span<const dem::PlacedSphere> spheres, std::vector<std::size_t>* sphere) {
  constexpr int on_sphere = 2000;
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<SurfacePoint> points;
  for (std::size_t n = 0; n < spheres.size(); ++n)
    for (int k = 0; k < on_sphere; ++k) {
      const double z = 1.0 - (2.0 * k + 1.0) / on_sphere, flat = std::sqrt(1.0 - z * z), angle = golden_angle * k;
      const double radius = spheres[n].radius;
      const Vec3 point = spheres[n].position + radius * Vec3(flat * std::cos(angle), flat * std::sin(angle), z);
      const bool held = std::any_of(spheres.begin(), spheres.end(), [&](const dem::PlacedSphere& other) {
        return &other != &spheres[n] && (point - other.position).squaredNorm() < other.radius * other.radius;
      });
      if (held) continue;
      points.push_back({point, 4.0 * std::numbers::pi * radius * radius / on_sphere});
      if (sphere) sphere->push_back(n);
    }
  return points;
}

std::vector<SurfacePoint> crease_points(std::span<const dem::PlacedSphere> spheres) {
  constexpr int on_circle = 500;
  std::vector<SurfacePoint> points;
  for (std::size_t m = 0; m < spheres.size(); ++m)
    for (std::size_t n = m + 1; n < spheres.size(); ++n) {
      const dem::PlacedSphere &a = spheres[m], &b = spheres[n];
      const Vec3 apart = b.position - a.position;
      const double distance = apart.norm();
      if (distance >= a.radius + b.radius || distance <= std::abs(a.radius - b.radius)) continue;
      const Vec3 axis = apart / distance, any = std::abs(axis.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
      const Vec3 u = axis.cross(any).normalized(), v = axis.cross(u);
      const double along = 0.5 * (distance + (a.radius - b.radius) * (a.radius + b.radius) / distance);
      const double radius = std::sqrt(std::max(0.0, (a.radius - along) * (a.radius + along)));
      for (int k = 0; k < on_circle; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / on_circle;
        const Vec3 point = a.position + along * axis + radius * (std::cos(angle) * u + std::sin(angle) * v);
        const bool held = std::any_of(spheres.begin(), spheres.end(), [&](const dem::PlacedSphere& other) {
          return &other != &a && &other != &b && (point - other.position).squaredNorm() < other.radius * other.radius;
        });
        if (!held) points.push_back({point, 0.0});
      }
    }
  return points;
}

}  // namespace thalweg::beds
