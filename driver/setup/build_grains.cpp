// Grains without a fluid, or with a force in its place, from a case.
#include "dem/grain_system.hpp"
#include "driver/case/grain_setup.hpp"
#include "driver/setup/build_system.hpp"
#include "driver/setup/turnover_setup.hpp"

#include <fmt/format.h>

namespace thalweg::driver {

namespace {

// The walls in the order of grain_parameters(); none where their forces are not asked for.
std::vector<std::string> measured_walls(const Case& c) {
  std::vector<std::string> walls;
  for (std::size_t face = 0; face < dem::face_names.size() && c.analysis.wall_forces; ++face)
    if (c.domain.faces[face].type != lbm::FaceType::periodic) walls.emplace_back(dem::face_names[face]);
  for (std::size_t wall = 0; wall < c.walls.size() && c.analysis.wall_forces; ++wall)
    walls.push_back(fmt::format("wall_{}", wall));
  return walls;
}

}  // namespace

std::unique_ptr<System> build_grains_system(const Case& c, MPI_Comm communicator, const Decomposition& decomposition,
                                            Start start) {
  dem::GrainSystemParameters parameters;
  parameters.grains = grain_parameters(c, decomposition.box());
  parameters.gravity = gravity_vector(c.gravity);
  add_turnover(c, decomposition.box(), parameters.grains);
  parameters.measured_walls = measured_walls(c);
  if (const std::optional<AtRestCase>& rest = c.run.until_at_rest; rest && rest->quantile < 1.0)
    parameters.rest = {rest->largest_speed, rest->largest_acceleration};
  if (c.system == SystemKind::model_fluid) {
    parameters.fluid_density = c.model_fluid.fluid_density;
    parameters.field = std::make_shared<model_fluid::ModelFluidField>(decomposition.box(), model_fluid_of(c));
  }
  return std::make_unique<dem::GrainSystem>(
      decomposition, communicator, parameters,
      start == Start::as_placed ? grain_seeds(c, communicator, decomposition) : dem::GrainSeeds{});
}

}  // namespace thalweg::driver
