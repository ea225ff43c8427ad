// The sphere about the origin: which cells are inside, and where lines meet its surface. With d the point, R the
// radius, b = c.d, q = d.d - R^2, a = c.c, the line d + t c enters where a t^2 + 2 b t + q = 0. Lengths in any one
// unit.
#pragma once

#include "core/base/types.hpp"

#include <cmath>
#include <numbers>
#include <optional>

namespace thalweg {

struct Sphere {
  double radius = 0.0;

  double volume() const { return 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3); }

  // The line along x at (y, z): missed() says that it holds nothing of the inside, holds(x) whether a point is strictly
  // inside.
  struct Chord {
    double squared_y, squared_z, squared_radius;

    bool missed() const { return squared_y + squared_z >= squared_radius; }
    bool holds(double x) const { return x * x + squared_y + squared_z < squared_radius; }
  };
  Chord chord(double y, double z) const { return {y * y, z * z, radius * radius}; }

  bool holds(const Vec3& point) const { return chord(point.y(), point.z()).holds(point.x()); }

  // The fraction t > 0 of the vector `along` at which the line from a point outside first meets the surface; none where
  // it misses it or leads away.
  std::optional<double> crossing(const Vec3& from, const Vec3& along) const {
    const double a = along.squaredNorm(), b = along.dot(from), q = from.squaredNorm() - radius * radius;
    const double discriminant = b * b - a * q;
    if (b >= 0.0 || discriminant < 0.0) return std::nullopt;
    return (-b - std::sqrt(discriminant)) / a;
  }

  // Crossing t of a link that is known to end inside: the usual root, written so that nothing cancels, t = q/(sqrt(b^2
  // - a q) - b), and without a branch. Beyond [0, 1], or not a number, where round-off has put an end on the wrong
  // side: the caller puts the crossing at the end.
  template <typename Number>
  [[gnu::always_inline]] Number link_crossing(Number dx, Number dy, Number dz, Number cx, Number cy, Number cz) const {
    const Number b = cx * dx + cy * dy + cz * dz;
    const Number q = dx * dx + dy * dy + dz * dz - static_cast<Number>(radius * radius);
    const Number a = cx * cx + cy * cy + cz * cz;
    const Number discriminant = b * b - a * q;
    return q / (std::sqrt(discriminant > Number(0) ? discriminant : Number(0)) - b);
  }
};

}  // namespace thalweg
