// Force of gravity and buoyancy on the grains of a case.
#pragma once

#include "driver/case/case.hpp"

#include <functional>

namespace thalweg::driver {

using ForceOnGrain = std::function<Vec3(double mass, double radius)>;  // N, of a sphere (kg, m)

// All of gravity along the bed, to which the water's surface is parallel, and the submerged weight across it.
ForceOnGrain submerged_weight(const Case& c);

// m/s^2, of the fluid, in balanced gravity: the mean pressure gradient, which carries the submerged weight of all
// grains that are free to move, over the density of the fluid. It pulls at the whole box, at grains as at the fluid
// they displace.
Vec3 balancing_acceleration(const Case& c);

// The part of gravity that is not in the fluid's load: the submerged weight, in full gravity the whole weight, in
// balanced gravity the submerged weight less the share of the mean pressure gradient.
ForceOnGrain body_force(const Case& c);

// The submerged weight less that force, which the load of the fluid must make up for: none in reduced gravity, in full
// gravity the buoyancy of the hydrostatic pressure, along a held flow the weight of the displaced fluid.
ForceOnGrain buoyancy_in_load(const Case& c);

}  // namespace thalweg::driver
