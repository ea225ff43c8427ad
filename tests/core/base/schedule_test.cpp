#include "core/base/schedule.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace thalweg::schedule_test {
namespace {

std::vector<std::int64_t> due_steps(const Schedule& schedule, std::int64_t first, std::int64_t last) {
  std::vector<std::int64_t> steps;
  for (std::int64_t step = first; step <= last; ++step)
    if (schedule.due(step)) steps.push_back(step);
  return steps;
}

TEST(Schedule, CountsFromStepZero) {
  const Schedule schedule(0.01, 0.002);
  EXPECT_EQ(schedule.interval(), 5);
  EXPECT_EQ(due_steps(schedule, 0, 15), (std::vector<std::int64_t>{0, 5, 10, 15}));
  EXPECT_FALSE(Schedule().due(0));
  EXPECT_EQ(Schedule().interval(), 0);
}

// The first step at or after 1.4 k: ceil(7 k/5).
TEST(Schedule, ComesAtTheFirstStepAtOrAfterEachMultiple) {
  std::vector<std::int64_t> expected;
  for (std::int64_t k = 0; k <= 714; ++k) expected.push_back((7 * k + 4) / 5);
  EXPECT_EQ(due_steps(Schedule(7e-5, 5e-5), 0, 1000), expected);
  EXPECT_EQ(Schedule(7e-5, 5e-5).interval(), 2);
}

TEST(Schedule, IsAtMostOnceAStep) {
  for (const double every : {1e-9, 0.3, 1.0, 1e-300}) {
    EXPECT_EQ(due_steps(Schedule(every, 1.0), 0, 50).size(), 51U) << every;
    EXPECT_EQ(Schedule(every, 1.0).interval(), 1) << every;
  }
  EXPECT_EQ(due_steps(Schedule(1e300, 1e-9), 0, 1000), (std::vector<std::int64_t>{0}));
}

// Intervals whose quotient by the step is whole but for rounding, in binary or in the decimals of a case.
TEST(Schedule, TakesQuotientsThatAreNearlyWholeAsWhole) {
  struct Pair {
    double every, step;
    std::int64_t steps;
  };
  for (const Pair& pair : {Pair{0.01, 1e-4, 100}, Pair{0.06, 2e-5, 3000}, Pair{0.3, 0.1, 3}, Pair{0.7, 0.1, 7},
                           Pair{0.002, 6.666666667e-05, 30}}) {
    const Schedule schedule(pair.every, pair.step);
    EXPECT_EQ(schedule.interval(), pair.steps);
    for (const std::int64_t k : {1LL, 2LL, 3LL, 1000LL, 1000000LL, 100000000LL})
      EXPECT_EQ(due_steps(schedule, k * pair.steps - 2, k * pair.steps + 2),
                (std::vector<std::int64_t>{k * pair.steps}));
  }
}

// 30.00003 steps: early by less than a thousandth of a step 33 times, then a step later.
TEST(Schedule, DoesNotDrift) {
  const Schedule schedule(1e-3, 3.33333e-5);
  const double quotient = 1e-3 / 3.33333e-5;
  EXPECT_TRUE(schedule.due(30));
  EXPECT_TRUE(schedule.due(990));
  EXPECT_FALSE(schedule.due(1020));
  EXPECT_TRUE(schedule.due(1021));
  for (const double k : {1e3, 33333333.0, 1e9}) {
    const auto step = static_cast<std::int64_t>(std::ceil(k * quotient - 1e-3));
    EXPECT_EQ(due_steps(schedule, step - 10, step + 10), (std::vector<std::int64_t>{step})) << k;
  }
}

// Over a stretch far out, as many as there are multiples.
TEST(Schedule, MissesNoMultipleAndMeetsNoneTwice) {
  for (const double every : {1.1, std::sqrt(2.0), 2.7182818, 8.7, 57.3}) {
    const Schedule schedule(every, 1.0);
    const std::int64_t first = 1000000000;
    const auto expected = std::floor((static_cast<double>(first) + 1e5 + 1e-3) / every) -
                          std::floor((static_cast<double>(first) - 1.0 + 1e-3) / every);
    EXPECT_EQ(static_cast<double>(due_steps(schedule, first, first + 100000).size()), expected) << every;
  }
}

// More steps than an integer holds, as of a time of 1e30 s that stands for never.
TEST(Schedule, OfATimeThatNoRunReachesIsDueAtTheStartOnly) {
  for (const double every : {1e14, 1e30, std::numeric_limits<double>::infinity()}) {
    const Schedule schedule(every, 1e-5);
    EXPECT_TRUE(schedule.due(0));
    for (const std::int64_t step : {std::int64_t{1}, std::int64_t{1000}, std::int64_t{1} << 40})
      EXPECT_FALSE(schedule.due(step)) << every;
  }
  EXPECT_EQ(whole_steps(4e18), 4'000'000'000'000'000'000);
  EXPECT_EQ(whole_steps(9e18), no_step_reaches);
}

}  // namespace
}  // namespace thalweg::schedule_test
