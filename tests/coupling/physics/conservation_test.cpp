// Balances of momentum and angular momentum of fluid and grains together.
#include "tests/coupling/water_box.hpp"

#include "core/parallel/mpi_session.hpp"
#include "lbm/lattice/for_each_cell.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::coupling::conservation_test {
namespace {

Vec3 over_ranks(const Vec3& v) {
  return {sum_over_ranks(MPI_COMM_WORLD, v.x()), sum_over_ranks(MPI_COMM_WORLD, v.y()),
          sum_over_ranks(MPI_COMM_WORLD, v.z())};
}

// Calls visit(position of the cell, cell index) for every fluid cell of this rank.
template <typename Visit>
void for_each_fluid_cell(const LatticeSystem<double>& system, Visit visit) {
  const lbm::Fluid<double>& fluid = system.fluid();
  const Index3& from = fluid.block().lower;
  lbm::for_each_fluid_cell(fluid.cells(), [&](std::ptrdiff_t cell, const Index3& at) {
    visit(Vec3(from[0] + at[0] + 0.5, from[1] + at[1] + 0.5, from[2] + at[2] + 0.5), cell);
  });
}

Vec3 momentum_of(const LatticeSystem<double>& system, std::ptrdiff_t cell) {
  Vec3 m = Vec3::Zero();
  for (int i = 1; i < 19; ++i)
    for (int a = 0; a < 3; ++a) m[a] += lbm::D3Q19::c[i][a] * system.fluid().populations().post_collision(i, cell);
  return m;
}

// A dense crowd of grains (43 % of the volume) that collide, driven across a box without walls: the submerged weight
// acts on the grains, gravity along the other axes on fluid and grains. Fluid and grains together gain gravity's
// impulse, and what covered and refilled cells take and bring, less what the grains keep of it; of the exchanges F_1
// ... F_n the extrapolated load has given the grains their sum and F_n-1/2 (load_averaging.hpp). Left over is
// round-off: of the grains' forces, 1e-16 a kick, and of fixed-point sums, 2^-45 a link, at random; the scale is the
// sum of all impulses.
void balance_of_a_crowd(int steps) {
  WaterBox box;
  box.cells = {20, 20, 20};
  box.gravity = Vec3(0.3, -0.1, -1.0);  // so little that 1e4 steps of it stay slow
  box.sub_steps = 20;
  box.links.momentum_exchange = bodies::MomentumExchange::classical;
  box.keep_covered_momentum = true;
  for (int k = 0; k < 27; ++k)
    box.seeds.push_back(
        glass_sphere(k, 5.33e-3 * Vec3(k % 3 + 0.51, k / 3 % 3 + 0.48, k / 9 + 0.53) + 1e-4 * Vec3(k % 2, k % 3, k % 2),
                     Vec3(0.3 - 0.02 * k, 0.2 * std::cos(k), 0.2 * std::sin(k))));
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  const Units units{box.spacing, box.time_step, 1000.0};
  const double impulse_unit = units.force() * box.time_step;  // kg m/s a lattice unit of momentum
  const auto total = [&] {
    Vec3 fluid = Vec3::Zero(), grains = Vec3::Zero(), lag = Vec3::Zero();
    for_each_fluid_cell(*system, [&](const Vec3&, std::ptrdiff_t cell) { fluid += momentum_of(*system, cell); });
    const dem::GrainStore& store = system->grains().store();
    for (std::size_t g = 0; g < store.owned; ++g) {
      grains += store.mass[g] * store.velocity[g];
      lag -= 0.5 * GrainExchange(store.attached_of(g)).earlier_force() * box.time_step;
    }
    return Vec3(over_ranks(fluid * impulse_unit + grains + lag));
  };
  double mass = 0.0;
  for (const dem::GrainSeed& seed : box.seeds) mass += seed.mass();
  for (int step = 0; step < 3; ++step) system->advance();
  const Vec3 start = total();
  Vec3 expected = start, turned_over = Vec3::Zero();
  for (int step = 3; step < steps; ++step) {
    system->advance();
    std::int64_t cells = 0;
    for_each_fluid_cell(*system, [&](const Vec3&, std::ptrdiff_t) { ++cells; });
    const Vec3 along(box.gravity.x(), box.gravity.y(), 0.0), submerged(0.0, 0.0, box.gravity.z() * (1.0 - 1.0 / 2.55));
    const double fluid_mass =
        1000.0 * std::pow(box.spacing, 3) * static_cast<double>(sum_over_ranks(MPI_COMM_WORLD, cells));
    const bodies::ExchangeTotals& t = system->bodies().step_totals();
    expected += ((fluid_mass + mass) * along + mass * submerged) * box.time_step +
                over_ranks(t.refilled - t.covered + t.kept) * impulse_unit;
    turned_over += over_ranks(t.link_momentum).cwiseAbs() * impulse_unit +
                   ((fluid_mass + mass) * along + mass * submerged).cwiseAbs() * box.time_step;
  }
  const Vec3 end = total();
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(end[a], expected[a], 1e-10 * turned_over[a]);
}

TEST(Conservation, MomentumOfFluidAndGrainsChangesByGravityAlone) { balance_of_a_crowd(400); }
TEST(Conservation, DISABLED_MomentumOverTenThousandSteps) { balance_of_a_crowd(10000); }

// A closed box of no-slip walls with grains that stay away from them: the walls' torque follows from what cells at a
// face send out, which comes back whole, halfway: 2 x cross c_i f_i. Streaming keeps x cross c_i f_i of a population,
// collisions keep the momentum of a cell, and the exchange of a link acts along the line through its cell; so the
// fluid's angular momentum changes by walls, links, covered and refilled cells to round-off. (On the grains' side the
// load acts while they move on: there it holds up to the splitting of the step.)
TEST(Conservation, AngularMomentumOfTheFluidChangesByWallsLinksAndCellsThatChangeHands) {
  WaterBox box;
  box.cells = {26, 24, 25};
  box.periodic = {false, false, false};
  box.closed = true;
  box.viscosity = 1e-5;
  box.sub_steps = 20;
  box.links.momentum_exchange = bodies::MomentumExchange::classical;
  box.initial = [](const Vec3& p) {
    return FluidInitialState{0.0, 20.0 * Vec3(0.0096 - p.y(), p.x() - 0.0104, 0.3 * (p.x() - 0.01))};
  };
  box.seeds = {glass_sphere(0, Vec3(0.0081, 0.0083, 0.0101), Vec3(0.2, 0.1, -0.1)),
               glass_sphere(1, Vec3(0.0129, 0.0101, 0.0098), Vec3(-0.1, 0.2, 0.1))};
  for (dem::GrainSeed& seed : box.seeds) seed.angular_velocity = Vec3(50.0, -30.0, 20.0);
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  const auto angular = [&] {
    Vec3 sum = Vec3::Zero();
    for_each_fluid_cell(*system,
                        [&](const Vec3& x, std::ptrdiff_t cell) { sum += x.cross(momentum_of(*system, cell)); });
    return over_ranks(sum);
  };
  const auto to_walls = [&] {
    Vec3 sum = Vec3::Zero();
    for_each_fluid_cell(*system, [&](const Vec3& x, std::ptrdiff_t cell) {
      for (int i = 1; i < 19; ++i) {
        const Vec3 c(lbm::D3Q19::c[i][0], lbm::D3Q19::c[i][1], lbm::D3Q19::c[i][2]), next = x + c;
        bool outside = false;
        for (int a = 0; a < 3; ++a) outside = outside || next[a] < 0.0 || next[a] > box.cells[a];
        if (outside) sum += 2.0 * system->fluid().populations().post_collision(i, cell) * x.cross(c);
      }
    });
    return over_ranks(sum);
  };
  Vec3 before = angular();
  const double scale = before.norm();
  for (int step = 0; step < 60; ++step) {
    const Vec3 walls = to_walls();
    system->advance();
    const bodies::ExchangeTotals& t = system->bodies().step_totals();
    const Vec3 expected =
        before - walls + over_ranks(t.refilled_angular_momentum - t.covered_angular_momentum - t.link_angular_momentum);
    const Vec3 after = angular();
    ASSERT_NEAR((after - expected).norm(), 0.0, 1e-12 * scale) << step;
    before = after;
  }
}

}  // namespace
}  // namespace thalweg::coupling::conservation_test
