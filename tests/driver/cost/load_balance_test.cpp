// Cuts between ranks against the work of a slab counted by hand.
#include "driver/cost/load_balance.hpp"

#include "driver/setup/build_system.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace thalweg::driver::load_balance_test {
namespace {

// 24 x 8 x 100 cells of 0.5 mm.
Case column() {
  Case c = wide_bed();
  c.domain.size = Vec3(0.012, 0.004, 0.05);
  return c;
}

int cut_along_z(const Decomposition& cuts) { return cuts.block_of(0).upper[2]; }

TEST(WorkCuts, StayEvenWithoutGrains) {
  const Decomposition even = decomposition_of(column(), {1, 1, 2});
  EXPECT_EQ(balanced_partition(column(), even, {}, MPI_COMM_SELF), even);
}

// 192 cells of 6.5 ns are 1.248 us in each of the 100 layers. A grain of ten cells has 1580 links of 13 ns and 50
// sub-steps of 45 ns: 22.79 us. Six of them with their centres at 0.01 m fill cells 15 to 25 with 12.43 us each: half
// of all, 130.8 us, is reached in the ninth of these, before whose end there are 24 * 1.248 + 9 * 12.43 = 141.8 us and
// before whose beginning, which is nearer, 128.1 us.
TEST(WorkCuts, HalveTheWorkOfABed) {
  const Decomposition even = decomposition_of(column(), {1, 1, 2});
  const std::vector<dem::PlacedSphere> grains(6, {Vec3(0.006, 0.002, 0.01), 2.5e-3});
  const Decomposition cuts = balanced_partition(column(), even, grains, MPI_COMM_SELF);
  EXPECT_EQ(cut_along_z(even), 50);
  EXPECT_EQ(cut_along_z(cuts), 23);
}

// Where gravity holds the grains on the floor a plan has most of the work there; along x nothing changes.
TEST(WorkCuts, OfAPlanFollowTheSettledBed) {
  Case c = wide_bed();
  const Decomposition even = decomposition_of(c, {2, 1, 2}), planned = planned_partition(c, {2, 1, 2});
  EXPECT_EQ(planned.block_of(0).upper[0], even.block_of(0).upper[0]);
  EXPECT_LT(cut_along_z(planned), cut_along_z(even));
  c.system = SystemKind::fluid;
  EXPECT_EQ(planned_partition(c, {2, 1, 2}), even);
}

// 19200 cells of 6.5 ns are 124.8 us in each of 212 layers. Of 500 grains of ten cells and as many of 2.5, which make a
// bed of 24 layers, links and sub-steps are 11.40 and 1.77 ms. Half of all, 19.81 ms, is reached 29.3 layers above the
// bed. With the links of their median, that of the large ones, it would be in the bed.
TEST(WorkCuts, OfAPlanCountTheLinksOfEachSize) {
  Case c = wide_bed();
  beds::Population& grains = c.grains.front();
  grains.diameters.assign(static_cast<std::size_t>(grains.count), grains.diameter);
  std::fill_n(grains.diameters.begin(), grains.count / 2, 0.25 * grains.diameter);
  EXPECT_NEAR(cut_along_z(planned_partition(c, {1, 1, 2})), 53, 1);
}

}  // namespace
}  // namespace thalweg::driver::load_balance_test
