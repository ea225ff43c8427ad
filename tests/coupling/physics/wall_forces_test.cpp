// Forces on the walls of the box: the momentum of the fluid changes by its driving, its grains and these, and nothing
// else.
#include "tests/coupling/water_box.hpp"

#include "core/parallel/mpi_session.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace thalweg::coupling::wall_forces_test {
namespace {

Vec3 over_ranks(const Vec3& v) {
  return {sum_over_ranks(MPI_COMM_WORLD, v.x()), sum_over_ranks(MPI_COMM_WORLD, v.y()),
          sum_over_ranks(MPI_COMM_WORLD, v.z())};
}

// A stream over a floor, under a lid that slips, between side walls that mix both; and the same in a closed box, where
// populations come out of the edges of all pairs of faces. Grains touch floor and sides.
TEST(WallForces, BalanceTheMomentumOfTheFluid) {
  for (const bool closed : {false, true}) {
    WaterBox box;
    box.cells = {32, 16, 24};
    box.periodic = {!closed, false, false};
    box.gravity = Vec3(0.8, 0.0, -9.8);
    box.fluid_velocity = Vec3(0.2, 0.05, 0.0);
    box.links.momentum_exchange = bodies::MomentumExchange::classical;
    box.seeds = {glass_sphere(0, Vec3(0.0128, 0.0030, 0.0026), Vec3(0.1, -0.05, 0.0)),
                 glass_sphere(1, Vec3(0.0190, 0.0070, 0.0100), Vec3(0.0, 0.1, -0.1))};
    const auto system =
        make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
    auto& fluid = const_cast<lbm::Fluid<double>&>(system->fluid());  // wall_forces() fills what a step fills anyway
    const double force = box.gravity.x() * box.time_step * box.time_step / box.spacing;
    lbm::FluidTotals before = system->fluid().totals();
    Vec3 on_walls = Vec3::Zero();
    for (int step = 0; step < 120; ++step) {
      std::array<Vec3, 6> walls = fluid.wall_forces();
      // Refilled and covered cells change what leaves towards a wall after it was looked at; the grains next to walls
      // do not move far enough for that in single steps, which shows in their totals.
      system->advance();
      const lbm::FluidTotals after = system->fluid().totals();
      const bodies::ExchangeTotals& t = system->bodies().step_totals();
      Vec3 expected = before.momentum + over_ranks(t.refilled - t.covered - t.link_momentum) +
                      Vec3(force * static_cast<double>(after.cells), 0.0, 0.0);
      for (const Vec3& wall : walls) expected -= wall;
      if (over_ranks(t.refilled.cwiseAbs() + t.covered.cwiseAbs()).isZero(0.0)) {
        // The totals round every cell to within 2^-37, like cells alike; all else rounds at 2^-45.
        ASSERT_LT((after.momentum - expected).norm(), 2.5 * 0x1p-37 * static_cast<double>(after.cells)) << step;
        on_walls += walls[4];
      }
      before = after;
    }
    EXPECT_GT(on_walls.x(), 1e-3);  // the stream drags the floor along
  }
}

// A grain held half a micrometre within the floor presses on it by its spring, and still water on nothing.
TEST(WallForces, OfAGrainHeldOnTheFloorAreItsSpring) {
  WaterBox box;
  box.cells = {16, 16, 16};
  box.periodic = {true, true, false};
  box.wall_forces = true;
  const double press = 20000.0 * 0.5e-6;
  box.seeds = {glass_sphere(0, Vec3(0.0064, 0.0064, 2.5e-3 - 0.5e-6))};
  box.seeds[0].motion = dem::Motion::fixed;
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  for (int step = 0; step < 20; ++step) system->advance();
  int found = 0;
  for (const Diagnostic& diagnostic : system->diagnostics()) {
    if (diagnostic.name.find("wall_force") == std::string::npos) continue;
    ++found;
    EXPECT_NEAR(diagnostic.value, diagnostic.name == "wall_force_bottom_z" ? -press : 0.0, 1e-9 * press)
        << diagnostic.name;
  }
  EXPECT_EQ(found, 12);
}

}  // namespace
}  // namespace thalweg::coupling::wall_forces_test
