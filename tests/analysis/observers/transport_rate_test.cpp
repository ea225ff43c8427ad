#include "analysis/observers/transport_rate.hpp"

#include "tests/analysis/made_up_grains.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace thalweg::analysis::transport_rate_test {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;
// s - 1 = 3, g = 12, d = 1/4: sqrt(3 * 12 / 64) = 3/4 m^2/s; sqrt((s - 1) g d) = 3 m/s, so moving is above 0.03 m/s.
constexpr TransportScales scales{0.25, 4000.0, 1000.0, 12.0};

MadeUpGrain runner(GlobalId id, double factor) {
  // Two kinds of grains: every third is twice as large and rests; v_x = id/100 of the others.
  if (id % 3 == 0) return {0.25, 1.0, Vec3(0.0, 0.0, 0.03), Vec3::Zero()};
  return {0.125, 1.0, Vec3(factor * static_cast<double>(id) / 100.0, 0.0, -1.0), Vec3::Zero()};
}

// Sum over id < 300, id not a multiple of 3, of id/100: (44850 - 14850)/100 = 300 m/s.
constexpr double sum_of_speeds = 300.0;

TEST(TransportRate, IsTheVolumeFluxOfAllGrainsPerWidth) {
  const MadeUpGrains grains(world, 300, [](GlobalId id) { return runner(id, 1.0); });
  TransportRate rate(world, scales, {});
  rate.observe(grains.snapshot(0.0));

  const double volume = std::numbers::pi / 6.0 * 0.25 * 0.25 * 0.25;
  const double q_s = volume * sum_of_speeds / (20.0 * 10.0);
  EXPECT_NEAR(value_of(rate.diagnostics(), "q_s"), q_s, 4e-16 * 1e3 * q_s);  // a few roundings a term
  EXPECT_NEAR(value_of(rate.diagnostics(), "q_star"), q_s / 0.75, 4e-16 * 1e3 * q_s);
  EXPECT_EQ(value_of(rate.diagnostics(), "moving_grains"), 200.0);  // 0.03 m/s itself is not moving
  EXPECT_EQ(value_of(rate.diagnostics(), "moving_share"), 200.0 / 300.0);
  EXPECT_NEAR(value_of(rate.diagnostics(), "activity"), volume * 200.0 / (20.0 * 10.0), 1e-12 * volume);
  EXPECT_NEAR(value_of(rate.results(), "largest_grain_speed"), std::sqrt(2.99 * 2.99 + 1.0), 1e-15 * 4);
}

TEST(TransportRate, TakesAClumpForOneGrainWithItsVolumeAtItsCentre) {
  // The last six of the grains, ids 294 to 299, are one clump of 0.05 m^3 at 0.5 m/s; four of them moved.
  MadeUpGrains grains(world, 300, [](GlobalId id) { return runner(id, 1.0); });
  grains.bind(6, {294, 1.0, 0.05, Vec3::Zero(), Vec3(0.5, 0.0, 0.0), 0.0});
  TransportRate rate(world, scales, {});
  rate.observe(grains.snapshot(0.0));
  const double volume = std::numbers::pi / 6.0 * 0.25 * 0.25 * 0.25;
  const double gone = (295.0 + 296.0 + 298.0 + 299.0) / 100.0;
  const double q_s = (volume * (sum_of_speeds - gone) + 0.05 * 0.5) / (20.0 * 10.0);
  EXPECT_NEAR(value_of(rate.diagnostics(), "q_s"), q_s, 4e-16 * 1e3 * q_s);
  EXPECT_EQ(value_of(rate.diagnostics(), "moving_grains"), 197.0);
  EXPECT_NEAR(value_of(rate.results(), "largest_grain_speed"), std::sqrt(2.93 * 2.93 + 1.0), 1e-15 * 4);
}

// A plate of grains 0 to 99 that is driven along is no sediment, nor is a clump that is.
TEST(TransportRate, LeavesOutGrainsWhoseMotionIsGiven) {
  MadeUpGrains grains(world, 300, [](GlobalId id) { return runner(id, 1.0); });
  grains.hold([](GlobalId id) { return id < 100; });
  ClumpState clump{294, 1.0, 0.05, Vec3::Zero(), Vec3(0.5, 0.0, 0.0), 0.0};
  clump.velocity_is_held = true;
  grains.bind(6, clump);
  TransportRate rate(world, scales, {});
  rate.observe(grains.snapshot(0.0));
  // The ids from 100 to 293 that are no multiple of 3: 130 of 194; their sum is 300 - (4950 - 1683)/100 - 11.88.
  const double volume = std::numbers::pi / 6.0 * 0.25 * 0.25 * 0.25;
  const double q_s = volume * (sum_of_speeds - 32.67 - 11.88) / (20.0 * 10.0);
  EXPECT_NEAR(value_of(rate.diagnostics(), "q_s"), q_s, 4e-16 * 1e3 * q_s);
  EXPECT_EQ(value_of(rate.diagnostics(), "moving_grains"), 130.0);
  EXPECT_EQ(value_of(rate.diagnostics(), "moving_share"), 130.0 / 194.0);
  EXPECT_NEAR(value_of(rate.results(), "largest_grain_speed"), std::sqrt(2.93 * 2.93 + 1.0), 1e-15 * 4);
}

