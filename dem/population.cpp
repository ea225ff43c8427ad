#include "dem/population.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

namespace thalweg::dem {
namespace {

double volume_of(double diameter, double thickness) {
  return thickness > 0.0 ? std::numbers::pi / 4.0 * diameter * diameter * thickness : sphere_volume(diameter);
}

}  // namespace

std::int64_t Population::row_count() const {
  if (!file.empty()) return static_cast<std::int64_t>(file.size());
  return shape ? count * static_cast<std::int64_t>(shape->clump.size()) : count;
}

double Population::smallest_diameter() const {
  if (!shape) return diameters.empty() ? diameter : *std::min_element(diameters.begin(), diameters.end());
  double smallest = std::numeric_limits<double>::infinity();
  for (const MemberKeys& member : shape->clump) smallest = std::min(smallest, member.diameter);
  return smallest;
}

double Population::largest_diameter() const {
  if (!shape) return diameters.empty() ? diameter : *std::max_element(diameters.begin(), diameters.end());
  double largest = 0.0;
  for (const MemberKeys& member : shape->clump) largest = std::max(largest, member.diameter);
  return largest;
}

double Population::largest_extent() const { return std::max(largest_diameter(), clumps.largest_extent); }

double Population::lightest_mass() const {
  if (shape) return clumps.least_contact_mass;
  if (file.empty()) return density * volume_of(smallest_diameter(), thickness);
  double lightest = clumps.count > 0 ? clumps.least_contact_mass : std::numeric_limits<double>::max();
  for (const BedGrain& grain : file)
    if (grain.clump < 0) lightest = std::min(lightest, grain.density * volume_of(2.0 * grain.radius, thickness));
  return lightest;
}

double Population::volume() const {
  if (shape) return clumps.volume;
  if (diameters.empty()) return static_cast<double>(count) * volume_of(diameter, thickness);
  double sum = clumps.volume;
  for (std::size_t n = 0; n < diameters.size(); ++n)
    if (file.empty() || file[n].clump < 0) sum += volume_of(diameters[n], thickness);
  return sum;
}

}  // namespace thalweg::dem
