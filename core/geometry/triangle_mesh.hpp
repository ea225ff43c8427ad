// A surface of triangles, as a geometry file gives it.
#pragma once

#include "core/base/types.hpp"

#include <array>
#include <string>
#include <vector>

namespace thalweg {

struct TriangleMesh {
  std::vector<Vec3> points;                   // in the caller's unit of length
  std::vector<std::array<int, 3>> triangles;  // indices of points, anticlockwise seen from outside
  bool operator==(const TriangleMesh&) const = default;
};

// Reason why a mesh encloses no volume, as part of a sentence ("3 edges belong to one triangle only"). Empty if it
// encloses one: every edge joins two triangles that agree on which side is out.
std::string what_is_open(const TriangleMesh& mesh);

// Volume of a closed mesh, in its unit of length cubed; negative where the triangles are wound clockwise.
double signed_volume(const TriangleMesh& mesh);

// Winds all triangles of a closed mesh the other way round.
void turn_inside_out(TriangleMesh& mesh);

}  // namespace thalweg
