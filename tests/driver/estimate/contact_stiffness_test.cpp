#include "driver/estimate/contact_stiffness.hpp"

#include "beds/population_seeds.hpp"
#include "dem/laws/material.hpp"
#include "driver/estimate/contact_estimate.hpp"
#include "driver/warnings/case_warnings.hpp"
#include "driver/warnings/remedy.hpp"
#include "tests/driver/case_texts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace thalweg::driver::contact_stiffness_test {
namespace {

using testing::flume;
using testing::read_text;

constexpr double pi = std::numbers::pi;
constexpr double glass_diameter = 4.95e-3, cells = 9.9, step = 2e-5;  // m, of the flume's free grains; s

double glass_mass() { return 2550.0 * pi / 6.0 * std::pow(glass_diameter, 3); }

// N/m, of two free grains with a restitution: m* (pi/t)^2/(1 - zeta^2), zeta = ln(1/e)/sqrt(pi^2 + ln^2 e).
double stiffness_for(double duration, double restitution) {
  const double loss = -std::log(restitution), undamped = 1.0 - loss * loss / (pi * pi + loss * loss);
  return 0.5 * glass_mass() * std::pow(pi / duration, 2) / undamped;
}

bool rebounds_too_weakly(const Case& c) {
  const std::vector<std::string> found = warnings(c);
  return std::any_of(found.begin(), found.end(), [](const std::string& warning) {
    return warning.find("rebound too weakly") != std::string::npos;
  });
}

// The smaller of the flume's two populations is fixed and does not count.
TEST(ContactStiffness, LastsFourStepsForEachCellOfADiameterInWater) {
  const Case c = read_text(flume);
  const double stiffness = stiffness_for(4.0 * cells * step, 0.93);
  EXPECT_NEAR(c.contact.normal_stiffness, stiffness, 1e-9 * stiffness);
  EXPECT_NEAR(c.contact.tangential_stiffness, 2.0 / 7.0 * stiffness, 1e-9 * stiffness);
  EXPECT_TRUE(has_default_duration(c));
  EXPECT_NEAR(default_contact_steps(c), 4.0 * cells, 1e-9);
  EXPECT_NEAR(contact_duration(c), 4.0 * cells * step, 1e-15);
  EXPECT_EQ(c.coupling.grain_steps_per_fluid_step, 1);  // of 39.6 in a contact
  EXPECT_FALSE(rebounds_too_weakly(c));
}

// A heavier or larger grain touches for longer: of two the one whose contacts need the softer spring decides.
TEST(ContactStiffness, SuitsTheGrainsThatTouchTheShortest) {
  const Case both = read_text(flume, {"grains.1.fixed=false"});
  EXPECT_NEAR(default_contact_steps(both), 32.0, 1e-9);  // 4 mm
  EXPECT_NEAR(contact_duration(both), 32.0 * step, 1e-15);
  const Case own = read_text(flume, {"grains.1.fixed=false", "grains.1.contact={normal_stiffness: 5000}"});
  EXPECT_NEAR(contact_duration(own), 4.0 * cells * step, 1e-15);
  EXPECT_EQ(shortest_contact(own), pi * std::sqrt(0.5 * own.grains[1].lightest_mass() / 5000.0));
}

// Sound goes around the whole clump, so that a small member within a ball changes nothing.
TEST(ContactStiffness, GoesByTheShortestAxisOfAClump) {
  const std::string ball = "grains.0.shape={clump: [{position: [0, 0, 0], diameter: 1}";
  const Case one = read_text(flume, {ball + "]}"}),
             two = read_text(flume, {ball + ", {position: [0.2, 0, 0], diameter: 0.4}]}"});
  EXPECT_LT(two.grains[0].smallest_diameter(), 0.41 * glass_diameter);
  EXPECT_NEAR(default_contact_steps(two), 4.0 * cells, 0.01 * 4.0 * cells);  // axes by sums over points
  EXPECT_NEAR(default_contact_steps(two), default_contact_steps(one), 1e-9);
  EXPECT_FALSE(rebounds_too_weakly(two));
}

TEST(ContactStiffness, FollowsFromADurationInSecondsOrFluidSteps) {
  for (const std::string duration : {"3.0e-4", "{seconds: 3.0e-4}", "{fluid_steps: 15}"}) {
    const Case c = read_text(flume, {"contact.duration=" + duration});
    const double stiffness = stiffness_for(3e-4, 0.93);
    EXPECT_NEAR(c.contact.normal_stiffness, stiffness, 1e-9 * stiffness) << duration;
    EXPECT_NEAR(contact_duration(c), 3e-4, 1e-15) << duration;
    EXPECT_EQ(c.coupling.grain_steps_per_fluid_step, 2) << duration;
    EXPECT_TRUE(rebounds_too_weakly(c)) << duration;  // sound takes 27 steps around
  }
  // With a dashpot: m* ((pi/t)^2 + (gamma/(2 m*))^2); a tangential stiffness is kept.
  const Case damped = read_text(flume, {"contact={damping: 0.09, duration: 3.0e-4, tangential_stiffness: 700}"});
  const double mass = 0.5 * glass_mass(), beta = 0.09 / (2.0 * mass);
  EXPECT_NEAR(damped.contact.normal_stiffness, mass * (std::pow(pi / 3e-4, 2) + beta * beta), 1e-6);
  EXPECT_EQ(damped.contact.tangential_stiffness, 700.0);
  EXPECT_NEAR(dem::contact_time(damped.contact.normal_stiffness, mass, 0.09), 3e-4, 1e-15);
}

TEST(ContactStiffness, IsThatOfDryGrainsWithoutAFluid) {
  const Case c = read_text(defaults_yaml("grains"));
  EXPECT_EQ(c.contact.normal_stiffness, 20000.0);
  EXPECT_EQ(c.contact.tangential_stiffness, 5714.0);
  EXPECT_FALSE(has_default_duration(c));
  const Case soft = read_text(defaults_yaml("grains"), {"contact.duration=1.0e-3"});
  EXPECT_NEAR(contact_duration(soft), 1e-3, 1e-15);
  EXPECT_EQ(*soft.run.time_step, shortest_contact(soft) / 50.0);
  const Case given = read_text(defaults_yaml("grains"), {"contact.normal_stiffness=700"});
  EXPECT_NEAR(given.contact.tangential_stiffness, 200.0, 1e-12);
}

// Materials of another normal stiffness have the share of it, 2/7 or as given, that the section contact has.
TEST(ContactStiffness, TangentialKeepsItsShareInOtherMaterials) {
  const std::vector<std::string> others = {"contact.normal_stiffness=700", "grains.1.fixed=false",
                                           "grains.1.contact={normal_stiffness: 350}",
                                           "contact.walls={normal_stiffness: 1400}"};
  const auto tangential = [](const Case& c) {
    return std::array{beds::materials_of(c.contact, c.grains).back().tangential_stiffness,
                      beds::wall_material_of(c.contact)->tangential_stiffness};
  };
  EXPECT_NEAR(tangential(read_text(flume, others))[0], 100.0, 1e-12);
  EXPECT_NEAR(tangential(read_text(flume, others))[1], 400.0, 1e-12);
  std::vector<std::string> given = others;
  given.emplace_back("contact.tangential_stiffness=70");
  EXPECT_NEAR(tangential(read_text(flume, given))[0], 35.0, 1e-12);
  const Case as_run = testing::read_text(resolved_yaml(read_text(flume, others)));
  EXPECT_NEAR(tangential(as_run)[1], 400.0, 1e-12);
  given.emplace_back("grains.1.contact.tangential_stiffness=10");
  EXPECT_NEAR(tangential(read_text(flume, given))[0], 10.0, 1e-12);
}

// 20 diameters of bed weigh 0.6 1550 9.8 0.1 = 911 Pa: with an overlap of 1 % k is that times 100 d.
TEST(ContactStiffness, IsHigherWhereGrainsWouldOverlapTooFar) {
  const std::vector<std::string> deep = {"domain.boundaries.y=periodic", "domain.size=[0.06, 0.0105, 0.15]",
                                         "grains=[{fill: {depth: 0.1}, diameter: 4.95e-3, density: 2550, placement: "
                                         "{pattern: random, seed: 1, region: {lower: [0, 0, 0], upper: [0.06, 0.0105, "
                                         "0.15]}}}]",
                                         "fluid.time_step=8e-5"};
  const Case c = read_text(flume, deep);
  const double weight = 0.6 * 1550.0 * -gravity_vector(c.gravity).z() * 0.1;
  EXPECT_NEAR(c.contact.normal_stiffness, stiffness_margin * weight * glass_diameter / 0.01, 0.01 * 455.0);
  EXPECT_LT(contact_duration(c), 4.0 * cells * 8e-5);
  EXPECT_NEAR(expected_overlaps(c).under_weight, 0.01 / stiffness_margin, 1e-9);
  for (const std::string& warning : warnings(c)) EXPECT_EQ(warning.find("overlap"), std::string::npos) << warning;
}

TEST(ContactStiffness, FollowsTheStepUnlessItIsGiven) {
  const auto doubled = [](const Case& c) { return changed(c, {fluid_step_change(2.0 * step, 3, Rounding::down)}); };
  const Case open = read_text(flume);
  EXPECT_NEAR(contact_duration(doubled(open)), 2.0 * contact_duration(open), 1e-15);
  const Case seconds = read_text(flume, {"contact.duration=3.0e-4"});
  EXPECT_NEAR(contact_duration(doubled(seconds)), 3e-4, 1e-15);
  EXPECT_EQ(doubled(seconds).coupling.grain_steps_per_fluid_step, 3);
  const Case number = read_text(flume, {"contact.normal_stiffness=20000", "coupling.grain_steps_per_fluid_step=50"});
  EXPECT_EQ(doubled(number).contact.normal_stiffness, 20000.0);
  EXPECT_EQ(doubled(number).coupling.grain_steps_per_fluid_step, 50);
}

// A run keeps the stiffnesses as numbers.
TEST(ContactStiffness, IsKeptAsANumber) {
  for (const std::vector<std::string>& settings :
       {std::vector<std::string>{}, {"contact.duration=3.0e-4"}, {"contact.normal_stiffness=700"}}) {
    const Case c = read_text(flume, settings), kept = read_text(resolved_yaml(c));
    EXPECT_EQ(kept, c) << resolved_yaml(c);
    EXPECT_EQ(kept.contact.given.normal, c.contact.normal_stiffness);
    EXPECT_EQ(resolved_yaml(c).find("duration"), std::string::npos);
    EXPECT_EQ(read_text(resolved_yaml(c), {"fluid.time_step=1e-5"}).contact.normal_stiffness,
              c.contact.normal_stiffness);
  }
}

}  // namespace
}  // namespace thalweg::driver::contact_stiffness_test
