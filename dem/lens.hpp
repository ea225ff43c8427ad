// What two spheres, or two disks, have in common, and what of one lies above a plane. Exact, any unit of length.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::dem {

// Volume common to two spheres of radii a and b whose centres lie a distance d apart:
//   pi (a + b - d)^2 (d^2 + 2 d (a + b) - 3 (a - b)^2)/(12 d)
inline double common_volume(double a, double b, double d) {
  if (d >= a + b) return 0.0;
  const double smaller = std::min(a, b);
  if (d <= std::abs(a - b)) return 4.0 / 3.0 * std::numbers::pi * smaller * smaller * smaller;
  const double depth = a + b - d, difference = a - b;
  return std::numbers::pi * depth * depth * (d * d + 2.0 * d * (a + b) - 3.0 * difference * difference) / (12.0 * d);
}

// Area common to two disks: the two circular segments on either side of the common chord, at x from the first centre.
inline double common_area(double a, double b, double d) {
  if (d >= a + b) return 0.0;
  const double smaller = std::min(a, b);
  if (d <= std::abs(a - b)) return std::numbers::pi * smaller * smaller;
  const double x = (d * d + a * a - b * b) / (2.0 * d);
  const auto segment = [](double radius, double distance) {
    const double cosine = std::clamp(distance / radius, -1.0, 1.0);
    return radius * radius * (std::acos(cosine) - cosine * std::sqrt(1.0 - cosine * cosine));
  };
  return segment(a, x) + segment(b, d - x);
}

// Of a sphere of radius a whose centre lies h above a plane: pi/3 (a + h)^2 (2 a - h).
inline double volume_above(double a, double h) {
  const double height = std::clamp(h, -a, a);
  return std::numbers::pi / 3.0 * (a + height) * (a + height) * (2.0 * a - height);
}

// Of a disk upright on the plane.
inline double area_above(double a, double h) {
  const double sine = std::clamp(h / a, -1.0, 1.0);
  return a * a * (0.5 * std::numbers::pi + std::asin(sine) + sine * std::sqrt(1.0 - sine * sine));
}

}  // namespace thalweg::dem
