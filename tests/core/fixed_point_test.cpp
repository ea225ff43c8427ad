#include "core/fixed_point.hpp"
#include "core/wide_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace thalweg {
namespace {

TEST(FixedPoint, SumDoesNotDependOnTheOrder) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> terms(5000);
  for (double& t : terms) t = uniform(generator);
  const auto sum = [&] {
    std::int64_t s = 0;
    for (double t : terms) s += LatticeFixed::from(t);
    return s;
  };
  const std::int64_t first = sum();
  std::shuffle(terms.begin(), terms.end(), generator);
  EXPECT_EQ(sum(), first);
  // Each term is rounded by at most half a unit of 2^-44.
  EXPECT_NEAR(LatticeFixed::to_double(first), std::accumulate(terms.begin(), terms.end(), 0.0), 5000 * 0x1p-45 + 1e-11);
}

TEST(FixedPoint, RoundsToTheNearestAndTiesToEven) {
  using Quarter = FixedPoint<2>;
  EXPECT_EQ(Quarter::from(0.3), 1);
  EXPECT_EQ(Quarter::from(-0.3), -1);
  EXPECT_EQ(Quarter::from(0.125), 0);
  EXPECT_EQ(Quarter::from(0.375), 2);
  EXPECT_EQ(Quarter::from(-0.375), -2);
  EXPECT_EQ(LatticeFixed::from(-100.0), -100 * (std::int64_t{1} << 44));
  EXPECT_EQ(LatticeFixed::to_double(LatticeFixed::from(100.0 + 0x1p-44)), 100.0 + 0x1p-44);
}

TEST(WideSum, GrowsBeyondSixtyFourBitsAndBack) {
  constexpr std::int64_t large = std::int64_t{1} << 62;
  WideSum sum;
  for (int n = 0; n < 1000; ++n) sum.add(large);
  EXPECT_EQ(sum.to_double(62), 1000.0);
  sum.add(-1);
  WideSum same;
  same.add(-1);
  for (int n = 0; n < 1000; ++n) same.add(large);
  EXPECT_EQ(sum, same);  // whatever the order
  for (int n = 0; n < 2000; ++n) sum.add(-large);
  EXPECT_EQ(sum.to_double(62), -1000.0);
  for (int n = 0; n < 1000; ++n) sum.add(large);
  EXPECT_EQ(sum.to_double(0), -1.0);
  sum.add(WideSum{0, 8});
  EXPECT_EQ(sum.to_double(1), 3.5);
}

}  // namespace
}  // namespace thalweg
