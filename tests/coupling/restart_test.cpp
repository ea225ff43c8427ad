// A restart after any step goes on with the same bits: what a system builds from its saved state is what another keeps
// up to date. Each step of a run is also taken by a new system that has just loaded the state before it.
#include "core/parallel/mpi_session.hpp"
#include "tests/coupling/water_box.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

namespace thalweg::coupling::restart_test {
namespace {

std::unique_ptr<LatticeSystem<double>> make(const WaterBox& box) {
  return make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
}

void expect_the_same_after_a_restart_at_any_step(const WaterBox& box, int steps) {
  const auto whole = make(box);
  for (int step = 0; step < steps; ++step) {
    const auto restarted = make(box);
    test::load(*restarted, test::saved(*whole, MPI_COMM_WORLD));
    whole->advance();
    restarted->advance();
    ASSERT_EQ(test::first_difference(test::saved(*whole, MPI_COMM_WORLD), test::saved(*restarted, MPI_COMM_WORLD)), "")
        << "restarted after step " << step;
  }
}

// The cells of a grain that leaves are refilled with its last motion.
TEST(Restart, MayComeBeforeTheStepInWhichAGrainLeaves) {
  WaterBox box;
  box.fluid_velocity = Vec3(0.2, 0.0, 0.0);
  box.seeds = {glass_sphere(0, Vec3(9e-3, 9.6e-3, 9.1e-3), Vec3(0.5, 0.1, -0.2)),
               glass_sphere(1, Vec3(22e-3, 5e-3, 12e-3), Vec3(-0.4, 0.0, 0.1))};
  for (dem::GrainSeed& seed : box.seeds) seed.angular_velocity = Vec3(30.0, -80.0, 20.0);
  box.sinks = {{{Vec3(9.2e-3, 0.0, 0.0), Vec3(21.8e-3, 19.2e-3, 19.2e-3)}, std::nullopt}};
  const auto system = make(box);
  for (int step = 0; step < 12; ++step) system->advance();
  EXPECT_EQ(system->grains().global_count(), 0);  // both leave, in two steps
  expect_the_same_after_a_restart_at_any_step(box, 12);
}

// The moving sphere enters the one at rest and shortens its links, also in steps in which no cell changes hands.
TEST(Restart, MayComeWhileASolidMovesThroughAnother) {
  WaterBox box;
  box.fluid_velocity = Vec3(0.2, 0.0, 0.0);
  box.solids = {bodies::SolidSphere{Vec3(9.7e-3, 6.8e-3, 11.4e-3), 3.5e-3},
                bodies::SolidSphere{Vec3(8.7e-3, 9.9e-3, 10.3e-3), 3.3e-3}};
  dem::PrescribedMotion slow;
  slow.velocity = Vec3(-0.015, 0.016, -0.023);
  box.solid_motions = {slow};
  expect_the_same_after_a_restart_at_any_step(box, 60);
}

}  // namespace
}  // namespace thalweg::coupling::restart_test
