// Distance of points from a triangle surface, by a tree of boxes.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/triangle_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace thalweg::beds {

class MeshDistance {
public:
  explicit MeshDistance(const TriangleMesh& mesh);  // with at least one triangle

  double operator()(const Vec3& point) const;  // m, from the nearest triangle, on either side

private:
  struct Node {
    Vec3 lower, upper;                   // m
    std::uint32_t first, last;           // triangles in order_
    std::int32_t left = -1, right = -1;  // -1: a leaf
  };

  std::int32_t build(std::uint32_t first, std::uint32_t last);

  std::vector<std::array<Vec3, 3>> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace thalweg::beds
