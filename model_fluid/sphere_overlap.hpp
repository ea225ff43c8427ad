// The volume (area) that two spheres (disks) have in common, and the part of one that lies above a plane. Exact, any
// unit of length. No branches, so that loops over many pairs vectorise.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace thalweg::model_fluid {

// The distance d of two centres, clamped to the range in which their surfaces meet: [|a - b|, a + b].
inline double distance_while_they_meet(double a, double b, double d) {
  const double sum = a + b, least = std::max(std::abs(a - b), 1e-12 * sum);
  return std::min(std::max(d, least), sum);
}

// Volume common to two spheres of radii a and b whose centres lie a distance d apart:
//   pi (a + b - d)^2 (d^2 + 2 d (a + b) - 3 (a - b)^2)/(12 d)
inline double common_volume(double a, double b, double distance) {
  const double d = distance_while_they_meet(a, b, distance);
  const double depth = a + b - d, difference = a - b;
  return std::numbers::pi / 12.0 * depth * depth * (d * d + 2.0 * d * (a + b) - 3.0 * difference * difference) / d;
}

// Area of the segment of the unit disk beyond a chord at the distance c from its centre, -1 <= c <= 1:
//   acos(c) - c sqrt(1 - c^2) = (1 - c)^(3/2) p(c) where c >= 0,
// with a Chebyshev approximation of p that leaves 2e-16.
inline double unit_segment(double c) {
  constexpr std::array p{1.5707963267948968,      0.35619449019228533,    -0.05475688725380495,
                         0.019450297975248665,    -0.009368410001540668,  0.005319687577832076,
                         -0.0033510590316197277,  0.0022657210237506716,  -0.001606449216284652,
                         0.0011641292667304536,   -0.0008292897689378422, 0.0005489586728236075,
                         -0.00031512105085318497, 0.00014519706011513887, -4.900731721218713e-05,
                         1.0583958791017812e-05,  -1.0857180937779025e-06};
  const double distance = std::abs(c), rest = 1.0 - distance;
  double sum = p.back();
  for (std::size_t n = p.size() - 1; n-- > 0;) sum = sum * distance + p[n];
  const double area = rest * std::sqrt(rest) * sum;
  return c < 0.0 ? std::numbers::pi - area : area;
}

// Area common to two disks: the two circular segments on either side of the common chord, at x from the first centre.
inline double common_area(double a, double b, double distance) {
  const double d = distance_while_they_meet(a, b, distance), x = 0.5 * (d + (a - b) * (a + b) / d);
  const double from_first = std::min(std::max(x / a, -1.0), 1.0);
  const double from_second = std::min(std::max((d - x) / b, -1.0), 1.0);
  return a * a * unit_segment(from_first) + b * b * unit_segment(from_second);
}

// Volume above a plane of a sphere of radius a whose centre lies h above it: pi/3 (a + h)^2 (2 a - h).
inline double volume_above(double a, double h) {
  const double height = std::clamp(h, -a, a);
  return std::numbers::pi / 3.0 * (a + height) * (a + height) * (2.0 * a - height);
}

// Area above it of a disk upright on the plane.
inline double area_above(double a, double h) { return a * a * unit_segment(std::clamp(-h / a, -1.0, 1.0)); }

}  // namespace thalweg::model_fluid
