#include "loop/watchdog.hpp"

#include "loop/location_text.hpp"
#include "tests/loop/made_up_system.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace thalweg::loop::watchdog_test {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

WatchRule rule(const std::string& diagnostic, WatchRule::Side side, double warn, double stop) {
  return {diagnostic, side,
          [=](const std::vector<Diagnostic>&) {
            return WatchLimits{warn, stop};
          },
          "the " + diagnostic, "Because of this. Do that."};
}

TEST(Watchdog, WarnsOnceAndAgainWhenItHasGrownByHalf) {
  const MadeUp system;
  Watchdog dog(world, system, {rule("heat", WatchRule::Side::either, 0.1, 1.0)}, OutOfBounds::stop);
  const auto look = [&](double heat) { return dog.judge({{"heat", "K", heat}}); };
  EXPECT_TRUE(look(0.1).empty());
  EXPECT_EQ(dog.notice(), "");
  const std::vector<std::string> first = look(-0.2);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(
      first[0],
      "At 2.5 s (step 250) the heat is -0.2 K, beyond 0.1 K (the run stops at 1 K), in the cell at (0.95, 0.5, 0.5) "
      "m, in the pore between grains 10 and 11. Because of this. Do that.");
  EXPECT_EQ(dog.notice(), "heat -0.2");
  EXPECT_TRUE(look(0.29).empty());
  EXPECT_EQ(dog.notice(), "heat 0.29");
  EXPECT_TRUE(look(0.05).empty());
  EXPECT_EQ(dog.notice(), "");
  EXPECT_TRUE(look(0.25).empty());
  EXPECT_EQ(look(0.31).size(), 1u);
  EXPECT_TRUE(look(0.46).empty());
  EXPECT_EQ(look(0.47).size(), 1u);
}

TEST(Watchdog, StopsWithValueLimitPlaceCauseAndRemedy) {
  const MadeUp system;
  Watchdog dog(world, system, {rule("depth", WatchRule::Side::below, 0.1, 1.0)}, OutOfBounds::stop);
  EXPECT_TRUE(dog.judge({{"depth", "m", 7.0}, {"other", "1", 1e9}}).empty());
  EXPECT_EQ(
      message_of(dog, {{"depth", "m", -1.5}}),
      "The run has gone wrong at 2.5 s (step 250): the depth is -1.5 m, beyond the limit of 1 m, in the cell at (0.95, "
      "0.5, 0.5) m, in the pore between grains 10 and 11. Because of this. Do that.");
}

TEST(Watchdog, OnlyWarnsWhereAskedToButNeverGoesOnWithoutNumbers) {
  const MadeUp system;
  for (const OutOfBounds action : {OutOfBounds::warn, OutOfBounds::stop}) {
    Watchdog dog(world, system, {rule("heat", WatchRule::Side::above, 0.1, 1.0)}, action);
    if (action == OutOfBounds::warn) {
      EXPECT_EQ(dog.judge({{"heat", "1", 2.0}}).size(), 1u);
    }
    expect_words(message_of(dog, {{"heat", "1", 0.0}, {"nowhere", "1", no_number}}),
                 {"nowhere is not a finite number."});
    expect_words(message_of(dog, {{"speed", "1", HUGE_VAL}}), {"speed", "not a finite number, in the cell at (0.95"});
  }
}

TEST(Whereabouts, SaysWhatIsAround) {
  const MadeUp system;
  const Snapshot s = system.snapshot();
  EXPECT_EQ(location_text(world, {Vec3(0.05, 0.95, 0.5), {}}, s), "in the cell at (0.05, 0.95, 0.5) m, in open water");
  EXPECT_EQ(location_text(world, {Vec3(0.4, 0.65, 0.55), {}}, s),
            "in the cell at (0.4, 0.65, 0.55) m, beside grain 12");
  EXPECT_EQ(location_text(world, {Vec3(0.1, 0.2, 0.3), {12}}, s), "grain 12 at (0.1, 0.2, 0.3) m");
  EXPECT_EQ(location_text(world, {Vec3(0.1, 0.2, 0.3), {10, 12}}, s), "grains 10 and 12 at (0.1, 0.2, 0.3) m");
  EXPECT_EQ(location_text(world, {Vec3(0.1, 0.2, 0.3), {}}, Snapshot{}), "in the cell at (0.1, 0.2, 0.3) m");
}

}  // namespace
}  // namespace thalweg::loop::watchdog_test
