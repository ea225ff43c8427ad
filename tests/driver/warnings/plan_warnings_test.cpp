#include "driver/warnings/plan_warnings.hpp"

#include "driver/estimate/filled_in.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "driver/estimate/settling.hpp"
#include "driver/warnings/case_warnings.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/driver/text_search.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::driver::plan_warnings_test {
namespace {

constexpr double d = 5e-3, depth = 0.0412;

Case bed(double slope = 0.016) { return water_over_glass(d, slope, depth, 0.040, lbm::FaceType::periodic); }

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

TEST(Warnings, OfLaminarFlowWithSmagorinskysModel) {
  Case c = film(1e-3);
  c.fluid.smagorinsky_constant = 0.27;
  EXPECT_TRUE(any_contains(warnings(c), "consider fluid.subgrid_model: qr and fluid.smagorinsky_constant: null"));
  c.fluid.smagorinsky_constant.reset();  // the default vanishes in shear
  EXPECT_FALSE(any_contains(warnings(c), "The flow is laminar"));
  c.fluid.subgrid_model = lbm::SubgridModel::smagorinsky;
  EXPECT_TRUE(any_contains(warnings(c), "consider fluid.subgrid_model: qr."));
  c.fluid.subgrid_model = lbm::SubgridModel::none;
  EXPECT_FALSE(any_contains(warnings(c), "The flow is laminar"));
  c = bed();
  c.fluid.smagorinsky_constant = 0.27;
  EXPECT_FALSE(any_contains(warnings(c), "The flow is laminar"));
}

TEST(Warnings, OfRelaxationTimesBelowTheMap) {
  Case c = bed();
  EXPECT_FALSE(any_contains(warnings(c), "has not been tested below"));  // 2.4e-4
  c.fluid.time_step = 0.9 * 1e-4 * 2.5e-7 / 3e-6;                        // 0.9e-4
  EXPECT_TRUE(any_contains(warnings(c), "has not been tested below"));
}

// Water in Couette flow: of the 21.4/s in the flow, trt measures 47 to 659/s at tau - 1/2 = 6e-4.
TEST(Warnings, OfTrtInWater) {
  Case c = bed();
  EXPECT_FALSE(any_contains(warnings(c), "odd modes"));
  c.fluid.collision = lbm::CollisionModel::trt;
  EXPECT_TRUE(any_contains(warnings(c), "the odd modes hardly relax"));
  c.fluid.kinematic_viscosity = 1e-6 / 2.4e-4 * 0.01;
  EXPECT_FALSE(any_contains(warnings(c), "odd modes"));
}

TEST(Warnings, OfThePlan) {
  Case c = bed();
  c.domain.size.z() = 0.064;            // a whole number of cells
  c.contact.normal_stiffness = 2700.0;  // as long as sound takes around a grain
  c.run.until = 30.0;
  EXPECT_TRUE(warnings(c).empty());
  c.run.until = 1.0;  // of 9 s
  EXPECT_TRUE(any_contains(warnings(c), "from rest"));
  EXPECT_TRUE(any_contains(warnings(c), "initial.fluid.log_profile: {}"));
  c.initial.fluid.log_profile = coupling::LogProfileKeys{0.06, 0.080, 2e-4, std::nullopt};
  EXPECT_TRUE(warnings(c).empty());
  c.initial.fluid.log_profile->shear_velocity = 0.040;
  c.run.until = 30.0;
  EXPECT_TRUE(any_contains(warnings(c), "shear_velocity: 0.08"));
  c.run.until = 0.4;  // H/u_tau = 0.51 s
  EXPECT_TRUE(any_contains(warnings(c), "one turnover"));
  EXPECT_FALSE(any_contains(warnings(c), "developed"));  // it is
}

// The finest grains of a population, not those of its median, are the last that come down.
TEST(Warnings, OfGrainsThatStillFall) {
  Case c = bed(0.0);
  c.run.until = 0.2;  // 0.04 m at 0.48 m/s take 0.09 s
  EXPECT_FALSE(any_contains(warnings(c), "The highest grains fall"));
  beds::Population& grains = c.grains.front();
  grains.diameters.assign(static_cast<std::size_t>(grains.count), d);
  std::fill_n(grains.diameters.begin(), grains.count / 2, 0.05 * d);  // 0.035 m/s
  EXPECT_TRUE(any_contains(warnings(c), "The highest grains fall"));
}

// Frames are written at the start and after each interval.
TEST(Warnings, OfOutputThatARunDoesNotReach) {
  Case c = bed();
  c.output.series.every = c.output.fluid.every = c.output.grains.every = c.run.until;
  EXPECT_FALSE(any_contains(warnings(c), "is longer than the run"));
  c.output.grains.every = 1.01 * c.run.until;
  EXPECT_TRUE(any_contains(warnings(c), "so there is no frame after that of the start"));
  EXPECT_FALSE(any_contains(warnings(c), "output.fluid.every"));
  EXPECT_FALSE(any_contains(warnings(c), "output.series.every"));
}

// Of a drag coefficient of 0.4, sqrt(4/(3 0.4) (s - 1) g d); the default is 1 % of sqrt((s - 1) g d).
TEST(Warnings, OfASpeedThatHardlyAnyGrainHas) {
  Case c = bed();
  analysis::TransportRateKeys& keys = c.analysis.observers.of<analysis::TransportRateKeys>().emplace();
  const double scale =
      std::sqrt((c.grains.front().density / c.fluid.density - 1.0) * gravity_vector(c.gravity).norm() * d);
  const double fall = std::sqrt(4.0 / 1.2) * scale;
  keys.moving_speed = 0.999 * fall;
  EXPECT_FALSE(any_contains(warnings(c), "moving_speed"));
  keys.moving_speed = 1.001 * fall;
  EXPECT_TRUE(
      any_contains(warnings(c), fmt::format("consider analysis.transport_rate.moving_speed: {:.2g}", 0.01 * scale)));
  c.grains.front().density = 1.01 * c.fluid.density;  // slow water moves them
  EXPECT_FALSE(any_contains(warnings(c), "moving_speed"));
}

// Beside grains that make a bed, those that float have no Shields number; alone they leave none to the case.
TEST(Warnings, OfGrainsThatFloat) {
  Case c = bed();
  beds::Population light = c.grains.front();
  light.density = 900.0;
  c.grains.push_back(light);
  EXPECT_TRUE(any_contains(warnings(c), "(grains.1) are no heavier than the fluid of 1000 kg/m^3: they are no part"));
  EXPECT_FALSE(any_contains(warnings(c), "there is no Shields number"));
  c.grains.erase(c.grains.begin());
  EXPECT_TRUE(any_contains(warnings(c), "there is no Shields number"));
}

TEST(Warnings, OfSuppliesThatBeginTooLate) {
  Case c = bed();
  beds::SupplyKeys& supply = c.supplies.emplace_back();
  supply.rate = 10.0;
  supply.from = 0.5 * c.run.until;
  EXPECT_FALSE(any_contains(warnings(c), "supplies.0"));
  supply.from = c.run.until;
  EXPECT_TRUE(any_contains(warnings(c), "give an earlier supplies.0.from"));
}

TEST(Warnings, OfWaterAtRestThatAnInletSetsGoing) {
  Case c = bed(0.0);
  c.domain.faces[x_low] = {.type = lbm::FaceType::velocity_inlet, .velocity = Vec3(0.2, 0.0, 0.0)};
  c.domain.faces[x_high].type = lbm::FaceType::pressure_outlet;
  EXPECT_TRUE(any_contains(warnings(c), "starts at rest and the inlet accelerates it to 0.2 m/s"));
  c.initial.fluid.uniform = Vec3(0.2, 0.0, 0.0);
  EXPECT_FALSE(any_contains(warnings(c), "starts at rest"));
  c.initial.fluid.uniform.reset();
  hold_bed(c, depth);  // nothing to throw about, and a pressure of rho c_s u: 1.4 %, and at 0.8 m/s 5.5 %
  EXPECT_FALSE(any_contains(warnings(c), "starts at rest"));
  c.domain.faces[x_low].velocity.x() = 0.8;
  EXPECT_TRUE(any_contains(warnings(c), "compresses it by 5.5 %"));
}

}  // namespace
}  // namespace thalweg::driver::plan_warnings_test
