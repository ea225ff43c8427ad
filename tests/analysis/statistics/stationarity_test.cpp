#include "analysis/statistics/stationarity.hpp"

#include "tests/analysis/made_up_series.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace thalweg::analysis::stationarity_test {
namespace {

// A chain of memory a about `mean`, with a rise over the whole length added to it.
CorrelatedMean chain_about(double mean, double a, int values, double rise, int seed) {
  CorrelatedMean series;
  MadeUpChain chain(a, static_cast<std::uint64_t>(seed));
  for (int n = 0; n < values; ++n) series.add(mean + chain.next() + rise * n / values);
  return series;
}

// How many of `runs` such chains get that verdict.
int verdicts(Trend trend, int runs, double mean, double a, int values, double rise) {
  int found = 0;
  for (int run = 1; run <= runs; ++run)
    if (trend_of(chain_about(mean, a, values, rise, run)).trend == trend) ++found;
  return found;
}

// One in twenty by the definition of the test: 20 of 400, give or take three times sqrt(400 0.05 0.95) = 4.4. The means
// are far above the scatter, so that all others are steady.
TEST(Stationarity, IsSeldomWrongAboutASteadySeries) {
  for (const auto& [a, values] : {std::pair{0.0, 1000}, {0.9, 4000}}) {
    const int drifting = verdicts(Trend::drifting, 400, 100.0, a, values, 0.0);
    EXPECT_NEAR(drifting, 20, 13) << a;
    EXPECT_EQ(verdicts(Trend::steady, 400, 100.0, a, values, 0.0), 400 - drifting) << a;
  }
}

// The slope of n independent values of variance 1 over the length 1 has the error sqrt(12/n): a rise of 5 times
// sqrt(12/n) is missed by a test at two errors once in a thousand times. A chain's error is larger by sqrt((1 + a)/(1 -
// a)) and by the 1/sqrt(1 - a^2) of its values.
TEST(Stationarity, SeesADrift) {
  EXPECT_GE(verdicts(Trend::drifting, 100, 0.0, 0.0, 1000, 5.0 * std::sqrt(12.0 / 1000.0)), 97);
  const double larger = std::sqrt((1.0 + 0.9) / (1.0 - 0.9) / (1.0 - 0.9 * 0.9));
  EXPECT_GE(verdicts(Trend::drifting, 100, 0.0, 0.9, 4000, 5.0 * larger * std::sqrt(12.0 / 4000.0)), 97);
}

// 100 independent values of variance 1: the drift is known to +- sqrt(12/100) = 0.35, and 0.7 is as much as may be.
// That is half of 1.4; a mean of 0.5 cannot be called steady, one of 10 is.
TEST(Stationarity, CallsNothingSteadyThatMayChangeByHalfOfItsMean) {
  EXPECT_LE(verdicts(Trend::steady, 100, 0.5, 0.0, 100, 0.0), 1);
  EXPECT_GE(verdicts(Trend::not_bounded, 100, 0.5, 0.0, 100, 0.0), 85);
  EXPECT_GE(verdicts(Trend::steady, 100, 10.0, 0.0, 100, 0.0), 85);
}

// Three independent values about 1 that rise or fall by as much: of 200 such series seldom one is called steady.
TEST(Stationarity, KnowsThatAFewValuesAreTooShort) {
  constexpr double values = 300.0, a = (values - 3.0) / (values + 3.0);
  const double deviation = 1.0 / std::sqrt(1.0 - a * a);
  for (const double rise : {-1.0, 0.0, 1.0}) {
    EXPECT_LE(verdicts(Trend::steady, 200, 3.0 * deviation, a, 300, 3.0 * rise * deviation), 2);
    EXPECT_GE(verdicts(Trend::too_few_values, 200, 3.0 * deviation, a, 300, 3.0 * rise * deviation), 185);
  }
}

TEST(Stationarity, FindsAStraightLine) {
  CorrelatedMean series;
  for (int n = 0; n < 640; ++n) series.add(3.0 - 2.0 * n / 640.0 + (n % 2 == 0 ? 1e-3 : -1e-3));
  const TrendVerdict verdict = trend_of(series);
  EXPECT_EQ(verdict.trend, Trend::drifting);
  EXPECT_NEAR(verdict.drift, -2.0, 1e-4);
  EXPECT_EQ(verdict.as_number(), 0.0);
}

TEST(Stationarity, KnowsWhatItCannotKnow) {
  CorrelatedMean series;
  for (int n = 0; n < 19; ++n) {
    EXPECT_EQ(trend_of(series).trend, Trend::too_few_values);
    EXPECT_EQ(std::isnan(trend_of(series).drift), n < 3);
    series.add(1.0);
  }
  EXPECT_EQ(trend_of(series).as_number(), -1.0);
  series.add(1.0);
  EXPECT_EQ(trend_of(series).trend, Trend::steady);  // twenty times the same
  EXPECT_NEAR(trend_of(series).drift, 0.0, 1e-12);
}

TEST(Stationarity, TakesStudentsNumbers) {  // of tables
  EXPECT_NEAR(student_t_of_5_percent(2.0) / 4.3027, 1.0, 0.01);
  EXPECT_NEAR(student_t_of_5_percent(3.0) / 3.1824, 1.0, 0.002);
  EXPECT_NEAR(student_t_of_5_percent(10.0), 2.2281, 1e-3);
  EXPECT_NEAR(student_t_of_5_percent(60.0), 2.0003, 1e-4);
}

}  // namespace
}  // namespace thalweg::analysis::stationarity_test
