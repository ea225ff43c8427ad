// From a case to grains in a resolved flow: SI to lattice units, faces to wall rules, gravity to its two parts.
#include "core/mpi_session.hpp"
#include "coupling/resolved_system.hpp"
#include "driver/build_system.hpp"
#include "driver/grain_setup.hpp"

#include <cmath>
#include <numbers>

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
    condition.slip_length = asked_for.slip_length / units.spacing;
    condition.on_node = asked_for.slips() && asked_for.on_node;
    condition.velocity = asked_for.velocity / units.velocity();
    condition.density_deviation = 3.0 * asked_for.pressure / units.stress();  // p = rho/3 in lattice units
  }
  return conditions;
}

lbm::CollisionModel collision_model(Collision collision) {
  switch (collision) {
    case Collision::bgk:
      return lbm::CollisionModel::bgk;
    case Collision::trt:
      return lbm::CollisionModel::trt;
    case Collision::regularised:
      return lbm::CollisionModel::regularised;
  }
  return lbm::CollisionModel::bgk;
}

// Reduced gravity: the hydrostatic pressure is taken out of the flow. The fluid is driven along the bed only; a grain
// feels all of gravity along the bed (the water's surface is parallel to it) and its submerged weight across it.
lbm::CollisionParameters collision_parameters(const Case& c) {
  lbm::CollisionParameters parameters;
  parameters.model = collision_model(c.fluid.collision);
  parameters.magic_parameter = c.fluid.magic_parameter;
  parameters.relaxation_time = relaxation_time(c);
  parameters.smagorinsky_constant = c.fluid.smagorinsky_constant;
  const Vec3 gravity = gravity_vector(c.gravity);
  for (int a = 0; a < 2; ++a) parameters.force[a] = gravity[a] / units_of(c).acceleration();
  return parameters;
}

Vec3 reduced_weight(const Vec3& gravity, double fluid_density, double mass, double radius) {
  const double displaced = fluid_density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  return {mass * gravity.x(), mass * gravity.y(), (mass - displaced) * gravity.z()};
}

std::function<coupling::FluidInitialState(const Vec3&)> initial_fluid(const InitialFluidCase& fluid) {
  if (fluid.uniform) return [u = *fluid.uniform](const Vec3&) { return coupling::FluidInitialState{0.0, u}; };
  if (!fluid.log_profile) return {};
  return [profile = *fluid.log_profile](const Vec3& position) {
    constexpr double von_karman = 0.41;
    const double height = position.z() - profile.bed_height;
    coupling::FluidInitialState state;
    if (height > profile.roughness)
      state.velocity.x() = profile.shear_velocity / von_karman * std::log(height / profile.roughness);
    return state;
  };
}

template <typename Real>
std::unique_ptr<System> build(const Case& c, MPI_Comm communicator, const Index3& layout) {
  auto decomposition = std::make_unique<Decomposition>(decomposition_of(c, layout));
  coupling::ResolvedParameters parameters;
  parameters.units = units_of(c);
  parameters.collision = collision_parameters(c);
  parameters.faces = face_conditions(c.domain, parameters.units);
  if (c.fluid.mean_velocity)
    parameters.flow_target =
        lbm::FlowTarget{.axis = 0,
                        .velocity = c.fluid.mean_velocity->velocity / parameters.units.velocity(),
                        .response_time = c.fluid.mean_velocity->response_time / parameters.units.time_step};
  parameters.links.momentum_exchange = c.coupling.momentum_exchange == MomentumExchange::classical
                                           ? lbm::MomentumExchange::classical
                                           : lbm::MomentumExchange::galilean_invariant;
  parameters.links.wall_density =
      c.coupling.wall_density == WallDensity::reference ? lbm::WallDensity::reference : lbm::WallDensity::local;
  parameters.link_tolerance = c.coupling.link_tolerance;
  parameters.sub_steps = static_cast<int>(c.coupling.grain_steps_per_fluid_step);
  parameters.initial_fluid = initial_fluid(c.initial.fluid);

  using System = coupling::ResolvedSystem<Real>;
  dem::GrainParameters grains = grain_parameters(c, decomposition->box());
  grains.body_force = [gravity = gravity_vector(c.gravity), density = c.fluid.density](double mass, double radius) {
    return reduced_weight(gravity, density, mass, radius);
  };
  grains.ghost_width = System::ghost_reach(0.5 * largest_diameter(c), c.domain.spacing);
  grains.attached_width = System::attached_width;
  auto dynamics = std::make_unique<dem::GrainDynamics>(*decomposition, communicator, grains, grain_seeds(c));
  return std::make_unique<System>(std::move(decomposition), communicator, parameters, std::move(dynamics));
}

}  // namespace

std::unique_ptr<System> build_resolved_system(const Case& c, MPI_Comm communicator, const Index3& layout) {
  return c.fluid.precision == Precision::single ? build<float>(c, communicator, layout)
                                                : build<double>(c, communicator, layout);
}

}  // namespace thalweg::driver
