// The volume of a sphere, or of a disk of some thickness.
#pragma once

#include <cmath>
#include <numbers>

namespace thalweg::dem {

// m^3; disk_thickness: m, 0: a sphere.
inline double grain_volume(double radius, double disk_thickness) {
  if (disk_thickness > 0.0) return std::numbers::pi * radius * radius * disk_thickness;
  return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

// m, of the sphere or disk of that volume (m^3).
inline double radius_of_volume(double volume, double disk_thickness) {
  if (disk_thickness > 0.0) return std::sqrt(volume / (std::numbers::pi * disk_thickness));
  return std::cbrt(0.75 * volume / std::numbers::pi);
}

}  // namespace thalweg::dem
