#include "core/geometry/triangle_crossing.hpp"

#include <Eigen/Geometry>

#include <tuple>

namespace thalweg {

// True if, in the plane (y, z), the line from (y, z) towards +y crosses the edge. The edge is taken in the same order
// by both triangles that share it, and holds its lower end but not its upper one.
static bool crosses_edge(const Vec3& a, const Vec3& b, double y, double z) {
  const auto key = [](const Vec3& p) { return std::tuple(p.z(), p.y(), p.x()); };
  const Vec3& low = key(a) < key(b) ? a : b;
  const Vec3& high = key(a) < key(b) ? b : a;
  if (!(low.z() <= z && z < high.z())) return false;
  return y < low.y() + (z - low.z()) / (high.z() - low.z()) * (high.y() - low.y());
}

std::optional<Crossing> crossing(const Corners& t, double y, double z) {
  bool inside = false;
  for (int k = 0; k < 3; ++k) inside ^= crosses_edge(t[k], t[(k + 1) % 3], y, z);
  if (!inside) return std::nullopt;
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  if (normal.x() == 0.0) return std::nullopt;  // edge on: only round-off can come here
  const double x = t[0].x() - (normal.y() * (y - t[0].y()) + normal.z() * (z - t[0].z())) / normal.x();
  return Crossing{x, normal.x() < 0.0 ? 1 : -1};
}

}  // namespace thalweg
