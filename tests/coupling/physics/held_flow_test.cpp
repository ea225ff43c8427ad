// A mean velocity that is held drives grains like the fluid they displace.
#include "core/parallel/mpi_session.hpp"
#include "tests/coupling/water_box.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

namespace thalweg::coupling::held_flow_test {
namespace {

// A sphere as dense as the fluid, at rest with it, in a box without walls whose flow is to reach 0.02 cells a step.
WaterBox starting_flow(bool on_grains) {
  WaterBox box;
  box.cells = {20, 20, 20};
  box.viscosity = 2e-5;
  box.smagorinsky_constant = 0.0;
  box.flow_target = lbm::FlowTarget{.axis = 0, .velocity = 0.02, .response_time = 200.0, .interval = 10};
  box.target_moves_grains = on_grains;
  box.seeds.push_back(glass_sphere(0, Vec3(8.1e-3, 7.9e-3, 8.3e-3)));
  box.seeds.back().density = 1000.0;
  return box;
}

// Lag of a grain as a share of the velocity of the fluid.
double lag_of_grain(const LatticeSystem<double>& system) {
  const double fluid = system.fluid().totals().momentum.x() / static_cast<double>(system.fluid().totals().cells) * 8.0;
  return 1.0 - system.grains().store().velocity[0].x() / fluid;
}

// Both gain F/rho a step, and there is no flow between them. The load that a step gives is that of the steps before,
// and the force that of ten steps: one part in a hundred of what a flow gains in its response time.
TEST(HeldFlow, DrivesAGrainLikeTheFluidItDisplaces) {
  const auto with = make_system<double>(starting_flow(true), MPI_COMM_SELF, {1, 1, 1});
  const auto without = make_system<double>(starting_flow(false), MPI_COMM_SELF, {1, 1, 1});
  for (int step = 0; step < 100; ++step) {
    with->advance();
    without->advance();
  }
  EXPECT_NEAR(lag_of_grain(*with), 0.0, 0.01);
  EXPECT_GT(lag_of_grain(*without), 0.2);
}

TEST(HeldFlow, GoesOnAfterARestart) {
  const auto straight = make_system<double>(starting_flow(true), MPI_COMM_SELF, {1, 1, 1});
  for (int step = 0; step < 37; ++step) straight->advance();
  const auto resumed = make_system<double>(starting_flow(true), MPI_COMM_SELF, {1, 1, 1});
  test::load(*resumed, test::saved(*straight, MPI_COMM_SELF));
  for (int step = 0; step < 30; ++step) {
    straight->advance();
    resumed->advance();
  }
  EXPECT_EQ(straight->grains().store().position[0], resumed->grains().store().position[0]);
  EXPECT_EQ(straight->grains().store().velocity[0], resumed->grains().store().velocity[0]);
}

// The force that holds the flow is a change of body force: in its first step it moves a light grain together with the
// fluid that goes with it, (m + m_C) dv/dt = F V (light_load.hpp), while the links give nothing yet.
TEST(HeldFlow, BeginsToMoveALightGrainTogetherWithItsFluid) {
  WaterBox box = starting_flow(true);
  constexpr double density = 100.0;
  box.seeds.back().density = density;
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  system->advance();
  const double force = find_diagnostic(system->diagnostics(), "body_force_x").value();
  const LightLoad light{1000.0, box.spacing};
  const double radius = box.seeds.back().radius, volume = Sphere{radius}.volume(), mass = density * volume;
  const dem::GrainStore& grains = system->grains().store();
  const double speed = sum_over_ranks(MPI_COMM_WORLD, grains.owned == 1 ? grains.velocity[0].x() : 0.0);
  const double expected = force * volume * box.time_step / (mass + light.added_mass({mass, radius, 2.0 * radius}));
  EXPECT_GT(force, 0.0);
  EXPECT_NEAR(speed, expected, 0.05 * expected);
}

}  // namespace
}  // namespace thalweg::coupling::held_flow_test
