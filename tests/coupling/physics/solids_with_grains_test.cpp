// Grains in water with solids.
#include "core/parallel/mpi_session.hpp"
#include "tests/coupling/water_box.hpp"
#include "tests/support/meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

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

// Moments of forces about the centre of a solid of thousands of cells would leave the range of exact sums.
TEST(SolidsWithGrains, HaveNoMomentsBesideThoseOfGrains) {
  WaterBox box = basin();
  box.seeds = {glass_sphere(0, Vec3(8.3e-3, 9.7e-3, 8.3e-3 + radius))};
  box.fluid_velocity = Vec3(0.05, 0.0, 0.0);
  const auto system = make_system<double>(box, MPI_COMM_SELF, {1, 1, 1});
  system->measure_grain_stress();
  system->advance();
  const auto magnitude = [&](int slot) {
    return system->bodies().moments(static_cast<bodies::BodySlot>(slot)).to_mat3().norm();
  };
  EXPECT_EQ(magnitude(0), 0.0);
  EXPECT_GT(magnitude(1), 0.0);
}

// A viscous fluid between floor and lid, with a box and one ball of 8 mm that is held.
WaterBox held_ball(const Index3& cells, const TriangleMesh& solid, const Vec3& centre) {
  WaterBox box;
  box.cells = cells;
  box.spacing = 1e-3;
  box.periodic = {true, true, false};
  box.viscosity = 1e-5;
  box.smagorinsky_constant = 0.0;
  box.collision = lbm::CollisionModel::trt;
  box.closed = true;
  box.solids = {solid};
  box.seeds = {glass_sphere(0, centre, Vec3::Zero(), 4e-3)};
  box.seeds[0].motion = dem::Motion::fixed;
  return box;
}

// A slab across a periodic box, of which one surface ends beneath the middle of a ball and the other half a box away;
// the ball spins a gap of one cell above it.
WaterBox ball_over_slab(double lower, double upper) {
  WaterBox box =
      held_ball({24, 24, 24}, thalweg::test::box_mesh(Vec3(lower, -14e-3, -3e-3), Vec3(upper, 38e-3, 4.3e-3)),
                Vec3(0.2e-3, 12.1e-3, 8.7e-3));
  box.seeds[0].angular_velocity = Vec3(0.0, 5.0, 0.0);
  return box;
}

// The velocity of the ball is that at the nearest image of the point, not one of a surface a box away. Cuts of links
// with solids are in single precision.
TEST(SolidsWithGrains, FeelABallAlikeWhereverTheirSurfaceEnds) {
  std::vector<Vec3> forces;
  for (const auto& [lower, upper] : {std::pair{-1e-3, 25e-3}, std::pair{-13e-3, 13e-3}}) {
    const WaterBox box = ball_over_slab(lower, upper);
    const auto system =
        make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
    for (int n = 0; n < 200; ++n) system->advance();
    forces.emplace_back(diagnostic_of(*system, "solid_0_force_x"), 0.0, diagnostic_of(*system, "solid_0_force_z"));
  }
  EXPECT_GT(forces[0].norm(), 0.0);
  EXPECT_LT((forces[1] - forces[0]).norm(), 1e-4 * forces[0].norm());
}

// The sum of the pressure of still water over a plate that a ball touches on one side: no force along the plate's
// normal. Without the pressure on the patch that the ball hides it was an eighth of the weight displaced. Hidden links
// are cut at the ball in place of the plate, at most one cell of head away.
TEST(SolidsWithGrains, CarryThePressureOnWhatAGrainHides) {
  WaterBox box =
      held_ball({36, 24, 24}, thalweg::test::box_mesh(Vec3(10.3e-3, -2e-3, -3e-3), Vec3(14.3e-3, 26e-3, 12.2e-3)),
                Vec3(18.3e-3, 12.1e-3, 4.2e-3));
  box.links.rule = bodies::LinkRule::cli;
  box.full_gravity = true;
  box.gravity = Vec3(0.0, 0.0, -g);
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  for (int n = 0; n < 20; ++n) system->advance();
  const double displaced = water * 4.0 / 3.0 * std::numbers::pi * std::pow(4e-3, 3.0) * g;
  EXPECT_LT(std::abs(diagnostic_of(*system, "solid_0_force_x")), 1e-3 * displaced);
}

}  // namespace
}  // namespace thalweg::coupling::solids_with_grains_test
