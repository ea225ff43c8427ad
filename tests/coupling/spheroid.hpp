// A shape that the library does not know (core/shape.hpp): a spheroid twice as long along x as it is wide, of the
// volume of a sphere. Scaled by its half axes it is the unit sphere.
#pragma once

#include "core/sphere.hpp"

namespace thalweg::coupling {

struct Spheroid {
  double a = 0.0, b = 0.0;  // half axes along x and across it

  static constexpr double aspect = 2.0;
  static Spheroid of_grain(double radius) {
    return {radius * std::pow(aspect, 2.0 / 3.0), radius * std::pow(aspect, -1.0 / 3.0)};
  }

  double reach() const { return a; }
  double volume() const { return 4.0 / 3.0 * std::numbers::pi * a * b * b; }

  struct Chord {
    double half_axis, rest;

    bool missed() const { return rest <= 0.0; }
    bool holds(double x) const { return x * x < half_axis * half_axis * rest; }
  };
  Chord chord(double y, double z) const { return {a, 1.0 - (y * y + z * z) / (b * b)}; }

  std::optional<double> crossing(const Vec3& from, const Vec3& along) const {
    return Sphere{1.0}.crossing(scaled(from), scaled(along));
  }
  template <typename Number>
  [[gnu::always_inline]] Number link_crossing(Number dx, Number dy, Number dz, Number cx, Number cy, Number cz) const {
    const auto p = static_cast<Number>(1.0 / a), q = static_cast<Number>(1.0 / b);
    return Sphere{1.0}.link_crossing(p * dx, q * dy, q * dz, p * cx, q * cy, q * cz);
  }

  Vec3 outward(const Vec3& point) const { return scaled(scaled(point)); }
  double distance_to_surface(const Vec3& direction) const { return direction.norm() / scaled(direction).norm(); }

private:
  Vec3 scaled(const Vec3& v) const { return {v.x() / a, v.y() / b, v.z() / b}; }
};

static_assert(GrainShape<Spheroid>);

}  // namespace thalweg::coupling
