#include "analysis/correlated_mean.hpp"

#include "tests/analysis/made_up_series.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace thalweg::analysis::correlated_mean_test {
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

// The errors of the mean for blocks of 2^k values, k = 0, 1, ..., as the header defines them, as long as there are
// eight.
std::vector<double> squared_errors(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  std::vector<double> errors;
  for (std::size_t size = 1; values.size() / size >= 8; size *= 2) {
    double squares = 0.0, blocks = 0.0;
    for (std::size_t first = 0; first < values.size(); first += size, blocks += 1.0) {
      const std::size_t end = std::min(first + size, values.size());
      const auto length = static_cast<double>(end - first);
      const double block = std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(first),
                                           values.begin() + static_cast<std::ptrdiff_t>(end), 0.0) /
                           length;
      squares += length * (block - mean) * (block - mean);
    }
    errors.push_back(squares / ((blocks - 1.0) * n));
  }
  return errors;
}

// 183 values are 22 blocks of eight and seven values more: all are in the mean, and none may be missing from its error.
TEST(CorrelatedMean, CountsValuesThatFillNoBlock) {
  for (const int count : {15, 16, 17, 183, 255, 1000, 1023}) {
    for (const double a : {0.0, 0.5, 0.9}) {
      CorrelatedMean mean;
      std::vector<double> values;
      MadeUpChain chain(a, 11);
      for (int n = 0; n < count; ++n) values.push_back(chain.next());
      for (const double value : values) mean.add(value);
      const std::vector<double> errors = squared_errors(values);
      double expected = *std::max_element(errors.begin(), errors.end());
      for (std::size_t k = errors.size(); k-- > 0;)
        if (std::exp2(3.0 * static_cast<double>(k)) > 2.0 * count * std::pow(errors[k] / errors[0], 2))
          expected = errors[k];
      EXPECT_NEAR(mean.error().of_mean / std::sqrt(expected), 1.0, 1e-12) << count << " values, a = " << a;
    }
  }
}

// A record that ends as motion sets in: one event, from which no error can be told.
TEST(CorrelatedMean, IsNotSureOfABurstAtTheEnd) {
  CorrelatedMean mean;
  MadeUpChain chain(0.0, 5);
  for (int n = 0; n < 176; ++n) mean.add(1e-3 * chain.next());
  for (const double value : {0.02, 0.06, 0.16, 0.46, 0.92, 1.6, 2.7}) mean.add(value);
  const CorrelatedMean::Error error = mean.error();
  EXPECT_FALSE(error.blocks_long_enough);
  EXPECT_GT(error.of_mean, mean.deviation() / std::sqrt(183.0));
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
}  // namespace thalweg::analysis::correlated_mean_test
