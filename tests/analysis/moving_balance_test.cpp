// The balance of momentum by layers where grains move and cover and uncover cells.
#include "tests/analysis/balanced_box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace thalweg::analysis::moving_balance_test {
namespace {

// Momentum along x above the middle of the lowest plane of cells, after a step that was recorded, of fluid (without a
// body force) and grains; kg m/s, over all ranks.
double momentum_above(const LatticeSystem<double>& system, double spacing) {
  const dem::GrainStore& store = system.grains().store();
  double grains = 0.0, fluid = 0.0;
  for (std::size_t g = 0; g < store.owned; ++g) grains += store.mass[g] * store.velocity[g].x();
  const std::vector<PlaneMomentum>& planes = system.snapshot().momentum->planes;
  for (const PlaneMomentum& plane : planes) fluid += plane.flow.x();
  fluid -= 0.5 * planes.front().flow.x();
  return fluid * std::pow(spacing, 3) + sum_over_ranks(MPI_COMM_WORLD, grains);
}

// Momentum along x that the lowest plane of cells sends up and down in a step after one that was recorded, per area
// (Pa): P^c = rho u_x u_z + (1 - omega) Pi_xz, where the viscous stress is -(1 - omega/2) Pi_xz (BGK).
double sent(const LatticeSystem<double>& system, double omega) {
  const PlaneMomentum& plane = system.snapshot().momentum->planes.front();
  constexpr int xz = 4;
  return (plane.flow_flux[xz] - (1.0 - omega) / (1.0 - 0.5 * omega) * plane.viscous[xz]) /
         static_cast<double>(plane.cells);
}

// Grains carried along between two plates, the upper of which slides; they do not touch. Below all grains, in the
// lowest plane, total and driving stress differ by the change of momentum above the layer in time, and by what of the
// exchange is lost: with the classical exchange the momentum of uncovered cells less that of covered ones and what
// grains keep of it, all of which the system tells step by step. (P + P^c)/2 of a step is half of what arrives in it
// and half of what is sent in the next, so that of N steps (P^c_N - P^c_0)/(2 N) is too much. Counted over every step,
// nothing else is left but
//   the loads, which act from the middle of a sub-step to the middle of another: half a sub-step's share of them twice;
//   the momentum and the stress of a cell in the budget, rounded to within 2^-41.
void expect_closed(bool keep) {
  WaterBox box;
  box.cells = {24, 18, 30};
  box.periodic = {true, true, false};
  box.viscosity = 2.3e-4;  // tau = 0.6
  box.spacing = 5e-3 / 6.0;
  box.smagorinsky_constant = 0.0;
  box.plate_velocity = 0.8;
  box.bottom_at_rest = true;
  box.links.momentum_exchange = bodies::MomentumExchange::classical;
  box.keep_covered_momentum = keep;
  static double top;
  top = box.cells[2] * box.spacing;
  box.initial = [](const Vec3& p) { return coupling::FluidInitialState{0.0, Vec3(0.8 * p.z() / top, 0.0, 0.0)}; };
  for (int k = 0; k < 6; ++k)
    box.seeds.push_back(glass_sphere(k, Vec3((k % 3) * 6.6e-3 + 2e-3, (k / 3) * 7.4e-3 + 3e-3, 1.1e-2 + 4e-4 * k)));
  const auto system = system_of(box);
  for (int step = 0; step < 50; ++step) {
    system->record_momentum();
    system->measure_grain_stress();
    system->advance();
  }
  StressBalance balance = balance_of(box, *system, box.spacing, {});
  const Units units{box.spacing, box.time_step, 1000.0};
  const double area = 24.0 * 18.0 * box.spacing * box.spacing, start = momentum_above(*system, box.spacing);
  const double omega = 1.0 / units.relaxation_time(box.viscosity), sent_at_start = sent(*system, omega);
  constexpr int steps = 400;
  double lost = 0.0, exchanged = 0.0, largest_load = 0.0;
  for (int step = 0; step < steps; ++step) {
    system->record_momentum();
    system->measure_grain_stress();
    system->advance();
    const Snapshot snapshot = system->snapshot();
    balance.observe(snapshot);
    const bodies::ExchangeTotals& t = system->bodies().step_totals();
    const Vec3 net = t.covered - t.refilled - t.kept;
    lost += sum_over_ranks(MPI_COMM_WORLD, net.x()) * units.force() / (steps * area);
    exchanged += sum_over_ranks(MPI_COMM_WORLD, t.covered.x()) * units.force() / (steps * area);
    double load = 0.0;
    for (std::size_t g = 0; g < snapshot.grains.id.size(); ++g) {
      load += std::abs(snapshot.grains.fluid_force[g].x());
      ASSERT_EQ(snapshot.grains.contact_force[g], Vec3(Vec3::Zero()));
    }
    largest_load = std::max(largest_load, sum_over_ranks(MPI_COMM_WORLD, load) / area);
  }
  const double change = (momentum_above(*system, box.spacing) - start) / (steps * box.time_step * area);
  const double shifted = -(sent(*system, omega) - sent_at_start) / (2.0 * steps);
  const double cells = 24.0 * 18.0 * 30.0;
  const double bound = largest_load / (box.sub_steps * steps) + 2.0 * 0x1p-41 * cells * units.force() / (steps * area) +
                       0x1p-41 * units.stress();
  const Values values = by_name(balance);
  const double difference = values.at("total_stress").front() - values.at("driving_stress").front();
  ASSERT_EQ(values.at("solid_fraction").front(), 0.0);
  EXPECT_NEAR(difference, -change - lost + shifted, bound);
  EXPECT_GT(std::abs(change), 100.0 * bound);
  EXPECT_GT(std::abs(exchanged), 1000.0 * bound);
}

TEST(PackedGrainState, BalanceClosesWhereTheMomentumOfCoveredCellsIsLost) { expect_closed(false); }
TEST(PackedGrainState, BalanceClosesWhereGrainsKeepIt) { expect_closed(true); }

}  // namespace
}  // namespace thalweg::analysis::moving_balance_test
