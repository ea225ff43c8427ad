// Volume of a sphere or disk between two heights, and its first moment: exact.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::analysis {

// Volume (m^3) of a sphere's part up to `height` (m) above its lowest point.
inline double sphere_volume_below(double radius, double height) {
  const double h = std::clamp(height, 0.0, 2.0 * radius);
  return std::numbers::pi / 3.0 * h * h * (3.0 * radius - h);
}

// First moment (m^4) of the same part about the lowest point: the integral of s dV over 0 < s < height.
inline double sphere_moment_below(double radius, double height) {
  const double h = std::clamp(height, 0.0, 2.0 * radius);
  return std::numbers::pi * h * h * h * (2.0 / 3.0 * radius - 0.25 * h);
}

// Volume (m^3) of the same part of an upright disk of this thickness (m).
inline double disk_volume_below(double radius, double thickness, double height) {
  const double h = std::clamp(height, 0.0, 2.0 * radius), off = radius - h;
  const double angle = std::acos(std::clamp(off / radius, -1.0, 1.0));
  return thickness * (radius * radius * angle - off * std::sqrt(std::max(0.0, h * (2.0 * radius - h))));
}

// Volume between two heights above the lowest point; thickness 0: a sphere.
inline double volume_between(double radius, double thickness, double lower, double upper) {
  if (thickness > 0.0) return disk_volume_below(radius, thickness, upper) - disk_volume_below(radius, thickness, lower);
  return sphere_volume_below(radius, upper) - sphere_volume_below(radius, lower);
}

inline double volume_of(double radius, double thickness) {
  return volume_between(radius, thickness, 0.0, 2.0 * radius);
}

}  // namespace thalweg::analysis
