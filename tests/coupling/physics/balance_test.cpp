// Momentum that the fluid loses is gained by the grains, and a grain that drifts with the fluid feels nothing.
#include "tests/coupling/water_box.hpp"

#include "core/parallel/mpi_session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

namespace thalweg::coupling::balance_test {
namespace {

Vec3 over_ranks(const Vec3& v) {
  return {sum_over_ranks(MPI_COMM_WORLD, v.x()), sum_over_ranks(MPI_COMM_WORLD, v.y()),
          sum_over_ranks(MPI_COMM_WORLD, v.z())};
}

std::vector<dem::GrainSeed> loose_grains() {
  std::vector<dem::GrainSeed> seeds;
  for (int k = 0; k < 12; ++k)
    seeds.push_back(
        glass_sphere(k, Vec3(6.4e-3 * (k % 4) + 0.4e-3, 6.4e-3 * (k / 4 % 3) + 1.1e-3, 0.012 + 1.3e-3 * (k % 3)),
                     Vec3(0.3 - 0.05 * k, 0.1 * (k % 3) - 0.1, 0.02 * k - 0.1), 2.4e-3));
  return seeds;
}

// Fluid momentum changes by the body force, by the links (classical exchange: the momentum of the populations
// themselves), and by the cells that grains cover and uncover; by nothing else, to round-off.
void expect_balance(double bulk_relaxation_time) {
  WaterBox box;
  box.bulk_relaxation_time = bulk_relaxation_time;
  box.cells = {32, 24, 40};
  box.gravity = Vec3(0.8, 0.0, -9.8);
  box.fluid_velocity = Vec3(0.2, 0.0, 0.0);
  box.links.momentum_exchange = bodies::MomentumExchange::classical;
  box.seeds = loose_grains();
  const Index3 layout = Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD));
  const auto system = make_system<double>(box, MPI_COMM_WORLD, layout);
  const double force = box.gravity.x() * box.time_step * box.time_step / box.spacing;
  lbm::FluidTotals before = system->fluid().totals();
  double fluid_gain = 0.0;
  for (int step = 0; step < 200; ++step) {
    system->advance();
    const lbm::FluidTotals after = system->fluid().totals();
    const bodies::ExchangeTotals& t = system->bodies().step_totals();
    const Vec3 exchanged = over_ranks(t.refilled - t.covered - t.link_momentum);
    const Vec3 expected = before.momentum + exchanged + Vec3(force * static_cast<double>(after.cells), 0.0, 0.0);
    // The totals round every cell to within 2^-37, like cells alike; all else rounds at 2^-53.
    ASSERT_NEAR((after.momentum - expected).norm(), 0.0, 2.0 * 0x1p-37 * static_cast<double>(after.cells)) << step;
    fluid_gain = (after.momentum - before.momentum).norm();
    before = after;
  }
  EXPECT_GT(fluid_gain, 1e-4);  // there was something to balance
}

TEST(Momentum, OfTheFluidChangesOnlyByWhatItExchanges) { expect_balance(0.0); }
TEST(Momentum, IsBalancedWithABulkViscosityOfItsOwn) { expect_balance(10.0); }

// A grain gains exactly the impulse of its mean load and its weight. With dt the lattice step, m dv = (F + G) dt. The
// velocity is rounded twice in each of 50 sub-steps: to within 100 times 2^-53 of 0.1 m/s.
TEST(Momentum, OfAGrainIsTheImpulseOfItsLoad) {
  WaterBox box;
  box.gravity = Vec3(0.0, 0.0, -9.8);
  box.seeds = {glass_sphere(0, Vec3(0.0128, 0.0096, 0.0096), Vec3(0.1, 0.0, 0.0))};
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  Vec3 earlier_velocity(0.1, 0.0, 0.0);
  for (int step = 0; step < 40; ++step) {
    system->advance();
    const dem::GrainStore& store = system->grains().store();
    Vec3 velocity = Vec3::Zero(), load = Vec3::Zero();
    if (store.owned == 1) {
      velocity = store.velocity[0];
      load = store.load_force[0];
    }
    velocity = over_ranks(velocity);
    load = over_ranks(load);
    const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(2.5e-3, 3);
    const Vec3 weight(0.0, 0.0, -9.8 * 1550.0 * volume);
    const Vec3 gained = 2550.0 * volume * (velocity - earlier_velocity);
    if (step > 0) {  // in the first sub-step's first half kick the load was not there yet
      EXPECT_LT((gained - (load + weight) * box.time_step).norm(), 1e-13 * 2550.0 * volume) << step;
    }
    earlier_velocity = velocity;
  }
}

// Grain and fluid in uniform motion: the force vanishes to round-off although cells are covered and uncovered all the
// time; the rules of links, the moving-wall term and the refill are exact for it. So does the torque of the
// classical exchange; the Galilean-invariant one leaves a torque of the order of the staircase (about 5e-3 of
// 1/2 rho U^2 A R at ten cells a diameter), so there the grain is kept from spinning.
class UniformMotion : public ::testing::TestWithParam<std::tuple<bodies::MomentumExchange, bodies::LinkRule>> {};

TEST_P(UniformMotion, ExertsNoForce) {
  const auto [exchange, rule] = GetParam();
  const bool classical = exchange == bodies::MomentumExchange::classical;
  WaterBox box;
  box.viscosity = 2e-5;
  box.smagorinsky_constant = 0.0;
  box.links.momentum_exchange = exchange;
  box.links.rule = rule;
  const Vec3 velocity(0.35, -0.21, 0.13);  // m/s: 0.044, 0.026 and 0.016 cells a step
  box.fluid_velocity = velocity;
  box.seeds = {glass_sphere(0, Vec3(0.0251, 0.0007, 0.0096), velocity)};
  if (!classical) box.seeds[0].motion = dem::Motion::held_rotation;
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  const double scale = 0.5 * 1000.0 * velocity.squaredNorm() * std::numbers::pi * std::pow(2.5e-3, 2);  // 1/2 rho U^2 A
  for (int step = 0; step < 120; ++step) {
    system->advance();
    const dem::GrainStore& store = system->grains().store();
    for (std::size_t g = 0; g < store.owned; ++g) {
      ASSERT_LT(store.load_force[g].norm() / scale, 1e-10) << "step " << step;
      if (classical) {
        ASSERT_LT(store.load_torque[g].norm() / (scale * 2.5e-3), 1e-10) << "step " << step;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllRules, UniformMotion,
                         ::testing::Combine(::testing::Values(bodies::MomentumExchange::galilean_invariant,
                                                              bodies::MomentumExchange::classical),
                                            ::testing::Values(bodies::LinkRule::bouzidi, bodies::LinkRule::cli)));

}  // namespace
}  // namespace thalweg::coupling::balance_test
