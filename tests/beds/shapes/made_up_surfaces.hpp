// Closed surfaces for tests, wound outwards.
#pragma once

#include "core/geometry/triangle_mesh.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace thalweg::beds {

// radius: of the direction (unit), m; seen from the origin every point of the surface is visible.
template <typename Radius>
TriangleMesh star_surface(int rows, const Radius& radius) {
  const int around = 2 * rows;
  const double step = std::numbers::pi / rows;
  TriangleMesh mesh;
  const auto add = [&](const Vec3& direction) { mesh.points.push_back(radius(direction) * direction); };
  add(-Vec3::UnitZ());
  add(Vec3::UnitZ());
  for (int row = 1; row < rows; ++row)
    for (int k = 0; k < around; ++k)
      add(Vec3(std::sin(row * step) * std::cos(k * step), std::sin(row * step) * std::sin(k * step),
               -std::cos(row * step)));
  const auto corner = [&](int row, int k) {
    return row == 0 ? 0 : row == rows ? 1 : 2 + (row - 1) * around + k % around;
  };
  for (int row = 0; row < rows; ++row)
    for (int k = 0; k < around; ++k) {
      if (row > 0) mesh.triangles.push_back({corner(row, k), corner(row, k + 1), corner(row + 1, k + 1)});
      if (row + 1 < rows) mesh.triangles.push_back({corner(row, k), corner(row + 1, k + 1), corner(row + 1, k)});
    }
  return mesh;
}

// A sphere stretched along the axes.
inline TriangleMesh ellipsoid(const Vec3& half_axes, const Vec3& centre = Vec3::Zero(), int rows = 48) {
  TriangleMesh mesh = star_surface(rows, [](const Vec3&) { return 1.0; });
  for (Vec3& point : mesh.points) point = centre + half_axes.cwiseProduct(point);
  return mesh;
}

inline TriangleMesh block(const Vec3& lower, const Vec3& upper) {
  TriangleMesh mesh;
  for (int n = 0; n < 8; ++n)
    mesh.points.emplace_back((n & 1) ? upper.x() : lower.x(), (n & 2) ? upper.y() : lower.y(),
                             (n & 4) ? upper.z() : lower.z());
  for (const std::array<int, 4>& q : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                                      std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

// Adds the parts of another surface.
inline void add(TriangleMesh& mesh, const TriangleMesh& more) {
  const int before = static_cast<int>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), more.points.begin(), more.points.end());
  for (const auto& t : more.triangles) mesh.triangles.push_back({t[0] + before, t[1] + before, t[2] + before});
}

}  // namespace thalweg::beds
