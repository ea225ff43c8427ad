// Shapes of solids that stand still in the fluid: what is inside, and where a lattice link meets the surface. Lattice
// units, global coordinates.
#pragma once

#include "core/triangle_crossing.hpp"
#include "core/triangle_mesh.hpp"
#include "core/types.hpp"

#include <optional>
#include <variant>

namespace thalweg::bodies {

struct SolidSphere {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};

// A mesh must be closed and wound outwards.
using SolidShape = std::variant<SolidSphere, TriangleMesh>;

struct Extent {
  Vec3 lower, upper;
};
Extent extent_of(const TriangleMesh& mesh);
Extent extent_of(const SolidSphere& solid);
Extent extent_of(const SolidShape& shape);

// The fraction t in [0, 1] of the way from a point along a link at which it meets the surface; none: it does not. Links
// that run along an edge or end on a surface count as meeting it, up to round-off.
std::optional<double> meets(const Corners& triangle, const Vec3& from, const Vec3& along);
std::optional<double> meets(const SolidSphere& solid, const Vec3& from, const Vec3& along);

}  // namespace thalweg::bodies
