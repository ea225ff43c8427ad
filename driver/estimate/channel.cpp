#include "driver/estimate/channel.hpp"

#include "core/geometry/hydraulic_radius.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/bed/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::driver {

bool Channel::is_held() const { return std::isfinite(reach) || std::isfinite(half_width); }

double Channel::distance() const {
  return std::isfinite(reach) ? reach : std::isfinite(half_width) ? half_width : depth;
}

double Channel::log_of(double distance, double friction_velocity) const {
  const double zero = roughness > 0.0 ? roughness : smooth_roughness(viscosity, friction_velocity);
  return std::max(1.0, std::log(distance / zero));
}

LaminarChannel Channel::laminar(double acceleration) const {
  return laminar_channel(acceleration, is_held() ? reach : depth, half_width, viscosity);
}

Channel channel_of(const Case& c) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const double width = c.domain.size.y();
  const int walls = side_walls(c);
  const double bed = settled_height(c);
  const bool floor = c.domain.faces[bottom].drags() || (bed > 0.0 && !periodic_axes(c.domain)[2]);
  const int surfaces = floor + c.domain.faces[top].drags();
  Channel channel{};
  channel.depth = c.domain.size.z() - bed;
  // Between floor and top the water among them flows, as deep as it would be alone.
  if (held_grains_fill(c) && !periodic_axes(c.domain)[2])
    channel.depth = c.domain.size.z() - solid_volume(c) / (c.domain.size.x() * width);
  channel.reach = surfaces == 0 ? infinite : channel.depth / surfaces;
  channel.half_width = walls == 0 ? infinite : width / walls;
  channel.roughness = largest_size(c) / roughness_a_diameter;
  channel.viscosity = c.fluid.kinematic_viscosity;
  channel.radius = surfaces > 0 ? thalweg::hydraulic_radius(channel.reach, width, walls)
                   : walls > 0  ? width / walls
                                : channel.depth;
  return channel;
}

bool held_grains_fill(const Case& c) {
  if (c.grains.empty() || has_free_grains(c)) return false;
  return periodic_axes(c.domain)[2] || c.domain.size.z() - settled_height(c) < largest_size(c);
}

}  // namespace thalweg::driver
