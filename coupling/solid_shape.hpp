// Shapes of solids that stand still in the fluid: what is inside, and where a lattice link meets the surface. Lattice
// units, global coordinates.
#pragma once

#include "core/sphere.hpp"
#include "core/triangle_mesh.hpp"
#include "core/types.hpp"

#include <optional>
#include <variant>

namespace thalweg::coupling {

// A shape (core/shape.hpp) somewhere in the box.
template <Shape S>
struct PlacedShape {
  Vec3 centre = Vec3::Zero();
  S shape;
};
using SolidSphere = PlacedShape<Sphere>;

// A further Shape is one more alternative here. A mesh must be closed and wound outwards.
using SolidShape = std::variant<SolidSphere, TriangleMesh>;

struct Extent {
  Vec3 lower, upper;
};
Extent extent_of(const TriangleMesh& mesh);
template <Shape S>
Extent extent_of(const PlacedShape<S>& solid) {
  return {solid.centre.array() - solid.shape.reach(), solid.centre.array() + solid.shape.reach()};
}
Extent extent_of(const SolidShape& shape);

using Corners = std::array<Vec3, 3>;

// Where a line along +x at (y, z) crosses a triangle: x, and +1 where it enters the solid, -1 where it leaves. A line
// through an edge or a corner crosses exactly one of the triangles that meet there, so that the sum over a closed
// surface is right for every line.
struct Crossing {
  double x;
  int winding;
};
std::optional<Crossing> crossing(const Corners& triangle, double y, double z);

// The fraction t in [0, 1] of the way from a point along a link at which it meets the surface; none: it does not. Links
// that run along an edge or end on a surface count as meeting it, up to round-off: on_link() decides so from the
// fraction at which the link's line meets the surface.
std::optional<double> on_link(std::optional<double> way);
std::optional<double> meets(const Corners& triangle, const Vec3& from, const Vec3& along);
template <Shape S>
std::optional<double> meets(const PlacedShape<S>& solid, const Vec3& from, const Vec3& along) {
  return on_link(solid.shape.crossing(from - solid.centre, along));
}

}  // namespace thalweg::coupling
