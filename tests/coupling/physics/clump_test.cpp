// Clumps in a resolved flow: what the fluid does to the members the clump feels about its centre, and spheres that
// overlap are no more than the body they make.
#include "tests/coupling/water_box.hpp"

#include "core/parallel/mpi_session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::coupling::clump_test {
namespace {

Vec3 over_ranks(const Vec3& v) {
  return {sum_over_ranks(MPI_COMM_WORLD, v.x()), sum_over_ranks(MPI_COMM_WORLD, v.y()),
          sum_over_ranks(MPI_COMM_WORLD, v.z())};
}

std::unique_ptr<LatticeSystem<double>> system_of(const WaterBox& box) {
  return make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
}

// The sum of the members' loads about a centre: force and torque, on the rank that owns the clump.
struct Sum {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
};

Sum sum_of_loads(const dem::GrainDynamics& grains, const std::vector<Vec3>& arms) {
  Sum sum;
  const dem::GrainStore& store = grains.store();
  for (std::size_t s = 0; s < store.owned; ++s) {
    sum.force += store.load_force[s];
    sum.torque += store.load_torque[s] + arms[static_cast<std::size_t>(store.id[s])].cross(store.load_force[s]);
  }
  return sum;
}

// The only clump of the system, on every rank: centre, velocity, angular momentum, and its members from the centre.
struct State {
  Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero(), angular_momentum = Vec3::Zero();
  std::vector<Vec3> arms;
};

State state_of(const LatticeSystem<double>& system, std::size_t members) {
  State state;
  state.arms.assign(members, Vec3::Zero());
  const dem::GrainDynamics& grains = system.grains();
  const PeriodicBox box = grains.decomposition().box();
  if (!grains.clumps().empty()) {
    const dem::Clump& clump = grains.clumps()[0];
    state.centre = clump.centre;
    state.velocity = clump.velocity;
    state.angular_momentum = clump.angular_momentum;
    for (std::size_t m = 0; m < members; ++m)
      state.arms[m] = box.difference(grains.store().position[grains.clumps().first_slot(0) + m], clump.centre);
  }
  state.centre = over_ranks(state.centre);
  state.velocity = over_ranks(state.velocity);
  state.angular_momentum = over_ranks(state.angular_momentum);
  for (Vec3& arm : state.arms) arm = over_ranks(arm);
  return state;
}

// With dt the lattice step, M dV = (sum F_m + G) dt and dL = sum (T_m + r_m x F_m) dt, to round-off: loads are constant
// in a step. The weight is that of the exact volume. The clump crosses a periodic face and the borders between ranks.
TEST(ClumpInAFlow, GainsTheImpulseOfItsMembersLoads) {
  WaterBox box;
  box.gravity = Vec3(0.0, 0.0, -9.8);
  box.clumps = {glass_clump(0, pebble(), Vec3(0.0248, 0.0096, 0.0096), Vec3(0.4, 0.1, 0.0), Vec3(20.0, 40.0, -30.0))};
  const double mass = box.clumps[0].mass(), submerged = 1550.0 * box.clumps[0].shape->volume;
  const auto system = system_of(box);
  const Vec3 weight(0.0, 0.0, -9.8 * submerged);
  State before = state_of(*system, 3);
  double most_torque = 0.0;
  for (int step = 0; step < 60; ++step) {
    system->advance();
    const Sum mine = sum_of_loads(system->grains(), before.arms);
    const Vec3 force = over_ranks(mine.force), torque = over_ranks(mine.torque);
    const State after = state_of(*system, 3);
    const double dt = box.time_step;
    // 50 sub-steps round velocity and angular momentum twice each: relative to those 100 times 2^-53.
    ASSERT_LT((mass * (after.velocity - before.velocity) - (force + weight) * dt).norm(), 1e-13 * mass) << step;
    // The arms are differences of positions of the order of the box: 2^-52 of 0.02 m, against an arm of 2 mm.
    ASSERT_LT((after.angular_momentum - before.angular_momentum - torque * dt).norm(),
              1e-12 * (torque.norm() * dt + before.angular_momentum.norm()))
        << step;
    most_torque = std::max(most_torque, torque.norm());
    before = after;
  }
  EXPECT_GT(most_torque, 1e-3 * weight.norm() * 2e-3);  // there was something to add up
  EXPECT_LT(before.centre.x(), 0.01);                   // it has gone through the face at 25.6 mm
}

// In uniform motion with the fluid the links of a member do not cancel: those it lost to its neighbours are missing.
// All members' together do, to round-off, as do those of a sphere (balance_test.cpp), and in the classical exchange so
// does the torque. The arms of links are kept in single precision, 2^-24 of up to 4 cells; of a sphere their errors
// cancel by symmetry, here up to all of them add up: some 300 links, 1.5e-1 in sum against 3.4e-2 x 2.75 cells, make
// 4e-7 of the torque at worst, and the clump, free to turn, answers with a spin that small.
class ClumpInUniformMotion : public ::testing::TestWithParam<bodies::MomentumExchange> {};

TEST_P(ClumpInUniformMotion, FeelsNoForce) {
  const bool classical = GetParam() == bodies::MomentumExchange::classical;
  WaterBox box;
  box.viscosity = 2e-5;
  box.smagorinsky_constant = 0.0;
  box.links.momentum_exchange = GetParam();
  const Vec3 velocity(0.35, -0.21, 0.13);
  box.fluid_velocity = velocity;
  box.clumps = {glass_clump(0, pebble(), Vec3(0.0251, 0.0007, 0.0096), velocity)};
  if (!classical) box.clumps[0].motion = dem::Motion::held_rotation;
  const auto system = system_of(box);
  const double scale = 0.5 * 1000.0 * velocity.squaredNorm() * std::numbers::pi * std::pow(2.2e-3, 2);
  for (int step = 0; step < 200; ++step) {
    const State state = state_of(*system, 3);
    system->advance();
    const Sum mine = sum_of_loads(system->grains(), state.arms);
    const Vec3 force = over_ranks(mine.force), torque = over_ranks(mine.torque);
    ASSERT_LT(force.norm() / scale, classical ? 4e-7 : 1e-10) << "step " << step;
    if (classical) {
      ASSERT_LT(torque.norm() / (scale * 2.2e-3), 4e-7) << "step " << step;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BothExchanges, ClumpInUniformMotion,
                         ::testing::Values(bodies::MomentumExchange::galilean_invariant,
                                           bodies::MomentumExchange::classical));

// The rule CLI leaves the resting fluid exactly at rest (full_gravity_test.cpp), so that the force is the weight of the
// fluid in the cells that the clump covers, each once. Patches where members meet carry nothing: they would count a
// layer of cells twice, several percent. Only in the groove between members, where the second cell of a link is covered
// and another rule takes its place, is the fluid not exactly at rest: a few tens of links, each off by a part of the
// pressure that changes over one cell, against some 800 cells; 1e-3 at most.
TEST(ClumpInAFlow, IsLiftedByTheWeightOfTheCellsOfItsUnion) {
  WaterBox box;
  box.cells = {24, 24, 24};
  box.periodic = {true, true, false};
  box.spacing = 0.5e-3;
  box.time_step = 5e-5;
  box.viscosity = 1.0 / 6.0 * box.spacing * box.spacing / box.time_step;  // tau = 1
  box.smagorinsky_constant = 0.0;
  box.gravity = Vec3(0.0, 0.0, -9.8);
  box.full_gravity = true;
  box.links.rule = bodies::LinkRule::cli;
  box.clumps = {glass_clump(0, pebble(), Vec3(5.1e-3, 6.3e-3, 6.2e-3))};
  box.clumps[0].motion = dem::Motion::fixed;
  const auto system = system_of(box);
  const std::vector<dem::GrainSeed> members =
      dem::with_members({}, box.clumps, Decomposition(box.cells, box.spacing, box.periodic, {1, 1, 1}).box());
  int covered = 0;
  for (int z = 0; z < 24; ++z)
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        bool inside = false;
        for (const dem::GrainSeed& member : members)
          inside = inside || (box.spacing * Vec3(x + 0.5, y + 0.5, z + 0.5) - member.position).norm() < member.radius;
        covered += inside;
      }
  Vec3 mean = Vec3::Zero();
  for (int step = 0; step < 200; ++step) {
    system->advance();
    if (step < 100) continue;
    const State state = state_of(*system, 3);
    mean += over_ranks(sum_of_loads(system->grains(), state.arms).force) / 100.0;
  }
  const double weight = 1000.0 * 9.8 * std::pow(box.spacing, 3) * covered;
  EXPECT_LT((mean - Vec3(0.0, 0.0, weight)).norm() / weight, 1e-3);
  // The cells are about as many as the exact volume holds: a percent of them for a body of ten cells.
  EXPECT_NEAR(covered * std::pow(box.spacing, 3) / box.clumps[0].shape->volume, 1.0, 0.02);
}

// A sphere twice in the same place and a small one hidden inside are that sphere, whoever of them holds a cell. The
// distances of links are kept in single precision, so the two runs part by a few 1e-8 of the loads.
TEST(ClumpInAFlow, OfSpheresInTheSamePlaceIsThatSphere) {
  WaterBox box;
  box.gravity = Vec3(0.0, 0.0, -9.8);
  const Vec3 place(0.0128, 0.0096, 0.0126), velocity(0.2, 0.1, 0.0);
  box.seeds = {glass_sphere(0, place, velocity)};
  const auto sphere = system_of(box);
  box.seeds.clear();
  box.clumps = {
      glass_clump(0, {{{0.3e-3, 0, 0}, 0.8e-3}, {Vec3::Zero(), 2.5e-3}, {Vec3::Zero(), 2.5e-3}}, place, velocity)};
  const auto clump = system_of(box);
  for (int step = 0; step < 100; ++step) {
    sphere->advance();
    clump->advance();
  }
  Vec3 of_sphere = Vec3::Zero(), spin = Vec3::Zero(), turning = Vec3::Zero();
  const dem::GrainStore& store = sphere->grains().store();
  if (store.owned > 0) of_sphere = store.velocity[0], spin = store.angular_velocity[0];
  if (!clump->grains().clumps().empty()) turning = clump->grains().clumps()[0].angular_velocity;
  of_sphere = over_ranks(of_sphere);
  EXPECT_LT(of_sphere.z(), -0.02);  // it fell
  EXPECT_LT((state_of(*clump, 3).velocity - of_sphere).norm(), 1e-6 * of_sphere.norm());
  EXPECT_LT((over_ranks(turning) - over_ranks(spin)).norm() * 2.5e-3, 1e-6 * of_sphere.norm());
}

}  // namespace
}  // namespace thalweg::coupling::clump_test
