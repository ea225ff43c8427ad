// A constant added to the pressure everywhere presses on nothing.
#include "core/parallel/mpi_session.hpp"
#include "tests/coupling/water_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace thalweg::coupling::pressure_gauge_test {
namespace {

FluidInitialState at_rest(const Vec3&) { return {0.0, Vec3::Zero()}; }
FluidInitialState compressed(const Vec3&) { return {0.01, Vec3::Zero()}; }

struct Loads {
  std::vector<Vec3> force, torque;  // N, N m, of owned grains
  std::vector<Mat3> stress;         // Pa
  std::vector<double> walls;        // N, from the diagnostics
  double density = 0.0;             // mean deviation
};

// Seven grains held fast: they touch each other, overlap a little, touch the floor and a side, or stand alone.
Loads loads_in(WaterBox box, FluidInitialState (*initial)(const Vec3&)) {
  box.cells = {30, 24, 24};
  box.periodic = {true, false, false};
  box.closed = true;
  box.initial = initial;
  box.wall_forces = true;
  const double d = 5e-3;
  for (const Vec3& place :
       {Vec3(6.03e-3, 6.1e-3, 2.5e-3), Vec3(6.03e-3 + d, 6.1e-3, 2.5e-3),
        Vec3(6.03e-3 + 0.5 * d, 6.1e-3 + 0.86 * d, 2.5e-3),
        Vec3(6.03e-3 + 0.5 * d, 6.1e-3 + 0.28 * d, 2.5e-3 + 0.81 * d), Vec3(16.4e-3, 2.49e-3, 9.2e-3),
        Vec3(16.0e-3, 7.4e-3, 9.9e-3), Vec3(21.3e-3, 9.6e-3, 14e-3)}) {
    box.seeds.push_back(glass_sphere(static_cast<GlobalId>(box.seeds.size()), place));
    box.seeds.back().motion = dem::Motion::fixed;
  }
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  for (int step = 0; step < 4; ++step) advance_with_stress(*system);
  Loads loads;
  const Snapshot s = system->snapshot();
  for (std::size_t g = 0; g < s.grains.position.size(); ++g) {
    loads.force.push_back(s.grains.fluid_force[g]);
    loads.torque.push_back(s.grains.fluid_torque[g]);
    loads.stress.push_back(s.grains.fluid_stress[g]);
  }
  for (const Diagnostic& diagnostic : system->diagnostics())
    if (diagnostic.name.starts_with("fluid_wall_force")) loads.walls.push_back(diagnostic.value);
  loads.density = find_diagnostic(system->diagnostics(), "mean_density_deviation").value();
  return loads;
}

// The deviation of 0.01 is a pressure of 213 Pa, which on the cross-section of a grain is 4.2 mN, five times a grain's
// submerged weight. Round-off: the mean density that presses on nothing is known to 2^-37, and counts a third on every
// cell of a surface, once in the links and once in what is hidden: 80 of a grain, 720 of a wall; in the torque times
// the radius, in the stress over a third of it.
void expect_no_difference(const WaterBox& box) {
  const Loads before = loads_in(box, at_rest), after = loads_in(box, compressed);
  EXPECT_NEAR(after.density - before.density, 0.01, 1e-3);  // it is there, and nothing has taken it away
  const Units units{box.spacing, box.time_step, 1000.0};
  const double round_off = 2.0 * 80.0 / 3.0 * 0x1p-37 * units.force();
  for (std::size_t g = 0; g < before.force.size(); ++g) {
    EXPECT_LT((after.force[g] - before.force[g]).norm(), round_off) << g;
    EXPECT_LT((after.torque[g] - before.torque[g]).norm(), round_off * 3.1 * box.spacing) << g;
    EXPECT_LT((after.stress[g] - before.stress[g]).norm(), 2.0 * 80.0 * 0x1p-37 * units.stress()) << g;
  }
  ASSERT_EQ(before.walls.size(), 12u);
  for (std::size_t w = 0; w < before.walls.size(); ++w) EXPECT_NEAR(after.walls[w], before.walls[w], 10.0 * round_off);
}

TEST(PressureGauge, IsNotFeltWithAnyLinkRuleAndExchange) {
  for (const bodies::LinkRule rule : {bodies::LinkRule::bouzidi, bodies::LinkRule::cli})
    for (const bodies::MomentumExchange exchange :
         {bodies::MomentumExchange::galilean_invariant, bodies::MomentumExchange::classical}) {
      WaterBox box;
      box.links.rule = rule;
      box.links.momentum_exchange = exchange;
      expect_no_difference(box);
    }
}

// With the links of cli the fluid is exactly at rest under its weight.
TEST(PressureGauge, IsNotFeltUnderFullGravity) {
  WaterBox box;
  box.links.rule = bodies::LinkRule::cli;
  box.gravity = Vec3(0.0, 0.0, -9.8);
  box.full_gravity = true;
  expect_no_difference(box);
}

}  // namespace
}  // namespace thalweg::coupling::pressure_gauge_test
