#include "driver/plan/solve.hpp"

#include "tests/driver/case_texts.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace thalweg::driver::solve_test {
namespace {

const std::string river = R"(system: resolved
domain: {size: [0.06, 0.03, 0.055], spacing: 1.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6}
gravity: {magnitude: 9.81, slope: 0.02}
grains: [{count: 400, diameter: 5.0e-3, density: 2650, placement: {pattern: random}}]
initial: {fluid: {log_profile: {}}}
contact: {restitution: 0.9, friction: 0.5}
coupling: {fewest_cells_per_diameter: 5}
run: {until: 1}
)";

// The start that a case fills in suits its flow, and its cells are fine enough; ninety times as fast they are not.
TEST(Solve, MendsTheStartBeforeTheCellsThatItWouldNeed) {
  const Case right = testing::read_text(river);
  ASSERT_TRUE(solve(right).changes.empty());
  const Solution solution = solve(testing::read_text(river, {"initial.fluid.log_profile.shear_velocity=7"}));
  ASSERT_EQ(solution.changes.size(), 1u);
  EXPECT_EQ(solution.changes.front().key, "initial.fluid.log_profile.shear_velocity");
  const double suits = *right.initial.fluid.log_profile->shear_velocity;
  EXPECT_NEAR(std::stod(solution.changes.front().value), suits, 5e-3 * suits);
  EXPECT_TRUE(solution.left.empty());
}

}  // namespace
}  // namespace thalweg::driver::solve_test
