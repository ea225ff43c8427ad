#include "analysis/trend_test.hpp"

#include "tests/analysis/made_up_series.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::analysis::trend_test_test {
namespace {

// How many of `runs` chains of memory a are said to drift, with a rise over the whole length added to them.
int drifting_ones(double a, int runs, int values, double rise) {
  int drifting = 0;
  for (int run = 0; run < runs; ++run) {
    MadeUpChain chain(a, static_cast<std::uint64_t>(run) + 1);
    TrendTest test;
    for (int n = 0; n < values; ++n) test.add(chain.next() + rise * n / values);
    if (test.verdict().trend == Trend::drifting) ++drifting;
  }
  return drifting;
}

// One in twenty by the definition of the test: 20 of 400, give or take three times sqrt(400 0.05 0.95) = 4.4.
TEST(TrendTest, IsSeldomWrongAboutASteadySeries) {
  const int of_noise = drifting_ones(0.0, 400, 1000, 0.0), of_chain = drifting_ones(0.9, 400, 4000, 0.0);
  EXPECT_NEAR(of_noise, 20, 13);
  EXPECT_NEAR(of_chain, 20, 13);
}

// The slope of n independent values of variance 1 over the length 1 has the error sqrt(12/n): a rise of 5 times
// sqrt(12/n) is missed by a test at two errors once in a thousand times. A chain's error is larger by sqrt((1 + a)/(1 -
// a)) and by the 1/sqrt(1 - a^2) of its values.
TEST(TrendTest, SeesADrift) {
  EXPECT_GE(drifting_ones(0.0, 100, 1000, 5.0 * std::sqrt(12.0 / 1000.0)), 97);
  const double larger = std::sqrt((1.0 + 0.9) / (1.0 - 0.9) / (1.0 - 0.9 * 0.9));
  EXPECT_GE(drifting_ones(0.9, 100, 4000, 5.0 * larger * std::sqrt(12.0 / 4000.0)), 97);
}

TEST(TrendTest, FindsAStraightLine) {
  TrendTest test;
  for (int n = 0; n < 640; ++n) test.add(3.0 - 2.0 * n / 640.0 + (n % 2 == 0 ? 1e-3 : -1e-3));
  const TrendTest::Verdict verdict = test.verdict();
  EXPECT_EQ(verdict.trend, Trend::drifting);
  EXPECT_NEAR(verdict.drift, -2.0, 1e-6);
}

TEST(TrendTest, KnowsWhatItCannotKnow) {
  TrendTest test;
  for (std::size_t n = 0; n + 1 < TrendTest::fewest_batches; ++n) test.add(1.0);
  EXPECT_EQ(test.verdict().trend, Trend::too_short);
  test.add(1.0);
  EXPECT_EQ(test.verdict().trend, Trend::steady);  // eight times the same
  EXPECT_EQ(test.verdict().drift, 0.0);
}

TEST(TrendTest, GoesOnFromItsState) {
  TrendTest whole, first, second;
  MadeUpChain chain(0.5, 1);
  for (int n = 0; n < 1000; ++n) {
    const double value = chain.next();
    whole.add(value);
    (n < 321 ? first : second).add(value);
    if (n == 320) second.restore(first.state());
  }
  EXPECT_EQ(whole.state(), second.state());
  EXPECT_LE(whole.state().size(), 3 + TrendTest::most_batches);
}

TEST(TrendTest, TakesStudentsNumbers) {  // of tables
  EXPECT_NEAR(student_t_of_5_percent(2.0) / 4.3027, 1.0, 0.01);
  EXPECT_NEAR(student_t_of_5_percent(3.0) / 3.1824, 1.0, 0.002);
  EXPECT_NEAR(student_t_of_5_percent(10.0), 2.2281, 1e-3);
  EXPECT_NEAR(student_t_of_5_percent(60.0), 2.0003, 1e-4);
}

}  // namespace
}  // namespace thalweg::analysis::trend_test_test
