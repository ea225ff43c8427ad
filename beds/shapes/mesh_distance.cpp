#include "beds/shapes/mesh_distance.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::beds {
namespace {

double squared_distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length = along.squaredNorm();
  const double t = length > 0.0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (p - a - t * along).squaredNorm();
}

double squared_distance(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double area = normal.squaredNorm();
  bool above = area > 0.0;
  for (std::size_t k = 0; above && k < 3; ++k) above = normal.dot((t[(k + 1) % 3] - t[k]).cross(p - t[k])) >= 0.0;
  if (above) {
    const double height = normal.dot(p - t[0]);
    return height * height / area;
  }
  return std::min({squared_distance_to_segment(p, t[0], t[1]), squared_distance_to_segment(p, t[1], t[2]),
                   squared_distance_to_segment(p, t[2], t[0])});
}

}  // namespace

MeshDistance::MeshDistance(const TriangleMesh& mesh) {
  for (const auto& t : mesh.triangles)
    triangles_.push_back({mesh.points[static_cast<std::size_t>(t[0])], mesh.points[static_cast<std::size_t>(t[1])],
                          mesh.points[static_cast<std::size_t>(t[2])]});
  build(0, static_cast<std::uint32_t>(triangles_.size()));
}

std::int32_t MeshDistance::build(std::uint32_t first, std::uint32_t last) {
  constexpr std::uint32_t leaf = 4;  // triangles
  Node node{Vec3::Constant(std::numeric_limits<double>::infinity()),
            Vec3::Constant(-std::numeric_limits<double>::infinity()), first, last};
  for (std::uint32_t n = first; n < last; ++n)
    for (const Vec3& corner : triangles_[n]) {
      node.lower = node.lower.cwiseMin(corner);
      node.upper = node.upper.cwiseMax(corner);
    }
  const auto number = static_cast<std::int32_t>(nodes_.size());
  nodes_.push_back(node);
  if (last - first <= leaf) return number;
  int axis = 0;
  (node.upper - node.lower).maxCoeff(&axis);
  const std::uint32_t middle = first + (last - first) / 2;
  const auto place = [axis](const std::array<Vec3, 3>& t) { return t[0][axis] + t[1][axis] + t[2][axis]; };
  std::stable_sort(triangles_.begin() + first, triangles_.begin() + last,
                   [&](const auto& a, const auto& b) { return place(a) < place(b); });
  const std::int32_t left = build(first, middle), right = build(middle, last);
  nodes_[static_cast<std::size_t>(number)].left = left;
  nodes_[static_cast<std::size_t>(number)].right = right;
  return number;
}

double MeshDistance::operator()(const Vec3& point) const {
  const auto to_box = [&](std::int32_t n) {
    const Node& node = nodes_[static_cast<std::size_t>(n)];
    return (node.lower - point).cwiseMax(point - node.upper).cwiseMax(0.0).squaredNorm();
  };
  double nearest = std::numeric_limits<double>::infinity();
  std::array<std::int32_t, 128> open{};
  std::size_t count = 1;  // the root is open
  while (count > 0) {
    const std::int32_t at = open[--count];
    if (to_box(at) >= nearest) continue;
    const Node& node = nodes_[static_cast<std::size_t>(at)];
    if (node.left < 0) {
      for (std::uint32_t n = node.first; n < node.last; ++n)
        nearest = std::min(nearest, squared_distance(point, triangles_[n]));
      continue;
    }
    const bool left_is_nearer = to_box(node.left) <= to_box(node.right);
    open[count++] = left_is_nearer ? node.right : node.left;
    open[count++] = left_is_nearer ? node.left : node.right;
  }
  return std::sqrt(nearest);
}

}  // namespace thalweg::beds
