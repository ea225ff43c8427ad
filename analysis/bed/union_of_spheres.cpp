#include "analysis/bed/union_of_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg::analysis {

namespace {

constexpr double rows_a_radius = 20.0, most_rows = 500.0;

using Chord = std::pair<double, double>;  // m, along x, inside the box

// The part of a chord inside the box, or through its periodic faces the parts.
void add_chord(const PeriodicBox& box, double lower, double upper, std::vector<Chord>& chords) {
  const double length = box.size.x();
  for (const double shift : {-length, 0.0, length}) {
    if (shift != 0.0 && !box.periodic[0]) continue;
    const double from = std::max(0.0, lower + shift), to = std::min(length, upper + shift);
    if (from < to) chords.emplace_back(from, to);
  }
}

// m, of the union; sorts the chords.
double length_of(std::vector<Chord>& chords) {
  std::sort(chords.begin(), chords.end());
  double length = 0.0, end = 0.0;
  for (const auto& [from, to] : chords) {
    length += std::max(0.0, to - std::max(from, end));
    end = std::max(end, to);
  }
  return length;
}

// m, across the rows; the nearest image.
double distance_along_y(const PeriodicBox& box, double a, double b) {
  const double apart = std::abs(a - b);
  return box.periodic[1] ? std::min(apart, box.size.y() - apart) : apart;
}

// m^2, of the sections of the spheres at the height z.
double section_area(const PeriodicBox& box, std::span<const SphereInBed> spheres, double z, int rows) {
  const double width = box.size.y() / rows;
  std::vector<SphereInBed> cut;
  for (const SphereInBed& sphere : spheres)
    if (std::abs(sphere.centre[2] - z) < sphere.radius) cut.push_back(sphere);
  double length = 0.0;
  std::vector<Chord> chords;
  for (int row = 0; row < rows && !cut.empty(); ++row) {
    chords.clear();
    for (const SphereInBed& sphere : cut) {
      const double y = distance_along_y(box, sphere.centre[1], (row + 0.5) * width), up = sphere.centre[2] - z;
      const double square = sphere.radius * sphere.radius - y * y - up * up;
      if (square <= 0.0) continue;
      const double half = std::sqrt(square);
      add_chord(box, sphere.centre[0] - half, sphere.centre[0] + half, chords);
    }
    length += length_of(chords);
  }
  return length * width;
}

}  // namespace

std::vector<double> union_below(const PeriodicBox& box, std::span<const SphereInBed> spheres, int layers) {
  std::vector<double> below(static_cast<std::size_t>(layers) + 1, 0.0);
  if (spheres.empty()) return below;
  const auto smallest = std::min_element(spheres.begin(), spheres.end(),
                                         [](const auto& a, const auto& b) { return a.radius < b.radius; });
  const double thickness = box.size.z() / layers;
  const double finest = std::max(smallest->radius / rows_a_radius, box.size.tail<2>().maxCoeff() / most_rows);
  const int rows = static_cast<int>(std::ceil(box.size.y() / finest));
  const int heights = static_cast<int>(std::ceil(thickness / finest));  // a layer
  for (std::size_t layer = 0; layer + 1 < below.size(); ++layer) {
    double area = 0.0;
    for (int n = 0; n < heights; ++n)
      area += section_area(box, spheres, (static_cast<double>(layer) + (n + 0.5) / heights) * thickness, rows);
    below[layer + 1] = below[layer] + area * thickness / heights;
  }
  return below;
}

}  // namespace thalweg::analysis
