#include "driver/bed_flow.hpp"

#include "dem/packing.hpp"
#include "driver/reference_grain.hpp"

#include <cmath>
#include <limits>

namespace thalweg::driver {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

FlowNumbers flow_numbers(const Case& c) {
  FlowNumbers flow{nothing, nothing, nothing, nothing, 0, nothing, nothing, nothing, nothing, nothing, nothing};
  if (!has_fluid(c) || c.grains.empty()) return flow;
  const Vec3 gravity = gravity_vector(c.gravity);
  const ReferenceGrain grain = reference_grain(c);
  const double g = gravity.norm(), d = grain.diameter;
  flow.density_ratio = grain.density / c.fluid.density;
  const double excess = flow.density_ratio - 1.0;
  flow.galileo = std::sqrt(std::abs(excess) * g * d * d * d) / c.fluid.kinematic_viscosity;
  if (gravity.z() >= 0.0 || excess <= neutral_density || periodic_axes(c.domain)[2]) return flow;

  flow.slope = gravity.x() / -gravity.z();
  flow.bed_height = settled_height(c);
  flow.depth = c.domain.size.z() - flow.bed_height;
  if (flow.depth <= 0.0 || gravity.x() <= 0.0 || !periodic_axes(c.domain)[0] || c.fluid.mean_velocity) return flow;
  flow.side_walls = side_walls(c);
  flow.hydraulic_radius = hydraulic_radius(c, flow.depth);
  flow.shields_depth = gravity.x() * flow.depth / (excess * g * d);
  flow.shields_hydraulic = gravity.x() * flow.hydraulic_radius / (excess * g * d);
  flow.friction_velocity = std::sqrt(gravity.x() * flow.hydraulic_radius);
  flow.particle_reynolds = flow.friction_velocity * d / c.fluid.kinematic_viscosity;
  return flow;
}

double slope_for(const FlowNumbers& flow, double shields) {
  const double sine = std::sin(std::atan(flow.slope)) / flow.shields_hydraulic * shields;
  return sine < 1.0 ? std::tan(std::asin(sine)) : std::numeric_limits<double>::infinity();
}

double settled_height(const Case& c) {
  if (gravity_vector(c.gravity).z() == 0.0) return 0.0;
  return grain_volume(c) / (settled_fraction(c) * c.domain.size.x() * c.domain.size.y());
}

bool drives_flow(const Case& c, int axis) {
  const auto lets_through = [](const coupling::FaceKeys& face) {
    return face.type == lbm::FaceType::periodic || lbm::is_open(face.type);
  };
  const auto low = static_cast<std::size_t>(2 * axis);
  return lets_through(c.domain.faces[low]) && lets_through(c.domain.faces[low + 1]);
}

int side_walls(const Case& c) { return c.domain.faces[y_low].drags() + c.domain.faces[y_high].drags(); }

double hydraulic_radius(const Case& c, double depth) {
  const double width = c.domain.size.y();
  const int walls = side_walls(c);
  return walls == 0 ? depth : depth * width / (walls * depth + width);
}

double settled_fraction(const Case& c) {
  const bool between_walls =
      c.domain.faces[y_low].type != lbm::FaceType::periodic && c.domain.faces[y_high].type != lbm::FaceType::periodic;
  const bool narrow = !c.grains.empty() && c.domain.size.y() < 3.0 * reference_grain(c).diameter;
  return between_walls && narrow ? 0.554 : dem::settled_bed;
}

}  // namespace thalweg::driver
