// The sphere as a shape (shape.hpp). With d the point, R the radius, b = c.d, q = d.d - R^2, a = c.c, the line d + t c
// enters where a t^2 + 2 b t + q = 0.
#pragma once

#include "core/shape.hpp"

#include <cmath>
#include <numbers>

namespace thalweg {

struct Sphere {
  double radius = 0.0;

  static Sphere of_grain(double radius) { return {radius}; }

  double reach() const { return radius; }
  double volume() const { return 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3); }

  struct Chord {
    double squared_y, squared_z, squared_radius;

    bool missed() const { return squared_y + squared_z >= squared_radius; }
    bool holds(double x) const { return x * x + squared_y + squared_z < squared_radius; }
  };
  Chord chord(double y, double z) const { return {y * y, z * z, radius * radius}; }

  std::optional<double> crossing(const Vec3& from, const Vec3& along) const {
    const double a = along.squaredNorm(), b = along.dot(from), q = from.squaredNorm() - radius * radius;
    const double discriminant = b * b - a * q;
    if (b >= 0.0 || discriminant < 0.0) return std::nullopt;
    return (-b - std::sqrt(discriminant)) / a;
  }

  // The usual root, written so that nothing cancels: t = q/(sqrt(b^2 - a q) - b).
  template <typename Number>
  [[gnu::always_inline]] Number link_crossing(Number dx, Number dy, Number dz, Number cx, Number cy, Number cz) const {
    const Number b = cx * dx + cy * dy + cz * dz;
    const Number q = dx * dx + dy * dy + dz * dz - static_cast<Number>(radius * radius);
    const Number a = cx * cx + cy * cy + cz * cz;
    const Number discriminant = b * b - a * q;
    return q / (std::sqrt(discriminant > Number(0) ? discriminant : Number(0)) - b);
  }

  Vec3 outward(const Vec3& point) const { return point; }
  double distance_to_surface(const Vec3&) const { return radius; }
};

static_assert(GrainShape<Sphere>);

}  // namespace thalweg
