// A lattice fluid with its solids or its grains, from a case.
#include "coupling/system/lattice_system.hpp"
#include "driver/bed/grain_weight.hpp"
#include "driver/bed/obstacles.hpp"
#include "driver/case/grain_setup.hpp"
#include "driver/case/solid_setup.hpp"
#include "driver/setup/build_system.hpp"
#include "driver/setup/fluid_setup.hpp"
#include "driver/setup/turnover_setup.hpp"

namespace thalweg::driver {

namespace {

coupling::LatticeParameters lattice_parameters(const Case& c) {
  coupling::LatticeParameters parameters;
  static_cast<coupling::FluidParameters&>(parameters) = fluid_parameters(c);
  for (const SolidCase& solid : c.solids) parameters.solid_motions.push_back(motion_of(solid));
  if (c.system != SystemKind::resolved) return parameters;
  parameters.bodies.keep_covered_momentum = c.coupling.covered_momentum == coupling::CoveredMomentum::to_grain;
  for (const analysis::SphereInBed& sphere : obstacles_of(c).spheres) parameters.bodies.obstacles.push_back(sphere.id);
  parameters.load = c.coupling.load;
  parameters.wall_forces = c.analysis.wall_forces.has_value();
  parameters.sub_steps = static_cast<int>(grain_steps(c));
  return parameters;
}

template <typename Real>
std::unique_ptr<System> build(const Case& c, MPI_Comm communicator, const Decomposition& cuts, Start start) {
  using System = coupling::LatticeSystem<Real>;
  auto decomposition = std::make_unique<Decomposition>(cuts);
  const coupling::LatticeParameters parameters = lattice_parameters(c);
  std::unique_ptr<dem::GrainDynamics> dynamics;
  if (c.system == SystemKind::resolved) {
    dem::GrainParameters grains = grain_parameters(c, decomposition->box());
    grains.body_force = body_force(c);
    add_turnover(c, decomposition->box(), grains);
    grains.ghost_width = System::ghost_reach(0.5 * largest_diameter(c), c.domain.spacing);
    grains.attached_width = System::attached_width;
    dem::GrainSeeds seeds;
    if (start == Start::as_placed) seeds = grain_seeds(c, communicator, *decomposition);
    dynamics = std::make_unique<dem::GrainDynamics>(*decomposition, communicator, grains, std::move(seeds));
  }
  return std::make_unique<System>(std::move(decomposition), communicator, parameters, std::move(dynamics),
                                  solid_shapes(c));
}

}  // namespace

std::unique_ptr<System> build_lattice_system(const Case& c, MPI_Comm communicator, const Decomposition& cuts,
                                             Start start) {
  return c.fluid.precision == coupling::Precision::single ? build<float>(c, communicator, cuts, start)
                                                          : build<double>(c, communicator, cuts, start);
}

}  // namespace thalweg::driver
