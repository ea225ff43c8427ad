// The volume of a sphere, or of a disk of some thickness.
#pragma once

#include <numbers>

namespace thalweg::dem {

// m^3; disk_thickness: m, 0: a sphere.
inline double grain_volume(double radius, double disk_thickness) {
  if (disk_thickness > 0.0) return std::numbers::pi * radius * radius * disk_thickness;
  return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

}  // namespace thalweg::dem
