// From a case to grains in a resolved flow.
#include "coupling/resolved_system.hpp"
#include "driver/build_system.hpp"
#include "driver/fluid_setup.hpp"
#include "driver/grain_setup.hpp"
#include "driver/grain_weight.hpp"

namespace thalweg::driver {

namespace {

template <typename Real>
std::unique_ptr<System> build_resolved(const Case& c, MPI_Comm communicator, const Decomposition& cuts, Start start) {
  auto decomposition = std::make_unique<Decomposition>(cuts);
  coupling::ResolvedParameters parameters;
  static_cast<coupling::FluidParameters&>(parameters) = fluid_parameters(c);
  parameters.link_tolerance = c.coupling.link_tolerance;
  parameters.load = c.coupling.load_rule();
  parameters.bodies.keep_covered_momentum = c.coupling.covered_momentum == coupling::CoveredMomentum::to_grain;
  parameters.bodies.refill = c.coupling.refill;
  parameters.bodies.moments = measures_grain_stress(c);
  parameters.wall_forces = c.analysis.wall_forces.has_value();
  parameters.sub_steps = static_cast<int>(grain_steps(c));

  if (c.coupling.virtual_mass)
    parameters.virtual_mass = coupling::VirtualMass{c.coupling.virtual_mass->coefficient, c.fluid.density};

  using System = coupling::ResolvedSystem<Real>;
  dem::GrainParameters grains = grain_parameters(c, decomposition->box());
  grains.body_force = body_force(c);
  grains.ghost_width = System::ghost_reach(0.5 * largest_diameter(c), c.domain.spacing);
  grains.attached_width = System::attached_width(parameters);
  dem::GrainSeeds seeds;
  if (start == Start::as_placed) seeds = grain_seeds(c, communicator, *decomposition);
  auto dynamics = std::make_unique<dem::GrainDynamics>(*decomposition, communicator, grains, std::move(seeds));
  return std::make_unique<System>(std::move(decomposition), communicator, parameters, std::move(dynamics));
}

}  // namespace

std::unique_ptr<System> build_resolved_system(const Case& c, MPI_Comm communicator, const Decomposition& cuts,
                                              Start start) {
  return c.fluid.precision == coupling::Precision::single ? build_resolved<float>(c, communicator, cuts, start)
                                                          : build_resolved<double>(c, communicator, cuts, start);
}

}  // namespace thalweg::driver