// Grains of 1 mm and 1.15 times the density of an oil of 1e-4 m^2/s fall at 0.8 mm/s, not at the 38 mm/s of inertia; in
// water, as in the paper, inertia is the lower. In a model fluid v_0 counts, whatever gravity.
TEST(TransportScales, KnowAGrainThatMovesInAViscousFluid) {
  TransportScales in{1e-3, 1150.0, 1000.0, 9.8};
  EXPECT_NEAR(in.moving_speed(), 0.01 * std::sqrt(0.15 * 9.8 * 1e-3), 1e-15);
  in.kinematic_viscosity = 1e-4;
  EXPECT_NEAR(in.moving_speed(), 0.01 * 0.15 * 9.8 * 1e-6 / 18e-4, 1e-18);
  in.kinematic_viscosity = 1e-6;
  EXPECT_NEAR(in.moving_speed(), 0.01 * std::sqrt(0.15 * 9.8 * 1e-3), 1e-15);
  in.model_fluid_speed = 0.009;
  EXPECT_DOUBLE_EQ(in.moving_speed(), 9e-5);
  TransportRate chosen(world, scales, {.moving_speed = 2.0});
  chosen.observe(MadeUpGrains(world, 300, [](GlobalId id) { return runner(id, 1.0); }).snapshot(0.0));
  // v_x^2 + 1 > 4 from id 174 on: the 84 of those up to 299 that are no multiple of 3.
  EXPECT_EQ(value_of(chosen.diagnostics(), "moving_grains"), 84.0);
  EXPECT_EQ(value_of(chosen.results(), "moving_speed"), 2.0);
}

TEST(TransportRate, HasTheSameBitsOnAnyNumberOfRanks) {
  const auto made = [](GlobalId id) {
    const double phase = static_cast<double>(id);
    return MadeUpGrain{0.1 + 0.05 * std::cos(phase), 1.0, Vec3(std::sin(3.0 * phase), 0.0, 0.0), Vec3::Zero()};
  };
  TransportRate alone(MPI_COMM_SELF, scales, {}), shared(world, scales, {});
  alone.observe(MadeUpGrains(MPI_COMM_SELF, 1000, made).snapshot(0.0));
  shared.observe(MadeUpGrains(world, 1000, made).snapshot(0.0));
  for (const char* name : {"q_s", "q_star", "moving_grains", "activity", "largest_grain_speed"})
    EXPECT_EQ(value_of(alone.results(), name), value_of(shared.results(), name)) << name;
}

TEST(TransportRate, TakesTheMeanFromAGivenTimeAndCarriesItOverARestart) {
  const auto grains = [](double factor) {
    return MadeUpGrains(world, 300, [factor](GlobalId id) { return runner(id, factor); });
  };
  TransportRate rate(world, scales, {2.0});
  rate.observe(grains(100.0).snapshot(1.9));
  EXPECT_TRUE(std::isnan(value_of(rate.results(), "q_star_mean"))) << "a mean of nothing";
  rate.observe(grains(1.0).snapshot(2.0));
  const test::MemoryArchive checkpoint = test::saved(rate, world);

  TransportRate restarted(world, scales, {2.0}), other_window(world, scales, {2.5});
  for (TransportRate* next : {&restarted, &other_window}) {
    test::load(*next, checkpoint);
    next->observe(grains(1.0).snapshot(2.0));  // what the checkpoint holds, seen again: it counts once
    next->observe(grains(3.0).snapshot(3.0));
  }
  // Measurements 1 and 3 times the same flux: mean 2, standard deviation 1.
  const double one = std::numbers::pi / 6.0 / 64.0 * sum_of_speeds / 200.0 / 0.75;
  EXPECT_NEAR(value_of(restarted.results(), "q_star_mean"), 2.0 * one, 1e-12 * one);
  EXPECT_NEAR(value_of(restarted.results(), "q_star_deviation"), one, 1e-12 * one);
  EXPECT_EQ(value_of(restarted.results(), "measurements"), 2.0);
  EXPECT_NEAR(value_of(other_window.results(), "q_star_mean"), 3.0 * one, 1e-12 * one);

  // Distributions are by the grain's diameter, and the moving grains by its speed of fall.
  TransportScales larger = scales;
  larger.grain_diameter *= 2.0;
  TransportRate of_larger(world, larger, {2.0});
  EXPECT_FALSE(test::load(of_larger, checkpoint));
}

