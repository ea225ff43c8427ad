#include "driver/estimate/settling.hpp"

#include "driver/bed/bed_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::driver {

namespace {

// m/s, of the largest grain of a population.
double settling_velocity_of(const Case& c, const beds::Population& grains) {
  return settling_velocity(largest_size(grains), grains.density / c.fluid.density, gravity_vector(c.gravity).norm(),
                           c.fluid.kinematic_viscosity);
}

}  // namespace

double settling_velocity(double diameter, double density_ratio, double gravity, double viscosity) {
  const double weight = std::abs(density_ratio - 1.0) * gravity * diameter;  // 3/4 C_D v^2
  if (!(weight > 0.0)) return 0.0;
  const auto resistance = [&](double velocity) {
    const double reynolds = velocity * diameter / viscosity;
    const double drag = reynolds < 1000.0 ? 24.0 / reynolds * (1.0 + 0.15 * std::pow(reynolds, 0.687)) : 0.44;
    return 0.75 * drag * velocity * velocity;
  };
  double low = 0.0, high = std::sqrt(weight / (0.75 * 0.3)) + weight * diameter / (18.0 * viscosity);
  for (int n = 0; n < 100; ++n) {
    const double middle = 0.5 * (low + high);
    (resistance(middle) < weight ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double settling_velocity(const Case& c) {
  double fastest = 0.0;
  if (!has_fluid(c)) return fastest;
  for (const beds::Population& grains : c.grains)
    if (!grains.held()) fastest = std::max(fastest, settling_velocity_of(c, grains));
  return fastest;
}

double falling_speed(const Case& c, const beds::Population& grains) {
  const double terminal = settling_velocity_of(c, grains);
  const Vec3 gravity = gravity_vector(c.gravity);
  double farthest = std::numeric_limits<double>::infinity();  // m
  for (const int axis : {0, 1, 2})
    if (!periodic_axes(c.domain)[static_cast<std::size_t>(axis)] && gravity[axis] != 0.0)
      farthest = std::min(farthest, c.domain.size[axis] * gravity.norm() / std::abs(gravity[axis]));
  if (!(terminal > 0.0) || !std::isfinite(farthest)) return terminal;
  return std::min(terminal,
                  std::sqrt(2.0 * gravity.norm() * std::abs(1.0 - c.fluid.density / grains.density) * farthest));
}

double falling_speed(const Case& c) {
  double fastest = 0.0;
  if (!has_fluid(c)) return fastest;
  for (const beds::Population& grains : c.grains)
    if (!grains.held()) fastest = std::max(fastest, falling_speed(c, grains));
  return fastest;
}

}  // namespace thalweg::driver
