// Grains in water with solids.
#include "core/parallel/mpi_session.hpp"
#include "tests/coupling/water_box.hpp"
#include "tests/support/meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace thalweg::coupling::solids_with_grains_test {
namespace {

constexpr double g = 9.8, water = 1000.0, radius = 2.5e-3;

double submerged_weight() { return (2550.0 - water) * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * g; }

// A basin of still water with a block on its floor and a ball beside it.
WaterBox basin() {
  WaterBox box;
  box.cells = {24, 24, 30};
  box.spacing = 5e-3 / 6.0;
  box.periodic = {true, true, false};
  box.gravity = Vec3(0.0, 0.0, -g);
  box.collision = lbm::CollisionModel::trt_at_bodies;
  box.solids = {thalweg::test::box_mesh(Vec3(4.3e-3, 4.1e-3, -1e-3), Vec3(12.2e-3, 15.9e-3, 8.1e-3))};
  return box;
}

double diagnostic_of(const LatticeSystem<double>& system, const std::string& name) {
  return find_diagnostic(system.diagnostics(), name).value();
}

// A grain that lies on a block presses it down by its weight less its buoyancy, as it would the floor.
TEST(SolidsWithGrains, CarryAGrainsSubmergedWeight) {
  WaterBox box = basin();
  box.seeds = {glass_sphere(0, Vec3(8.3e-3, 9.7e-3, 8.1e-3 + radius))};
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  for (int n = 0; n < 3000; ++n) system->advance();
  const double on_solid = diagnostic_of(*system, "solid_0_grain_force_z");
  EXPECT_NEAR(on_solid / -submerged_weight(), 1.0, 1e-3);
  EXPECT_LT(system->grains().largest_speed(), 1e-5);
  EXPECT_LT(diagnostic_of(*system, "largest_fluid_speed"), 1e-5);
}

}  // namespace
}  // namespace thalweg::coupling::solids_with_grains_test