TEST(TransportRate, OfDryGrainsHasNoQStar) {
  TransportRate rate(world, {0.25, 2500.0, 0.0, 9.8}, {});
  rate.observe(MadeUpGrains(world, 10, [](GlobalId id) { return runner(id, 1.0); }).snapshot(0.0));
  EXPECT_THROW(value_of(rate.diagnostics(), "q_star"), std::bad_optional_access);
  // v_x = 0.01, 0.02, 0.04, 0.05, 0.07, 0.08 m/s: sum 0.27 m/s.
  const double q_s = std::numbers::pi / 6.0 / 64.0 * 0.27 / 200.0;
  EXPECT_NEAR(value_of(rate.diagnostics(), "q_s"), q_s, 1e-14 * q_s);
}

// v_x = id/100 of the grains that are no multiple of 3, from 0.01 to 2.99 m/s, v_z = -1 m/s of all of them; the rest,
// at 0.03 m/s, is not moving. With fall speeds of 3 m/s a bin is 0.3 m/s wide, from -45 m/s on.
TEST(TransportRate, CountsTheVelocitiesOfMovingGrains) {
  TransportRate rate(world, scales, {});
  rate.observe(MadeUpGrains(world, 300, [](GlobalId id) { return runner(id, 1.0); }).snapshot(0.0));
  std::map<std::string, std::vector<double>> shown;
  for (const Profile& profile : rate.profiles()) shown[profile.name] = profile.values;
  const std::vector<double>&edges = shown.at("velocity_edges"), &density = shown.at("velocity_density");
  ASSERT_EQ(edges.size(), 301u);
  ASSERT_EQ(density.size(), 900u);
  double whole = 0.0;
  for (std::size_t b = 0; b < 300; ++b) {
    const double width = edges[b + 1] - edges[b];
    EXPECT_NEAR(width, 0.3, 1e-12);
    whole += density[3 * b] * width;
    const bool holds_one = edges[b] <= -1.0 && -1.0 < edges[b + 1];
    EXPECT_NEAR(density[3 * b + 2], holds_one ? 1.0 / 0.3 : 0.0, 1e-11);
    // 30 ids in a width of 0.3 m/s, 20 of them no multiple of 3; one more or less by where an edge lies.
    const bool inside = edges[b] > -0.01 && edges[b + 1] < 3.01;
    EXPECT_NEAR(density[3 * b] * 200.0 * width, inside ? 20.0 : 0.0, 1.0 + 1e-9);
  }
  EXPECT_NEAR(whole, 1.0, 1e-12);
}

TEST(TransportRate, SaysOfASingleMeasurementThatItHasNoError) {
  TransportRate rate(world, scales, {});
  EXPECT_TRUE(rate.remarks().empty());
  rate.observe(MadeUpGrains(world, 300, [](GlobalId id) { return runner(id, 1.0); }).snapshot(0.5));
  ASSERT_EQ(rate.remarks().size(), 1U);
  // q* = pi/6 (1/4)^3 300/200/(3/4)
  EXPECT_EQ(rate.remarks().front(),
            "transport: q* = 0.01636, a single measurement, at 0.5 s: an error needs at least two");
}

// Fluxes that alternate between two values have a known mean and no drift; those that rise have one. The same state
// from a checkpoint in the middle.
TEST(TransportRate, SaysWhetherTheMeanIsSteady) {
  const auto run = [](TransportRate& rate, int from, int to, double rise) {
    for (int n = from; n < to; ++n) {
      const double factor = 1.0 + 0.1 * (n % 2) + rise * n;
      rate.observe(MadeUpGrains(world, 30, [factor](GlobalId id) { return runner(id, factor); }).snapshot(0.1 * n));
    }
  };
  for (const double rise : {0.0, 0.02}) {
    TransportRate whole(world, scales, {}), first_half(world, scales, {}), second_half(world, scales, {});
    run(whole, 0, 101, rise);
    run(first_half, 0, 41, rise);
    test::load(second_half, test::saved(first_half, world));
    run(second_half, 40, 101, rise);  // seen again at 40
    EXPECT_EQ(value_of(whole.results(), "steady"), rise == 0.0 ? 1.0 : 0.0);
    EXPECT_EQ(whole.remarks().size(), 2u);
    EXPECT_NE(whole.remarks().at(1).find(rise == 0.0 ? "transport: steady" : "not steady"), std::string::npos);
    EXPECT_EQ(test::first_difference(test::saved(whole, world), test::saved(second_half, world)), "");
    EXPECT_EQ(whole.remarks(), second_half.remarks());
  }
}

}  // namespace
}  // namespace thalweg::analysis::transport_rate_test
