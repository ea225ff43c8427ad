#include "driver/estimate/settling.hpp"

#include <gtest/gtest.h>

namespace thalweg::driver::settling_test {
namespace {

// Stokes' law; the sphere of benchmarks/validation/settle_in_water; ten Cate's E1 in an unbounded fluid (its README).
TEST(SettlingVelocity, FollowsTheDragLaw) {
  EXPECT_NEAR(settling_velocity(1e-4, 2.5, 9.81, 1e-3), 1.5 * 9.81 * 1e-8 / (18.0 * 1e-3), 1e-10);
  EXPECT_NEAR(settling_velocity(5e-3, 2.55, 9.8, 1e-6), 0.480, 0.005);
  EXPECT_NEAR(settling_velocity(0.015, 1120.0 / 970.0, 9.81, 0.373 / 970.0), 0.0409, 0.0003);
  EXPECT_EQ(settling_velocity(5e-3, 1.0, 9.8, 1e-6), 0.0);
  EXPECT_NEAR(settling_velocity(5e-3, 0.5, 9.8, 1e-6), settling_velocity(5e-3, 1.5, 9.8, 1e-6), 1e-12);  // rising
}

}  // namespace
}  // namespace thalweg::driver::settling_test
