// Sums of the stress balance: the same on any ranks and after a restart, of a run that does not notice.
#include "tests/analysis/balanced_box.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

namespace thalweg::analysis::stress_balance_ranks_test {
namespace {

// The same sums, bit by bit, whatever the ranks; measured again from a saved state, the means go on as if nothing had
// been; and a run that is looked at has the same bits as one that is not.
void looks_without_touching(bool side_walls) {
  WaterBox box;
  box.cells = {32, 24, 24};
  box.periodic = {true, !side_walls, false};
  box.gravity = Vec3(0.5, 0.0, -9.8);
  for (int k = 0; k < 6; ++k)
    box.seeds.push_back(glass_sphere(k, Vec3(6.4e-3 * (k % 3) + 1e-3, 8e-3 * (k / 3) + 2.51e-3, 6e-3 + 1e-3 * k),
                                     Vec3(0.2, side_walls ? -0.1 : 0.05 * k, -0.1)));
  const auto watched = system_of(box), alone = system_of(box);
  StressBalance balance = balance_of(box, *watched, 1.25e-3, {});
  const auto serial = make_system<double>(box, MPI_COMM_SELF, {1, 1, 1});
  StressBalance of_one = balance_of(box, *serial, 1.25e-3, {}, MPI_COMM_SELF);
  StressBalance again = balance_of(box, *watched, 1.25e-3, {});
  for (int step = 0; step < 20; ++step) {
    watched->record_momentum();
    watched->measure_grain_stress();
    serial->record_momentum();
    serial->measure_grain_stress();
    watched->advance();
    alone->advance();
    serial->advance();
    balance.observe(watched->snapshot());
    of_one.observe(serial->snapshot());
    if (step == 9) {
      thalweg::test::load(again, thalweg::test::saved(balance, MPI_COMM_WORLD));
    }
    if (step > 9) again.observe(watched->snapshot());
  }
  EXPECT_EQ(by_name(balance), by_name(again));
  EXPECT_EQ(by_name(balance), by_name(of_one));
  EXPECT_EQ(by_name(balance).at("side_wall_stress").front() != 0.0, side_walls);
  const GrainView seen = watched->snapshot().grains, unseen = alone->snapshot().grains;
  ASSERT_EQ(seen.id.size(), unseen.id.size());
  for (std::size_t g = 0; g < seen.id.size(); ++g) {
    EXPECT_EQ(seen.position[g], unseen.position[g]);
    EXPECT_EQ(seen.fluid_torque[g], unseen.fluid_torque[g]);
  }
  EXPECT_EQ(watched->fluid().totals().momentum, alone->fluid().totals().momentum);
}

TEST(StressBalanceOnRanks, LooksWithoutTouchingAndGoesOnAfterARestart) { looks_without_touching(false); }
TEST(StressBalanceOnRanks, LooksWithoutTouchingBetweenSideWalls) { looks_without_touching(true); }

}  // namespace
}  // namespace thalweg::analysis::stress_balance_ranks_test
