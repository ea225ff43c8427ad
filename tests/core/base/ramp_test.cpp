#include "core/base/ramp.hpp"

#include <gtest/gtest.h>

namespace thalweg::ramp_test {
namespace {

TEST(Ramp, IsZeroBeforeAndOneAfter) {
  EXPECT_EQ(ramp_mean(-1.0, 0.0, 10.0), 0.0);
  EXPECT_EQ(ramp_mean(10.0, 11.0, 10.0), 1.0);
  EXPECT_EQ(ramp_mean(0.0, 1.0, 0.0), 1.0);
  EXPECT_EQ(ramp_mean(-1.0, 0.0, 0.0), 0.0);  // the step before the first
}

// S(x) = x^3 - x^4/2: 1/2 over the whole rise, S(1/2) = 3/32 over its first half.
TEST(Ramp, MeansAreThoseOfTheIntegral) {
  EXPECT_NEAR(ramp_mean(0.0, 7.0, 7.0), 0.5, 1e-16);
  EXPECT_NEAR(ramp_mean(0.0, 3.5, 7.0), 2.0 * 3.0 / 32.0, 1e-16);
  EXPECT_NEAR(ramp_mean(0.0, 14.0, 7.0), 0.75, 1e-16);
  EXPECT_NEAR(ramp_mean(0.0, 1.0, 0.25), (0.125 + 0.75), 1e-16);  // shorter than a step
}

// Steps that follow each other add up to the integral whatever the duration is in steps: T/2 and what comes after. The
// sum of a million terms below one rounds by less than a million times 2^-53 of it.
TEST(Ramp, StepsAddUpToTheIntegral) {
  for (const double duration : {0.3, 1.0, 37.6, 500000.25}) {
    double sum = 0.0;
    constexpr int steps = 1000000;
    for (int step = 1; step <= steps; ++step) sum += ramp_mean(step - 1.0, step, duration);
    EXPECT_NEAR(sum, steps - 0.5 * duration, 1e-10 * steps) << duration;
  }
}

TEST(Ramp, RisesAllTheTime) {
  for (int step = 1; step <= 100; ++step)
    EXPECT_GT(ramp_mean(step, step + 1.0, 101.0), ramp_mean(step - 1.0, step, 101.0)) << step;
}

}  // namespace
}  // namespace thalweg::ramp_test
