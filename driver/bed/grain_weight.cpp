#include "driver/bed/grain_weight.hpp"

#include "dem/motion/grain_volume.hpp"

namespace thalweg::driver {

namespace {

double displaced_mass(double fluid_density, double radius) { return fluid_density * dem::grain_volume(radius, 0.0); }

}  // namespace

ForceOnGrain submerged_weight(const Case& c) {
  return [gravity = gravity_vector(c.gravity), density = c.fluid.density](double mass, double radius) {
    const double displaced = displaced_mass(density, radius);
    return Vec3(mass * gravity.x(), mass * gravity.y(), (mass - displaced) * gravity.z());
  };
}

Vec3 balancing_acceleration(const Case& c) {
  double excess = 0.0;  // kg
  for (const beds::Population& grains : c.grains)
    if (!grains.held()) excess += (grains.density - c.fluid.density) * grains.volume();
  return -excess / (c.fluid.density * c.domain.size.prod()) * gravity_vector(c.gravity);
}

namespace {

// Force by gravity.mode alone.
ForceOnGrain weight_by_mode(const Case& c) {
  const Vec3 gravity = gravity_vector(c.gravity);
  if (c.gravity.mode == GravityMode::full) return [gravity](double mass, double) { return Vec3(mass * gravity); };
  if (c.gravity.mode == GravityMode::reduced) return submerged_weight(c);
  return [gravity, carried = balancing_acceleration(c), density = c.fluid.density](double mass, double radius) {
    const double displaced = displaced_mass(density, radius);
    return Vec3((mass - displaced) * gravity + displaced * carried);
  };
}

}  // namespace

// The pressure gradient that holds a flow carries the weight of the fluid along x as well; the rest of it is the force
// on the fluid, which changes from step to step (coupling::FluidParameters::target_moves_grains).
ForceOnGrain body_force(const Case& c) {
  const ForceOnGrain weight = weight_by_mode(c);
  if (!c.fluid.mean_velocity || !c.fluid.mean_velocity->on_grains) return weight;
  return [weight, along = gravity_vector(c.gravity).x(), density = c.fluid.density](double mass, double radius) {
    Vec3 force = weight(mass, radius);
    force.x() = (mass - displaced_mass(density, radius)) * along;
    return force;
  };
}

ForceOnGrain buoyancy_in_load(const Case& c) {
  return [submerged = submerged_weight(c), applied = body_force(c)](double mass, double radius) {
    return Vec3(submerged(mass, radius) - applied(mass, radius));
  };
}

}  // namespace thalweg::driver
