// Sums over the planes of a lattice, however large.
#include "coupling/loads/momentum_budget.hpp"

#include "core/sums/sum_range.hpp"

#include <gtest/gtest.h>

namespace thalweg::coupling::momentum_budget_test {
namespace {

// 64 bits in multiples of 2^-40 end at 2^23 cells of density 1: here as many in a small box, of a density of 1000.
TEST(MomentumBudget, HoldsPlanesOfMoreThanEightMillionCells) {
  const Index3 cells{96, 96, 3};
  const double plane = 96.0 * 96.0 * 1000.0;
  ASSERT_GT(plane, 0x1p23);
  const Decomposition decomposition(cells, 1.0, {true, true, true}, {1, 1, 1});
  lbm::CollisionParameters parameters;
  parameters.relaxation_time = 0.8;
  lbm::Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, {});
  fluid.initialise([](const Vec3&) { return lbm::FluidState{999.0, Vec3::Zero()}; });
  fluid.exchange_halo();
  SumRange::reset();
  const Units units{1e-3, 1e-4, 1000.0};
  const MomentumBudget budget = momentum_budget_of(fluid, units, 0.0, bodies::MomentumByHeight(0, 3));
  EXPECT_FALSE(SumRange::was_left());
  for (const PlaneMomentum& sums : budget.planes) {
    EXPECT_EQ(sums.cells, 96 * 96);
    // A population is rounded to half of its last digit: of 999/3 at most, 19 of them a cell.
    EXPECT_NEAR(sums.density, plane * units.density, 19.0 * 333.0 * 0x1p-53 * 96.0 * 96.0 * units.density);
  }
  SumRange::reset();
}

}  // namespace
}  // namespace thalweg::coupling::momentum_budget_test
