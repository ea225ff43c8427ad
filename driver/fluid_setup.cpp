// From a case to the lattice: SI to lattice units, faces to wall rules, gravity along the bed to a body force.
#include "driver/fluid_setup.hpp"

#include <cmath>

namespace thalweg::driver {

namespace {

lbm::FaceType face_type(FaceType type) {
  switch (type) {
    case FaceType::periodic:
      return lbm::FaceType::periodic;
    case FaceType::no_slip:
      return lbm::FaceType::no_slip;
    case FaceType::free_slip:
      return lbm::FaceType::free_slip;
    case FaceType::moving:
      return lbm::FaceType::moving;
    case FaceType::navier_slip:
      return lbm::FaceType::navier_slip;
    case FaceType::law_of_the_wall:
    case FaceType::law_of_the_wall_as_printed:
      return lbm::FaceType::law_of_the_wall;
    case FaceType::velocity_inlet:
      return lbm::FaceType::velocity_inlet;
    case FaceType::pressure_outlet:
      return lbm::FaceType::pressure_outlet;
  }
  return lbm::FaceType::no_slip;
}

lbm::FaceConditions face_conditions(const DomainCase& domain, const Units& units) {
  lbm::FaceConditions conditions;
  for (std::size_t face = 0; face < conditions.size(); ++face) {
    const Face& asked_for = domain.faces[face];
    lbm::FaceCondition& condition = conditions[face];
    condition.type = face_type(asked_for.type);
    condition.slip_coefficient =
        asked_for.type == FaceType::law_of_the_wall_as_printed ? lbm::printed_slip_coefficient : asked_for.coefficient;
    condition.slip_of_first_cell = asked_for.type == FaceType::law_of_the_wall && asked_for.of_first_cell;
    condition.slip_length = asked_for.slip_length / units.spacing;
    condition.on_node = asked_for.slips() && asked_for.on_node;
    condition.velocity = asked_for.velocity / units.velocity();
    condition.density_deviation = 3.0 * asked_for.pressure / units.stress();  // p = rho/3 in lattice units
  }
  return conditions;
}

// Reduced gravity: the hydrostatic pressure is taken out of the flow. The fluid is driven along the bed only. Full
// gravity: all of it acts on the fluid.
lbm::CollisionParameters collision_parameters(const Case& c) {
  lbm::CollisionParameters parameters;
  parameters.model = c.fluid.collision;
  parameters.magic_parameter = c.fluid.magic_parameter;
  parameters.relaxation_time = relaxation_time(c);
  parameters.bulk_relaxation_time = c.fluid.bulk_relaxation_time.value_or(0.0);
  parameters.smagorinsky_constant = c.fluid.smagorinsky_constant;
  const Vec3 gravity = gravity_vector(c.gravity);
  const int axes = c.gravity.mode == GravityMode::full ? 3 : 2;
  for (int a = 0; a < axes; ++a) parameters.force[a] = gravity[a] / units_of(c).acceleration();
  return parameters;
}

}  // namespace

coupling::FluidParameters fluid_parameters(const Case& c) {
  coupling::FluidParameters parameters;
  parameters.units = units_of(c);
  parameters.collision = collision_parameters(c);
  parameters.full_gravity = c.gravity.mode == GravityMode::full;
  parameters.ramp = c.run.ramp / parameters.units.time_step;
  parameters.faces = face_conditions(c.domain, parameters.units);
  if (c.fluid.mean_velocity)
    parameters.flow_target =
        lbm::FlowTarget{.axis = 0,
                        .velocity = c.fluid.mean_velocity->velocity / parameters.units.velocity(),
                        .response_time = c.fluid.mean_velocity->response_time / parameters.units.time_step};
  parameters.links.momentum_exchange = c.coupling.momentum_exchange;
  parameters.links.wall_density = c.coupling.wall_density;
  parameters.links.rule = c.coupling.links;
  parameters.links.gaps = c.coupling.narrow_gaps;
  parameters.initial_fluid =
      initial_fluid(c.initial.fluid, cells_of(c.domain), periodic_axes(c.domain), c.domain.spacing);
  return parameters;
}

}  // namespace thalweg::driver
