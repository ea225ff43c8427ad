#include "driver/warnings/plan_warnings.hpp"

#include "driver/estimate/filled_in.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "driver/estimate/settling.hpp"
#include "driver/warnings/case_warnings.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/driver/text_search.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::driver::plan_warnings_test {
namespace {

// A bed under water so viscous that it flows laminarly, over `more` keys.
Case viscous(const std::vector<std::string>& more) {
  const std::string text = R"(system: resolved
name: plan
domain: {size: [0.03, 0.015, 0.03], spacing: 1.0e-3, boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}}
fluid: {density: 1000, kinematic_viscosity: 1.0e-4}
gravity: {magnitude: 9.81, slope: 0.02}
grains:
  - {count: 54, diameter: 5.0e-3, density: 2650, placement: {pattern: dense, region: {lower: [0, 0, 0], upper: [0.03, 0.015, 0.020]}}}
contact: {restitution: 0.9, friction: 0.5}
run: {until: 5}
)";
  return testing::read_text(text, more);
}

// What the advice makes of the case, until there is no more.
Case followed(Case c) {
  for (int n = 0; n < 5; ++n) {
    const Remedy remedy = first_remedy(c);
    if (remedy.empty()) break;
    c = changed(c, remedy);
  }
  return c;
}

// Gravity rises for 1 s, and only then is the flow on its way.
TEST(PlanWarnings, CountTheRampAsTimeToDevelop) {
  const double alone = flow_estimate(viscous({})).spin_up;
  const auto until = [](double time) { return fmt::format("run.until={}", time); };
  EXPECT_FALSE(any_contains(warnings(viscous({until(1.01 * alone)})), "too short for the flow"));
  const std::string ramp = "run.ramp=1";
  EXPECT_TRUE(any_contains(warnings(viscous({ramp, until(1.01 * alone)})), "from rest after a ramp of 1 s"));
  EXPECT_FALSE(any_contains(warnings(viscous({ramp, until(1.01 * (1.0 + alone))})), "too short for the flow"));
}

// Averages that begin when the flow has developed need a run that goes on for longer.
TEST(PlanWarnings, LeaveTimeForAverages) {
  const Case c = viscous({"run.until=1", "analysis.transport_rate={}"});
  const double developed = flow_estimate(c).spin_up;
  const Case mended = followed(c);
  EXPECT_TRUE(first_remedy(mended).empty());
  EXPECT_GE(mended.run.until, 1.9 * developed);
  EXPECT_LE(mended.run.until, 2.2 * developed);
  EXPECT_GE(mended.analysis.observers.of<analysis::TransportRateKeys>()->from, developed);
}

// What the program fills in is not advised against; twice as much is.
TEST(PlanWarnings, AcceptTheLogProfileThatTheyFillIn) {
  const Case filled = viscous({"initial.fluid.log_profile={}"});
  EXPECT_FALSE(any_contains(warnings(filled), "starts with a shear velocity"));
  const double shear = *filled.initial.fluid.log_profile->shear_velocity;
  const auto given = [](double velocity) {
    return viscous({fmt::format("initial.fluid.log_profile={{shear_velocity: {}}}", velocity)});
  };
  EXPECT_FALSE(any_contains(warnings(given(shear)), "starts with a shear velocity"));
  EXPECT_TRUE(any_contains(warnings(given(2.0 * shear)),
                           fmt::format("consider initial.fluid.log_profile.shear_velocity: {:.3g}", shear)));
}

// Richardson and Zaki: a solid fraction of 0.26 at a Reynolds number of about 10 slows grains to (1 - 0.26)^3.5.
TEST(PlanWarnings, KnowThatGrainsHinderEachOther) {
  const auto until = [](double time) {
    return viscous({"grains.0={count: 54, diameter: 5.0e-3, density: 2650, placement: {pattern: random}}",
                    fmt::format("run.until={}", time)});
  };
  const Case c = until(0.1);
  const double speed = settling_velocity(c), reynolds = speed * 5e-3 / 1e-4;
  const double fraction = 54.0 * std::numbers::pi / 6.0 * 125e-9 / c.domain.size.prod();
  const double fall = 0.03 - 54.0 * std::numbers::pi / 6.0 * 125e-9 / (0.55 * 0.03 * 0.015);  // to a loose bed
  ASSERT_GT(reynolds, 1.0);
  const double time = fall / (speed * std::pow(1.0 - fraction, 4.45 * std::pow(reynolds, -0.1)));
  EXPECT_GT(time, 2.0 * fall / speed);
  EXPECT_TRUE(any_contains(warnings(until(0.95 * time)), "The highest grains fall for about"));
  EXPECT_FALSE(any_contains(warnings(until(1.05 * time)), "The highest grains fall for about"));
}

}  // namespace
}  // namespace thalweg::driver::plan_warnings_test
