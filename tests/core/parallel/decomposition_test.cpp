#include "core/parallel/decomposition.hpp"
#include "core/base/error.hpp"

#include <gtest/gtest.h>

namespace thalweg::decomposition_test {
namespace {

TEST(Decomposition, BlocksTileTheBox) {
  const Index3 cells{37, 13, 22};
  const Decomposition decomposition(cells, 1.0, {true, true, false}, {3, 2, 2});
  std::vector<int> owners(37 * 13 * 22, 0);
  for (int rank = 0; rank < decomposition.ranks(); ++rank) {
    const Block b = decomposition.block_of(rank);
    for (int z = b.lower[2]; z < b.upper[2]; ++z)
      for (int y = b.lower[1]; y < b.upper[1]; ++y)
        for (int x = b.lower[0]; x < b.upper[0]; ++x) {
          ++owners[(z * 13 + y) * 37 + x];
          EXPECT_EQ(decomposition.owner_of(Vec3(x + 0.5, y + 0.5, z + 0.5)), rank);
        }
  }
  for (int count : owners) EXPECT_EQ(count, 1);
}

// Cells on the cut faces, those of x four times and those of z 32 times: 4 * 13 * 90 < 72 * 90, and so on.
TEST(Decomposition, CutsPlanBeforeTheVerticalAndLeavesLongRowsWhole) {
  EXPECT_EQ(Decomposition::best_layout({72, 13, 90}, 2), (Index3{2, 1, 1}));
  EXPECT_EQ(Decomposition::best_layout({72, 13, 90}, 8), (Index3{4, 2, 1}));
  EXPECT_EQ(Decomposition::best_layout({240, 80, 200}, 2), (Index3{1, 2, 1}));
  EXPECT_EQ(Decomposition::best_layout({240, 80, 200}, 4), (Index3{2, 2, 1}));
}

// The law of the wall needs five cells along y.
TEST(Decomposition, LeavesARankTheCellsItNeeds) {
  const Index3 cells{72, 13, 90}, least{4, 5, 4};
  EXPECT_EQ(Decomposition::best_layout(cells, 12), (Index3{4, 3, 1}));
  EXPECT_EQ(Decomposition::best_layout(cells, 12, least), (Index3{6, 2, 1}));
  EXPECT_THROW(Decomposition(cells, 1.0, {true, false, false}, {4, 3, 1}, least), InputError);
  const Decomposition even(cells, 1.0, {true, false, false}, {1, 2, 1}, least);
  std::array<std::vector<std::int64_t>, 3> weights;
  for (std::size_t a = 0; a < 3; ++a) weights[a].assign(static_cast<std::size_t>(cells[a]), 1);
  weights[1][0] = 1000;
  EXPECT_EQ(even.balanced(weights).block_of(0).size()[1], 5);
}

TEST(Decomposition, RefusesMoreRanksThanCellsAllow) {
  EXPECT_THROW(Decomposition::best_layout({6, 6, 6}, 64), InputError);
  EXPECT_THROW(Decomposition({6, 6, 6}, 1.0, {true, true, true}, {2, 1, 1}), InputError);
  EXPECT_THROW(Decomposition({-1, 8, 8}, 1.0, {true, true, true}, {1, 1, 1}), InputError);
  EXPECT_THROW(Decomposition({8, 8, 8}, 0.0, {true, true, true}, {1, 1, 1}), InputError);
}

TEST(Decomposition, WrapsRanksOnPeriodicAxesOnly) {
  const Decomposition d({40, 40, 40}, 1.0, {true, false, false}, {4, 2, 1});
  EXPECT_EQ(d.rank_at({-1, 0, 0}), d.rank_at({3, 0, 0}));
  EXPECT_EQ(d.rank_at({0, -1, 0}), -1);
}

TEST(Decomposition, ReachesAcrossThePeriodicFace) {
  const Decomposition d({40, 40, 40}, 0.5, {true, false, false}, {2, 1, 1});
  EXPECT_TRUE(d.reaches(0, Vec3(19.7, 5.0, 5.0), 0.5));  // wraps round to the low face of rank 0
  EXPECT_FALSE(d.reaches(0, Vec3(19.3, 5.0, 5.0), 0.5));
  EXPECT_TRUE(d.reaches(0, Vec3(10.4, 5.0, 5.0), 0.5));
  EXPECT_FALSE(d.reaches(0, Vec3(10.6, 5.0, 5.0), 0.5));
}

TEST(PeriodicBox, MinimumImageIsAntisymmetricToTheBit) {
  const PeriodicBox box{Vec3(1.0, 2.0, 3.0), {true, true, false}};
  const Vec3 a(0.03, 1.97, 0.1), b(0.99, 0.02, 2.9);
  EXPECT_EQ(box.difference(a, b), Vec3(-box.difference(b, a)));
  EXPECT_NEAR(box.difference(a, b).x(), 0.04, 1e-15);
  EXPECT_NEAR(box.difference(a, b).y(), -0.05, 1e-15);
  EXPECT_NEAR(box.difference(a, b).z(), -2.8, 1e-15);
}

TEST(PeriodicBox, WrapNeverReturnsTheUpperFace) {
  const PeriodicBox box{Vec3(1.0, 1.0, 1.0), {true, true, true}};
  EXPECT_LT(box.wrapped(Vec3(-1e-20, 1.0, 0.5)).maxCoeff(), 1.0);
}

// A cut that must stand between cells is off by half the heaviest plane at most, so a slab holds no more than its share
// and one such plane.
TEST(Decomposition, BalancedCutsShareTheWeights) {
  const Index3 cells{60, 40, 37};
  const Decomposition even(cells, 1.0, {true, true, false}, {5, 1, 3});
  std::array<std::vector<std::int64_t>, 3> weights;
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < cells[a]; ++k) weights[a].push_back(a == 0 ? 3 + k % 4 : std::max(0, 30 - k));
  const Decomposition cut = even.balanced(weights);
  for (int a = 0; a < 3; ++a) {
    std::int64_t total = 0, heaviest = 0;
    for (const std::int64_t weight : weights[a]) total += weight, heaviest = std::max(heaviest, weight);
    for (int rank = 0; rank < cut.ranks(); ++rank) {
      const Block block = cut.block_of(rank);
      std::int64_t sum = 0;
      for (int k = block.lower[a]; k < block.upper[a]; ++k) sum += weights[a][k];
      EXPECT_LE(sum * cut.layout()[a], total + heaviest * cut.layout()[a]);
      EXPECT_GE(block.size()[a], Decomposition::min_cells_per_rank);
    }
  }
  // Along z the lower third of the weight takes less than a third of the height.
  EXPECT_LT(cut.block_of(0).upper[2], even.block_of(0).upper[2]);
  EXPECT_EQ(even.balanced({std::vector<std::int64_t>(60, 1), std::vector<std::int64_t>(40, 1),
                           std::vector<std::int64_t>(37, 1)})
                .block_of(7)
                .lower[0],
            even.block_of(7).lower[0]);
}

TEST(Decomposition, BalancedCutsLeaveEveryRankItsLeastCells) {
  const Decomposition even({40, 8, 8}, 1.0, {true, true, true}, {8, 1, 1});
  std::array<std::vector<std::int64_t>, 3> weights{std::vector<std::int64_t>(40, 0), std::vector<std::int64_t>(8, 1),
                                                   std::vector<std::int64_t>(8, 1)};
  weights[0][39] = 100;  // all in the last plane
  const Decomposition cut = even.balanced(weights);
  for (int rank = 0; rank < 8; ++rank) EXPECT_GE(cut.block_of(rank).size()[0], Decomposition::min_cells_per_rank);
}

}  // namespace
}  // namespace thalweg::decomposition_test
