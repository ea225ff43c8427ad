#include "driver/bed/reference_grain.hpp"

#include <fmt/format.h>

namespace thalweg::driver {
namespace {

std::vector<const beds::Population*> populations_that_count(const Case& c) {
  std::vector<const beds::Population*> chosen;
  for (const std::size_t p : free_populations(c)) chosen.push_back(&c.grains[p]);
  return chosen;
}

double mean_density(const std::vector<const beds::Population*>& populations) {
  const double first = populations.front()->density;
  double mass = 0.0, volume = 0.0;
  bool alike = true;  // exactly the density given, then, and not rounded by the division
  for (const beds::Population* population : populations) {
    alike = alike && population->density == first;
    mass += population->density * population->volume();
    volume += population->volume();
  }
  return alike ? first : mass / volume;
}

}  // namespace

ReferenceGrain reference_grain(const Case& c) {
  const std::vector<const beds::Population*> populations = populations_that_count(c);
  const double density = mean_density(populations);
  if (c.analysis.reference_diameter) return {*c.analysis.reference_diameter, density};
  return {beds::median_by_mass(represented_sizes(c), c.disks.has_value()), density};
}

std::vector<beds::SizeCount> represented_sizes(const Case& c) {
  std::vector<beds::SizeCount> sizes;
  for (const beds::Population* population : populations_that_count(c)) {
    const std::vector<beds::SizeCount> more = population->sizes_of_grains();
    sizes.insert(sizes.end(), more.begin(), more.end());
  }
  return beds::merged(std::move(sizes));
}

std::string reference_text(const Case& c) {
  const ReferenceGrain grain = reference_grain(c);
  const bool all_held = c.grains[free_populations(c).front()].held();
  return fmt::format("diameter {:.6g} m, density {:.6g} kg/m^3 ({})", grain.diameter, grain.density,
                     c.analysis.reference_diameter ? "analysis.reference_diameter"
                     : all_held                    ? "volume median of all grains"
                                                   : "volume median of all free grains");
}

}  // namespace thalweg::driver
