#include "driver/estimate/flow_drive.hpp"

#include "driver/bed/bed_flow.hpp"

#include <cmath>
#include <limits>

namespace thalweg::driver {

namespace {

bool has_outlets(const Case& c, int axis) {
  const auto low = static_cast<std::size_t>(2 * axis);
  return c.domain.faces[low].type == lbm::FaceType::pressure_outlet &&
         c.domain.faces[low + 1].type == lbm::FaceType::pressure_outlet;
}

}  // namespace

const coupling::FaceKeys* inlet_of(const Case& c) {
  const auto comes_in = [&](FaceIndex face, double inwards) {
    const coupling::FaceKeys& keys = c.domain.faces[face];
    return keys.type == lbm::FaceType::velocity_inlet && inwards * keys.velocity.x() > 0.0;
  };
  if (comes_in(x_low, 1.0)) return &c.domain.faces[x_low];
  return comes_in(x_high, -1.0) ? &c.domain.faces[x_high] : nullptr;
}

Vec3 driving_gravity(const Case& c) {
  Vec3 driving = Vec3::Zero();
  if (c.gravity.mode == GravityMode::balanced) return driving;
  const Vec3 gravity = gravity_vector(c.gravity);
  for (const int axis : {0, 1})
    if (drives_flow(c, axis) && !inlet_sets_flow(c, axis)) driving[axis] = gravity[axis];
  if (c.fluid.mean_velocity) driving.x() = 0.0;
  return driving;
}

Vec3 driving_pressure(const Case& c) {
  Vec3 driving = Vec3::Zero();
  for (const int axis : {0, 1}) {
    const auto low = static_cast<std::size_t>(2 * axis);
    if (has_outlets(c, axis))
      driving[axis] =
          (c.domain.faces[low].pressure - c.domain.faces[low + 1].pressure) / (c.fluid.density * c.domain.size[axis]);
  }
  return driving;
}

Vec3 driving_acceleration(const Case& c) { return driving_gravity(c) + driving_pressure(c); }

double speed_through_outlets(const Case& c) {
  const Vec3 driving = driving_acceleration(c);
  double head = 0.0;  // m^2/s^2
  for (const int axis : {0, 1})
    if (driving[axis] != 0.0)
      head += has_outlets(c, axis) ? std::abs(driving[axis]) * c.domain.size[axis]
                                   : std::numeric_limits<double>::infinity();
  return std::sqrt(2.0 * head);
}

}  // namespace thalweg::driver
