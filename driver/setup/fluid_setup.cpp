// The lattice of a case: SI to lattice units, faces to wall rules, gravity along the bed to a body force.
#include "driver/setup/fluid_setup.hpp"

#include "driver/bed/grain_weight.hpp"

#include <cmath>

namespace thalweg::driver {

namespace {

// m/s^2. Reduced gravity: the hydrostatic pressure is taken out of the flow, which is driven along the bed only. Full
// gravity: all of it acts on the fluid. Balanced gravity: the mean pressure gradient alone.
Vec3 driving_acceleration(const Case& c) {
  const Vec3 gravity = gravity_vector(c.gravity);
  switch (c.gravity.mode) {
    case GravityMode::full:
      return gravity;
    case GravityMode::balanced:
      return balancing_acceleration(c);
    case GravityMode::reduced:
      break;
  }
  return {gravity.x(), gravity.y(), 0.0};
}

lbm::CollisionParameters collision_parameters(const Case& c) {
  lbm::CollisionParameters parameters;
  parameters.model = c.fluid.collision;
  parameters.magic_parameter = c.fluid.magic();
  parameters.relaxation_time = relaxation_time(c);
  parameters.bulk_relaxation_time = c.fluid.bulk_relaxation_time.value_or(0.0);
  parameters.subgrid = c.fluid.subgrid();
  const Vec3 acceleration = driving_acceleration(c);
  for (int a = 0; a < 3; ++a) parameters.force[a] = acceleration[a] / units_of(c).acceleration();
  return parameters;
}

}  // namespace

coupling::FluidParameters fluid_parameters(const Case& c) {
  coupling::FluidParameters parameters;
  parameters.units = units_of(c);
  parameters.collision = collision_parameters(c);
  parameters.full_gravity = c.gravity.mode == GravityMode::full;
  parameters.ramp = c.run.ramp / parameters.units.time_step;
  parameters.faces = coupling::conditions_of(c.domain.faces, parameters.units);
  if (c.fluid.mean_velocity)
    parameters.flow_target =
        lbm::FlowTarget{.axis = 0,
                        .velocity = c.fluid.mean_velocity->velocity / parameters.units.velocity(),
                        .response_time = c.fluid.mean_velocity->response_time / parameters.units.time_step};
  parameters.target_moves_grains = c.fluid.mean_velocity && c.fluid.mean_velocity->on_grains;
  parameters.bodies.links.momentum_exchange = c.coupling.momentum_exchange;
  parameters.bodies.links.rule = c.coupling.links;
  parameters.initial_fluid =
      initial_fluid(c.initial.fluid, cells_of(c.domain), periodic_axes(c.domain), c.domain.spacing);
  return parameters;
}

}  // namespace thalweg::driver
