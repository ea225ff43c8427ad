// Crossings of lines along x with a triangle, which tell the inside of a closed surface.
#pragma once

#include "core/base/types.hpp"

#include <array>
#include <optional>

namespace thalweg {

using Corners = std::array<Vec3, 3>;

// Crossing of a line along +x at (y, z) with a triangle: x, and +1 where the line enters the solid, -1 where it leaves.
// A line through an edge or a corner crosses exactly one of the triangles that meet there, so that the sum over a
// closed surface is right for every line.
struct Crossing {
  double x;
  int winding;
};
std::optional<Crossing> crossing(const Corners& triangle, double y, double z);

}  // namespace thalweg
