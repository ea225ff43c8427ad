#include "driver/estimate/pore_speed.hpp"

#include "beds/packing/packing.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/bed/obstacles.hpp"
#include "driver/estimate/channel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::driver {

namespace {

// The narrowest section between spheres of this solid fraction over the whole section.
double narrowest_section(double solid_fraction) {
  constexpr double apart = 0.2;  // single grains make no pores
  if (solid_fraction < apart) return 1.0;
  const double fraction = std::min(solid_fraction, beds::densest_bed);
  return 1.0 - std::numbers::pi / 4.0 * std::pow(6.0 * fraction / std::numbers::pi, 2.0 / 3.0);
}

// Solid fraction of held grains that fill the box; 0 without.
double fraction_that_fills(const Case& c) { return held_grains_fill(c) ? solid_volume(c) / c.domain.size.prod() : 0.0; }

// Solid fraction of the densest bed that fluid which enters at bottom or top has to pass.
double densest_bed_of(const Case& c) {
  double fraction = 0.0;
  for (const beds::Population& grains : c.grains) {
    const beds::RegionKeys room = region_of(c, grains);
    if (grains.held()) fraction = std::max(fraction, grains.volume() / (room.upper - room.lower).prod());
  }
  return settled_height(c) > 0.0 && has_free_grains(c) ? std::max(fraction, settled_fraction(c)) : fraction;
}

}  // namespace

double pore_speed_of_mean_velocity(const Case& c) {
  const double fraction = fraction_that_fills(c);
  if (fraction == 0.0 || !c.fluid.mean_velocity) return 0.0;
  // The mean is that of the water.
  return std::abs(c.fluid.mean_velocity->velocity) * (1.0 - fraction) / narrowest_section(fraction);
}

double pore_speed_of_inlets(const Case& c) {
  double fastest = 0.0;
  for (std::size_t face = 0; face < c.domain.faces.size(); ++face) {
    const coupling::FaceKeys& keys = c.domain.faces[face];
    if (keys.type != lbm::FaceType::velocity_inlet) continue;
    const double passed = face < bottom ? fraction_that_fills(c) : densest_bed_of(c);
    fastest = std::max(fastest, std::abs(keys.velocity[static_cast<int>(face / 2)]) / narrowest_section(passed));
  }
  return fastest;
}

}  // namespace thalweg::driver
