// Shapes of solids in the fluid: where they are once moved, and where a lattice link meets the surface. Lattice units,
// global coordinates.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/triangle_crossing.hpp"
#include "core/geometry/triangle_mesh.hpp"

#include <optional>
#include <variant>

namespace thalweg::bodies {

struct SolidSphere {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};

// A mesh must be closed and wound outwards.
using SolidShape = std::variant<SolidSphere, TriangleMesh>;

// Rigid displacement: the point that was at `pivot` at the start is at `centre`, and the body has turned about it.
struct RigidTransform {
  Vec3 pivot = Vec3::Zero(), centre = Vec3::Zero();
  Mat3 turn = Mat3::Identity();

  Vec3 of(const Vec3& at_start) const { return centre + turn * (at_start - pivot); }
};

// Writes the transformed shape over `moved`, which must be the same shape.
void move(const SolidShape& at_start, const RigidTransform& transform, SolidShape& moved);

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
