#include "driver/estimate/laminar_channel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace thalweg::driver::laminar_channel_test {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

TEST(LaminarChannel, BetweenPlatesIsTheParabola) {
  for (const LaminarChannel& flow :
       {laminar_channel(2.0, 3e-3, infinite, 1e-4), laminar_channel(2.0, infinite, 3e-3, 1e-4)}) {
    EXPECT_NEAR(flow.largest, 2.0 * 9e-6 / 2e-4, 1e-12);
    EXPECT_NEAR(flow.mean, 2.0 / 3.0 * flow.largest, 1e-12);
  }
  EXPECT_NEAR(laminar_channel(2.0, 3e-3, 3.0, 1e-4).mean, 2.0 * 9e-6 / 3e-4 * (1.0 - 0.630 * 1e-3), 1e-7);
}

// Shah and London (1978), Laminar Flow Forced Convection in Ducts, table 42: the friction factor times the Reynolds
// number, f Re = g D^2/(2 nu U) with the hydraulic diameter D, and u_max/U.
TEST(LaminarChannel, OfARectangleIsThatOfTheTables) {
  struct Row {
    double ratio, friction, largest_over_mean;
  };
  for (const Row& row : {Row{1.0, 14.227, 2.096}, Row{2.0, 15.548, 1.992}, Row{4.0, 18.233, 1.774}}) {
    const double a = 2e-3, b = row.ratio * a, diameter = 4.0 * a * b / (a + b);
    const LaminarChannel flow = laminar_channel(0.5, b, a, 1e-6);
    EXPECT_NEAR(0.5 * diameter * diameter / (2.0 * 1e-6 * flow.mean), row.friction, 1e-3) << row.ratio;
    EXPECT_NEAR(flow.largest / flow.mean, row.largest_over_mean, 2e-3) << row.ratio;
  }
}

// exp(-lambda t) of the difference is left, lambda = nu pi^2/4 (1/a^2 + 1/b^2), (8/pi^2)^2 of the mean at first.
TEST(LaminarChannel, StartsByItsSlowestMode) {
  const double pi = std::numbers::pi, rate = 1e-6 * 0.25 * pi * pi * (1.0 / 4e-6 + 1.0 / 9e-6);
  const double left = std::pow(8.0 / (pi * pi), 2) * std::exp(-rate * laminar_channel(1.0, 2e-3, 3e-3, 1e-6).spin_up);
  EXPECT_NEAR(left, 0.04, 0.01);
}

}  // namespace
}  // namespace thalweg::driver::laminar_channel_test
