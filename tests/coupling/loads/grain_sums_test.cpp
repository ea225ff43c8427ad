#include "coupling/loads/grain_sums.hpp"

#include <gtest/gtest.h>

namespace thalweg::coupling::grain_sums_test {
namespace {

GrainSums sums_from(std::int64_t first) {
  GrainSums sums{{first, first + 1, first + 2}, {first + 3, first + 4, first + 5}, first + 6, first + 7, {}};
  for (std::size_t k = 0; k < bodies::LinkSums::size; ++k)
    sums.links.sums[k] = first + 8 + static_cast<std::int64_t>(k);
  return sums;
}

// Rows are added number by number, as those of ghosts to those of owners are.
TEST(GrainSums, AddUpAsPlainIntegers) {
  GrainSumRows owner, ghost;
  owner.begin(3, true);
  ghost.begin(3, true);
  for (std::size_t g = 0; g < 3; ++g) {
    owner.set(g, sums_from(100 * static_cast<std::int64_t>(g)));
    ghost.set(g, sums_from(1));
    StressSums stress;
    stress.moments.sums = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    stress.occluded_by_solids = {-1, -2, -3};
    owner.set(g, stress);
    ghost.set(g, stress);
  }
  ASSERT_EQ(owner.values().size(), 3u * static_cast<std::size_t>(owner.width()));
  for (std::size_t k = 0; k < owner.values().size(); ++k) owner.values()[k] += ghost.values()[k];
  const GrainSums sum = owner.of(2);
  EXPECT_EQ(sum.force.x, 201);
  EXPECT_EQ(sum.torque.z, 211);
  EXPECT_EQ(sum.mass, 213);
  EXPECT_EQ(sum.pressure, 215);
  EXPECT_EQ(sum.links.sums.front(), 217);
  EXPECT_EQ(sum.links.sums.back(), 235);
  EXPECT_EQ(owner.stress_of(2).moments.sums[8], 18);
  EXPECT_EQ(owner.stress_of(2).occluded_by_solids[2], -6);
}

TEST(GrainSums, HaveNoStressUnlessItIsMeasured) {
  GrainSumRows plain;
  plain.begin(2, true);
  plain.begin(2, false);
  EXPECT_EQ(plain.width(), 18);
  EXPECT_NO_THROW(plain.of(1));
  EXPECT_THROW(plain.of(2), ContractError);
  EXPECT_THROW(plain.stress_of(0), ContractError);
}

}  // namespace
}  // namespace thalweg::coupling::grain_sums_test
