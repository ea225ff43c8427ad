#include "beds/population/population.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

namespace thalweg::beds {
void ClumpFigures::add(const ClumpFigures& more) {
  least_contact_mass = count == 0 ? more.least_contact_mass : std::min(least_contact_mass, more.least_contact_mass);
  shortest_axis = count == 0 ? more.shortest_axis : std::min(shortest_axis, more.shortest_axis);
  count += more.count;
  volume += more.volume;
  largest_extent = std::max(largest_extent, more.largest_extent);
}

double Population::volume_of(double grain_diameter) const {
  return thickness > 0.0 ? std::numbers::pi / 4.0 * grain_diameter * grain_diameter * thickness
                         : sphere_volume(grain_diameter);
}

std::vector<SizeCount> Population::sizes_of_grains() const {
  if (from_file()) return figures.sizes;
  if (diameters.empty()) return {{diameter, count}};
  return counted(diameters);
}

std::int64_t Population::row_count() const {
  if (from_file()) return figures.rows;
  return shape ? count * static_cast<std::int64_t>(shape->clump.size()) : count;
}

double Population::finest() const {
  if (from_file()) return figures.sizes.front().diameter;
  return diameters.empty() ? diameter : *std::min_element(diameters.begin(), diameters.end());
}

double Population::coarsest() const {
  if (from_file()) return figures.sizes.back().diameter;
  return diameters.empty() ? diameter : *std::max_element(diameters.begin(), diameters.end());
}

namespace {

double largest_member(const ShapeKeys& shape) {
  double largest = 0.0;
  for (const MemberKeys& member : shape.clump) largest = std::max(largest, member.diameter);
  return largest;
}

}  // namespace

double Population::smallest_diameter() const {
  if (from_file()) return figures.smallest_diameter;
  if (!shape) return finest();
  double smallest = std::numeric_limits<double>::infinity();
  for (const MemberKeys& member : shape->clump) smallest = std::min(smallest, member.diameter);
  return smallest * scale_of(finest());
}

double Population::largest_diameter() const {
  if (from_file()) return figures.largest_diameter;
  return shape ? largest_member(*shape) * scale_of(coarsest()) : coarsest();
}

double Population::largest_extent() const { return std::max(largest_diameter(), clumps.largest_extent); }

double Population::narrowest() const {
  if (clumps.count == 0) return smallest_diameter();
  return clumps.count == count ? clumps.shortest_axis : std::min(clumps.shortest_axis, smallest_diameter());
}

double Population::lightest_mass() const {
  if (shape) return clumps.least_contact_mass;
  if (from_file())
    return clumps.count > 0 ? std::min(clumps.least_contact_mass, figures.lightest_grain) : figures.lightest_grain;
  return density * volume_of(smallest_diameter());
}

double Population::radius_per_mass() const {
  if (shape) return 0.5 * largest_member(*shape) * scale_of(finest()) / clumps.least_contact_mass;
  if (!from_file()) return 0.5 * smallest_diameter() / lightest_mass();
  const double of_members = clumps.count > 0 ? figures.largest_member / clumps.least_contact_mass : 0.0;
  return std::max(figures.radius_per_mass, of_members);
}

double Population::volume() const {
  if (shape) return clumps.volume;
  if (from_file()) return figures.volume;
  if (diameters.empty()) return static_cast<double>(count) * volume_of(diameter);
  double sum = 0.0;
  for (const double d : diameters) sum += volume_of(d);
  return sum;
}

}  // namespace thalweg::beds
