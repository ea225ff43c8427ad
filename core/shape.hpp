// The shape of a body, as the coupling of fluid and bodies asks for it: what is inside, where a lattice link enters,
// how far it reaches. A shape is a value of a few numbers with pure functions of a point, relative to the body's
// centre; lengths are in whatever unit the shape was given in. Code that uses a shape is a template, so that nothing is
// dispatched in the inner loops.
//
//   S::of_grain(r)               the shape of the grain whose radius is r
//   reach()                      radius of a sphere about the centre that holds the body
//   volume()
//   chord(y, z)                  the line along x at (y, z): where missed() it holds nothing of the inside, else
//                                holds(x) says whether (x, y, z) is strictly inside
//   crossing(from, along)        the fraction t > 0 of the vector `along` at which the line from a point outside first
//                                meets the surface; none where it misses it or leads away
//   link_crossing(dx, dy, dz, cx, cy, cz)
//                                the same t for a link that is known to end inside, in the arithmetic of Number; one of
//                                a batch, so without a branch. Beyond [0, 1], or not a number, where round-off has put
//                                an end on the wrong side: the caller puts the crossing at the end
//   outward(point)               the direction of the normal through a point at the surface, of any length
//   distance_to_surface(direction)   from the centre, along a vector of any length
#pragma once

#include "core/types.hpp"

#include <concepts>
#include <optional>

namespace thalweg {

template <typename S>
concept Shape = std::copyable<S> && requires(const S shape, const Vec3 v, double x, float f) {
  { shape.reach() } -> std::same_as<double>;
  { shape.volume() } -> std::same_as<double>;
  { shape.chord(x, x).missed() } -> std::same_as<bool>;
  { shape.chord(x, x).holds(x) } -> std::same_as<bool>;
  { shape.crossing(v, v) } -> std::same_as<std::optional<double>>;
  { shape.link_crossing(x, x, x, x, x, x) } -> std::same_as<double>;
  { shape.link_crossing(f, f, f, f, f, f) } -> std::same_as<float>;
  { shape.outward(v) } -> std::same_as<Vec3>;
  { shape.distance_to_surface(v) } -> std::same_as<double>;
};

template <typename S>
concept GrainShape = Shape<S> && requires(double radius) {
  { S::of_grain(radius) } -> std::same_as<S>;
};

template <Shape S>
bool is_inside(const S& shape, const Vec3& point) {
  return shape.chord(point.y(), point.z()).holds(point.x());
}

}  // namespace thalweg
