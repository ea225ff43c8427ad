#include "analysis/correlated_mean.hpp"

#include "tests/analysis/made_up_series.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::analysis {
namespace {

TEST(CorrelatedMean, HasMeanAndDeviationOfItsValues) {
  CorrelatedMean mean;
  EXPECT_EQ(mean.mean(), 0.0);
  for (const double value : {1.0, 4.0, 2.0, 5.0}) mean.add(value);
  EXPECT_EQ(mean.count(), 4);
  EXPECT_DOUBLE_EQ(mean.mean(), 3.0);
  EXPECT_DOUBLE_EQ(mean.deviation(), std::sqrt(2.5));
}

TEST(CorrelatedMean, OfEqualValuesIsExact) {
  CorrelatedMean mean;
  for (int n = 0; n < 100; ++n) mean.add(0.1);
  EXPECT_EQ(mean.error().of_mean, 0.0);
  EXPECT_TRUE(mean.error().blocks_long_enough);
}

// A chain x' = a x + e has the variance 1/(1 - a^2) of e's, the mean of n of them the square error (1 + a)/(1 - a) of
// independent ones, and the integrated autocorrelation time (1 + a)/(1 - a)/2 intervals (Sokal 1989). An error from m
// blocks is itself off by 1/sqrt(2 (m - 1)) at one standard deviation; three of them and the few per cent that blocks
// of finite length lack are allowed.
TEST(CorrelatedMean, KnowsItsErrorInAChainOfKnownMemory) {
  constexpr int values = 1 << 16;
  for (const double a : {0.0, 0.5, 0.9}) {
    const double worth = (1.0 + a) / (1.0 - a);
    const double expected = std::sqrt(worth / (1.0 - a * a) / values);
    CorrelatedMean mean;
    MadeUpChain chain(a, 7);
    for (int n = 0; n < values; ++n) mean.add(chain.next());
    const CorrelatedMean::Error error = mean.error();
    const double block = std::cbrt(2.0 * values * worth * worth);  // at most twice as long
    const double allowed = 3.0 / std::sqrt(2.0 * (values / (2.0 * block) - 1.0)) + worth / block;
    EXPECT_TRUE(error.blocks_long_enough);
    EXPECT_NEAR(error.of_mean / expected, 1.0, allowed) << a;
    EXPECT_NEAR(error.correlation_time / (0.5 * worth), 1.0, 2.0 * allowed + allowed * allowed) << a;
    EXPECT_LT(std::abs(mean.mean()), 4.0 * expected) << a;
  }
}

TEST(CorrelatedMean, SaysWhenItIsTooShort) {
  CorrelatedMean mean;
  MadeUpChain chain(0.999, 3);  // memory of 1000 values
  for (int n = 0; n < 300; ++n) mean.add(chain.next());
  EXPECT_FALSE(mean.error().blocks_long_enough);
}

// A series worth twenty values: three blocks that are long enough agree by chance one time in five to half of their
// error. The scatter of eight is off by a quarter at one standard deviation, so that half is two of them: 2.3 % of 200
// series, give or take three times the root of that.
TEST(CorrelatedMean, IsNotSureByChance) {
  constexpr double a = 0.95, worth = (1.0 + a) / (1.0 - a);
  constexpr int series = 200, values = 800;
  const double expected = std::sqrt(worth / (1.0 - a * a) / values);
  int too_sure = 0;
  for (int seed = 1; seed <= series; ++seed) {
    CorrelatedMean mean;
    MadeUpChain chain(a, static_cast<std::uint64_t>(seed));
    for (int n = 0; n < values; ++n) mean.add(chain.next());
    const CorrelatedMean::Error error = mean.error();
    if (error.blocks_long_enough && error.of_mean < 0.5 * expected) ++too_sure;
  }
  EXPECT_LE(too_sure, 11);
}

TEST(CorrelatedMean, GoesOnFromItsState) {
  CorrelatedMean whole, first, second;
  MadeUpChain chain(0.5, 1);
  for (int n = 0; n < 1000; ++n) {
    const double value = chain.next();
    whole.add(value);
    (n < 123 ? first : second).add(value);
    if (n == 122) second.restore(first.state());
  }
  EXPECT_EQ(whole.state(), second.state());
  EXPECT_LE(whole.state().size(), CorrelatedMean::numbers_a_level * 10);  // 2^9 < 1000 < 2^10
}

}  // namespace
}  // namespace thalweg::analysis
