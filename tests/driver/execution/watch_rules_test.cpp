#include "driver/execution/watch_rules.hpp"

#include "driver/estimate/flow_estimate.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/loop/made_up_system.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::driver::watch_rules_test {
namespace {

using namespace loop;

using testing::flume;
using testing::read_text;

const MPI_Comm world = MPI_COMM_WORLD;

TEST(WatchRules, EveryRuleOfACaseWarnsAndStops) {
  const MadeUp system;
  const Case c = read_text(flume);
  struct Trouble {
    const char* diagnostic;
    double suspicious, impossible;
    std::vector<std::string> words;
  };
  // A lattice velocity of 1 is 25 m/s here: the grains are limited by 0.2 and 0.3 of it, or by what they can reach.
  const double reach = expected_grain_speed(c);
  const std::vector<Trouble> troubles{
      {"largest_lattice_velocity", 0.21, 0.31, {"velocity of the fluid", "fluid.time_step", "docs/stability.md"}},
      {"mean_density_deviation", -0.0011, -0.011, {"mean density", "mass_by_links"}},
      {"mean_density_deviation", 0.0011, 0.011, {"mean density", "mass_by_links"}},
      {"smallest_density_deviation", -0.31, -0.51, {"smallest density", "fluid.time_step"}},
      {"largest_density_deviation", 0.31, 1.01, {"largest density", "fluid.time_step"}},
      {"largest_grain_speed", 2.01 * reach, 5.01 * reach, {"speed of a grain", "a longer contact.duration"}},
      {"largest_overlap", 0.11, 0.51, {"overlap", "a shorter contact.duration than 0.000792 s"}}};
  for (const Trouble& trouble : troubles) {
    Watchdog dog(world, system, watch_rules(c), OutOfBounds::stop);
    const std::vector<std::string> warnings = dog.judge({{trouble.diagnostic, "1", trouble.suspicious}});
    ASSERT_EQ(warnings.size(), 1u) << trouble.diagnostic;
    expect_words(warnings[0], trouble.words);
    const std::string message = message_of(dog, {{trouble.diagnostic, "1", trouble.impossible}});
    expect_words(message, trouble.words);
    expect_words(message, {"2.5 s (step 250)", "beyond the limit", "in the pore between grains 10 and 11"});
  }
  Watchdog dog(world, system, watch_rules(c), OutOfBounds::stop);
  EXPECT_EQ(dog.judge({{"fast_cell_fraction", "1", 1.1e-3}}).size(), 1u);
  EXPECT_EQ(message_of(dog, {{"fast_cell_fraction", "1", 1.0}}), "");  // never stops a run
}

// 2/3 (rho_s - rho) g d = 2/3 1550 9.8 4.95e-3 = 50.13 Pa and 2/3 1550 9.8 4e-3 of grains that are fixed;
// rho c_s^2 = 1000 (dx/dt)^2/3.
TEST(WatchRules, MeanDensityIsLimitedByTheWeightOfAGrain) {
  const Case coarse = read_text(flume, {"fluid.time_step=1e-4"});  // 5 m/s: 8333 Pa
  EXPECT_NEAR(mean_density_limits(coarse).warn, 50.127 / 8333.33, 1e-6);
  EXPECT_NEAR(mean_density_limits(coarse).stop, 501.27 / 8333.33, 1e-5);
  EXPECT_NEAR(mean_density_limits(read_text(flume)).warn, 1e-3, 1e-15);  // 25 m/s: 2.4e-4, below the least
  Case empty = coarse;
  empty.grains.clear();
  EXPECT_NEAR(mean_density_limits(empty).warn, 0.01, 1e-15);
  empty.domain.faces[x_low].type = lbm::FaceType::velocity_inlet;
  empty.domain.faces[x_high].type = lbm::FaceType::pressure_outlet;
  empty.domain.faces[x_high].pressure = -83.3333;
  EXPECT_NEAR(mean_density_limits(empty).warn, 0.06, 1e-6);
  EXPECT_NEAR(mean_density_limits(empty).stop, 0.21, 1e-6);
}

// Terminal speed sqrt(4/3 1.55 g 4.95e-3/0.4) with g = 9.8 m/s^2, and the flow of estimated_velocity().
TEST(WatchRules, GrainsMayFallAndBeCarried) {
  const Case wet = read_text(flume);
  EXPECT_NEAR(expected_grain_speed(wet), std::sqrt(4.0 / 3.0 * 1.55 * 9.8 * 4.95e-3 / 0.4) + estimated_velocity(wet),
              1e-9);
  Case dry = wet;
  dry.system = SystemKind::grains;
  dry.grains[0].velocity = Vec3(0.0, 0.0, -3.0);
  // Down the periodic slope as long as the run lasts, and a fall through the height of the box.
  const double angle = std::atan(0.07);
  EXPECT_NEAR(expected_grain_speed(dry),
              3.0 + 3.0 * 9.8 * std::sin(angle) + std::sqrt(2.0 * 9.8 * std::cos(angle) * 0.075), 1e-9);
}

// Down a walled slope, from a sink back to its upper end, with or without the motion that they had.
TEST(WatchRules, GrainsThatComeBackMayFallOn) {
  Case c = read_text(flume);
  c.system = SystemKind::grains;
  c.domain.faces[x_low].type = c.domain.faces[x_high].type = lbm::FaceType::no_slip;
  const double g = 9.8, angle = std::atan(0.07), length = c.domain.size.x(), until = c.run.until;
  const double down = g * std::cos(angle) * 0.075, along = g * std::sin(angle);
  const double once = std::sqrt(2.0 * (down + along * length)), again = std::sqrt(2.0 * down) + along * until;
  EXPECT_NEAR(expected_grain_speed(c), once, 1e-9);
  beds::SinkKeys& sink = c.sinks.emplace_back();
  sink.region = {Vec3(0.9 * length, 0.0, 0.0), c.domain.size};
  EXPECT_NEAR(expected_grain_speed(c), once, 1e-9);
  sink.recirculation.emplace().region = {Vec3::Zero(), Vec3(0.1 * length, c.domain.size.y(), 0.075)};
  EXPECT_NEAR(expected_grain_speed(c), again, 1e-9);
  sink.recirculation->velocity = Vec3::Zero();
  EXPECT_NEAR(expected_grain_speed(c), once, 1e-9);
  sink.recirculation->velocity.reset();
  std::swap(sink.region, sink.recirculation->region);  // it leads down the slope
  EXPECT_NEAR(expected_grain_speed(c), once, 1e-9);
}

// What the case itself moves: a solid, grains that come in, moist grains that a bridge pulls together, those of another
// run.
TEST(WatchRules, GrainsMayBeAsFastAsTheCaseMovesThem) {
  Case still = read_text(flume);
  still.system = SystemKind::grains;
  still.gravity.magnitude = 0.0;
  const double rounding = expected_grain_speed(still);
  Case solid = still, supply = still, back = still, moist = still;
  solid.solids.emplace_back().sphere = SphereCase{Vec3(0.02, 0.005, 0.05), 0.004};
  solid.solids[0].motion.emplace().velocity = Vec3(0.2, 0.0, 0.0);
  EXPECT_NEAR(expected_grain_speed(solid), 0.2, 2.0 * rounding);
  supply.supplies.emplace_back().velocity = Vec3(0.0, 0.3, -0.4);
  EXPECT_NEAR(expected_grain_speed(supply), 0.5, 2.0 * rounding);
  back.sinks.emplace_back().recirculation.emplace().velocity = Vec3(0.1, 0.0, 0.0);
  EXPECT_NEAR(expected_grain_speed(back), 0.1, 2.0 * rounding);
  // At least the speed to which the work of the bridge as it closes brings two spheres, each with half of it. Its force
  // falls from 2 pi R gamma at contact to a tenth or less at V^(1/3).
  moist.contact.liquid_bridge = {0.073, 0.0, 1e-11};
  const double d = 4.95e-3, work = 0.3 * M_PI * d * 0.073 * std::cbrt(1e-11), mass = 2550.0 * M_PI / 6.0 * d * d * d;
  EXPECT_GT(expected_grain_speed(moist), std::sqrt(work / mass));
  EXPECT_LT(expected_grain_speed(moist), 10.0 * std::sqrt(work / mass));

  still.initial.from.grains = "elsewhere";
  int watched = 0;
  for (const WatchRule& rule : watch_rules(still))
    if (rule.diagnostic == "largest_grain_speed") {
      EXPECT_GT(rule.limits({{"largest_grain_speed", "m/s", 0.1}}).warn, 0.1);
      EXPECT_LT(rule.limits({{"largest_grain_speed", "m/s", 0.8}}).stop, 0.8);
      ++watched;
    }
  EXPECT_EQ(watched, 1);
}

// Grains that a dense placement leaves in touch part by rounding, and such a run goes on.
TEST(WatchRules, GrainsWithoutWeightMayMoveByRounding) {
  Case still = read_text(flume);
  still.system = SystemKind::grains;
  still.gravity.magnitude = 0.0;
  EXPECT_GT(expected_grain_speed(still), 1e-10);
  EXPECT_LT(expected_grain_speed(still), 1e-6);
}

}  // namespace
}  // namespace thalweg::driver::watch_rules_test
