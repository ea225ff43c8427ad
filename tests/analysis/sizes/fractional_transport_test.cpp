#include "analysis/sizes/fractional_transport.hpp"

#include "analysis/observers/observer_list.hpp"
#include "analysis/observers/transport_rate.hpp"
#include "tests/analysis/made_up_grains.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace thalweg::analysis::fractional_transport_test {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;
const PeriodicBox box{{20.0, 10.0, 5.0}, {true, true, false}};
// s = 3 and g = 10 m/s^2; moving is above 1 % of sqrt((s - 1) g d) = sqrt(20) m/s with d = 1 m.
constexpr TransportScales scales{1.0, 3000.0, 1000.0, 10.0};
constexpr double pi = std::numbers::pi;

double volume(double diameter) { return pi / 6.0 * diameter * diameter * diameter; }

std::map<std::string, std::vector<double>> shown_by(const FractionalTransport& observer) {
  std::map<std::string, std::vector<double>> shown;
  for (const Profile& profile : observer.profiles()) shown[profile.name] = profile.values;
  return shown;
}

// An armoured bed: 80 x 40 small grains of 0.4 m, 0.25 m apart, so that they leave no gap, and on them 20 x 10 large
// ones of 1 m, 1 m apart, which cover pi/4 of the plan. The bed has less of the large grains than of the small.
constexpr GlobalId small_grains = 3200, large_grains = 200;
constexpr double small = 0.4, large = 1.0;
MadeUpGrain armoured(GlobalId id, double small_speed, double large_speed) {
  if (id < small_grains)
    return {0.5 * small, 3000.0 * volume(small), Vec3(small_speed, 0.0, 0.0), Vec3::Zero(),
            Vec3(0.125 + 0.25 * static_cast<double>(id % 80), 0.125 + 0.25 * static_cast<double>(id / 80), 0.2)};
  const GlobalId n = id - small_grains;
  return {0.5 * large, 3000.0 * volume(large), Vec3(large_speed, 0.0, 0.0), Vec3::Zero(),
          Vec3(0.5 + static_cast<double>(n % 20), 0.5 + static_cast<double>(n / 20), 0.9)};
}
MadeUpGrains armoured_bed(MPI_Comm communicator, double small_speed, double large_speed) {
  return {communicator, small_grains + large_grains,
          [=](GlobalId id) { return armoured(id, small_speed, large_speed); }};
}

FractionalTransport of_two_classes(const FractionalTransportKeys& keys = {}) {
  return {world, box, scales, SizeClasses({0.25, 0.63, 1.6}), keys, 0.0173};
}

TEST(FractionalTransport, FindsTheArmourOfABedOfTwoSizes) {
  FractionalTransport observer = of_two_classes();
  observer.observe(armoured_bed(world, 0.02, 0.4).snapshot(0.0));
  const double of_small = small_grains * volume(small), of_large = large_grains * volume(large);
  ASSERT_LT(of_large, of_small);
  const auto shown = shown_by(observer);
  EXPECT_NEAR(shown.at("diameter").at(0), small, 1e-14);
  EXPECT_NEAR(shown.at("diameter").at(1), large, 1e-14);
  EXPECT_NEAR(shown.at("density").at(1), 3000.0, 1e-9);
  EXPECT_NEAR(shown.at("bed_share").at(1), of_large / (of_small + of_large), 1e-14);
  // Of 2600 pixels in the plan of a large grain, those at its edge are right to about ten, each time others.
  EXPECT_NEAR(shown.at("surface_share").at(1), 0.25 * pi, 2e-3);
  EXPECT_NEAR(shown.at("surface_share").at(0), 1.0 - 0.25 * pi, 2e-3);
  const std::vector<Diagnostic> results = observer.results();
  EXPECT_NEAR(value_of(results, "bed_d50"), small, 1e-14);
  EXPECT_NEAR(value_of(results, "surface_d50_mean"), large, 1e-14);
  EXPECT_NEAR(value_of(results, "armouring_ratio_mean"), large / small, 1e-13);
  EXPECT_NEAR(value_of(results, "moving_surface_share_mean"), 0.25 * pi, 2e-3);  // 0.02 m/s is at rest
  EXPECT_EQ(value_of(results, "class_0_moving_grains"), 0.0);
  EXPECT_EQ(value_of(results, "class_1_moving_grains"), 200.0);
}

// Wilcock & Crowe's rate with the weight of a grain for scale, each class by its own size and share of the surface.
TEST(FractionalTransport, ScalesTheRateOfAClassByItsOwnGrains) {
  FractionalTransport observer = of_two_classes();
  observer.observe(armoured_bed(world, 0.5, 0.1).snapshot(0.0));
  const double q_small = small_grains * volume(small) * 0.5 / 200.0,
               q_large = large_grains * volume(large) * 0.1 / 200.0;
  const std::vector<Diagnostic> results = observer.results();
  EXPECT_NEAR(value_of(results, "class_0_q_s_mean"), q_small, 1e-14);
  EXPECT_NEAR(value_of(results, "class_1_q_s_mean"), q_large, 1e-14);
  EXPECT_NEAR(value_of(results, "class_1_load_share"), q_large / (q_small + q_large), 1e-14);
  EXPECT_NEAR(value_of(results, "load_d50"), small, 1e-14);
  const double share = value_of(results, "class_0_surface_share_mean");
  EXPECT_NEAR(value_of(results, "class_0_q_star_mean"),
              q_small / (share * std::sqrt(2.0 * 10.0 * small * small * small)), 1e-13);
  EXPECT_NEAR(value_of(results, "class_1_q_star_mean"), q_large / ((1.0 - share) * std::sqrt(20.0)), 1e-13);
}

TEST(FractionalTransport, AddsUpToTheTransportRate) {
  const auto made = [](GlobalId id) {
    const double phase = static_cast<double>(id);
    return MadeUpGrain{0.3 + 0.2 * std::cos(phase), 1.0, Vec3(std::sin(3.0 * phase), 0.1, 0.0), Vec3::Zero(),
                       Vec3(std::fmod(7.3 * phase, 20.0), std::fmod(3.1 * phase, 10.0), 1.0 + std::sin(phase))};
  };
  for (const bool with_clump : {false, true}) {
    const MPI_Comm ranks = with_clump ? MPI_COMM_SELF : world;  // members are where their clump is
    MadeUpGrains grains(ranks, 1000, made);
    grains.hold([](GlobalId id) { return id % 7 == 0; });
    if (with_clump) grains.bind(6, {994, 1.0, 0.05, Vec3::Zero(), Vec3(0.5, 0.0, 0.0), 0.0});
    FractionalTransport observer(ranks, box, scales, SizeClasses({0.2, 0.3, 0.5, 0.7, 0.8, 1.0}), {}, 0.05);
    TransportRate rate(ranks, scales, {});
    observer.observe(grains.snapshot(0.0));
    rate.observe(grains.snapshot(0.0));
    const auto sum = [shown = shown_by(observer)](const char* name) {
      const std::vector<double>& values = shown.at(name);
      return std::accumulate(values.begin(), values.end(), 0.0);
    };
    EXPECT_NEAR(sum("q_s"), value_of(rate.diagnostics(), "q_s"), 1e-14);
    EXPECT_EQ(sum("moving_grains"), value_of(rate.diagnostics(), "moving_grains"));
    EXPECT_NEAR(sum("bed_share"), 1.0, 1e-14);
    EXPECT_NEAR(sum("surface_share"), 1.0, 1e-14);
  }
}

// A plate of the small grains that is held is no bed: the large ones are all there is, and what shows between them
// counts nowhere.
TEST(FractionalTransport, LeavesOutGrainsWhoseMotionIsGiven) {
  MadeUpGrains grains = armoured_bed(world, 0.5, 0.1);
  grains.hold([](GlobalId id) { return id < small_grains; });
  FractionalTransport observer = of_two_classes();
  observer.observe(grains.snapshot(0.0));
  const auto shown = shown_by(observer);
  EXPECT_EQ(shown.at("bed_share"), (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(shown.at("surface_share"), (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(shown.at("q_s").at(0), 0.0);
  EXPECT_TRUE(std::isnan(shown.at("q_star").at(0)));
  EXPECT_NEAR(shown.at("diameter").at(0), std::sqrt(0.25 * 0.63), 1e-15);
}

// The last two of the large grains are a clump of the volume of a small one: its class follows the volume, and both of
// its members are seen as small.
TEST(FractionalTransport, SortsAClumpByItsVolume) {
  MadeUpGrains grains = armoured_bed(MPI_COMM_SELF, 0.0, 0.1);
  const GlobalId clump = small_grains + large_grains - 2;
  grains.bind(2, {clump, 3000.0 * volume(small), volume(small), Vec3::Zero(), Vec3(0.1, 0.0, 0.0), 0.0});
  FractionalTransport observer(MPI_COMM_SELF, box, scales, SizeClasses({0.25, 0.63, 1.6}), {}, 0.0173);
  observer.observe(grains.snapshot(0.0));
  const std::vector<Diagnostic> results = observer.results();
  EXPECT_NEAR(value_of(results, "class_0_q_s_mean"), volume(small) * 0.1 / 200.0, 1e-16);
  EXPECT_NEAR(value_of(results, "class_1_surface_share_mean"), 0.25 * pi * 198.0 / 200.0, 2e-3);
  EXPECT_EQ(value_of(results, "class_0_moving_grains"), 1.0);
}

TEST(FractionalTransport, HasTheSameBitsOnAnyNumberOfRanks) {
  FractionalTransport alone(MPI_COMM_SELF, box, scales, SizeClasses({0.25, 0.63, 1.6}), {}, 0.0173);
  FractionalTransport shared = of_two_classes();
  alone.observe(armoured_bed(MPI_COMM_SELF, 0.3, 0.7).snapshot(0.0));
  shared.observe(armoured_bed(world, 0.3, 0.7).snapshot(0.0));
  const std::vector<Diagnostic> a = alone.results(), b = shared.results();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n)
    EXPECT_TRUE(a[n].value == b[n].value || (std::isnan(a[n].value) && std::isnan(b[n].value))) << a[n].name;
}

TEST(FractionalTransport, TakesTheMeanFromAGivenTimeAndCarriesItOverARestart) {
  FractionalTransport whole = of_two_classes({.from = 2.0});
  whole.observe(armoured_bed(world, 100.0, 100.0).snapshot(1.9));
  EXPECT_TRUE(std::isnan(value_of(whole.results(), "class_0_q_s_mean"))) << "a mean of nothing";
  EXPECT_TRUE(whole.remarks().empty());
  whole.observe(armoured_bed(world, 0.1, 0.2).snapshot(2.0));
  ASSERT_EQ(whole.remarks().size(), 1U);
  EXPECT_EQ(whole.remarks().front().find("+-"), std::string::npos) << "no error of a single measurement";
  const test::MemoryArchive checkpoint = test::saved(whole, world);

  FractionalTransport restarted = of_two_classes({.from = 2.0}), other_window = of_two_classes({.from = 2.5});
  FractionalTransport other_classes(world, box, scales, SizeClasses({0.25, 0.6, 1.6}), {.from = 2.0}, 0.0173);
  test::MemoryReader reader(checkpoint);
  EXPECT_FALSE(other_window.load(reader));
  EXPECT_FALSE(other_classes.load(reader));
  ASSERT_TRUE(restarted.load(reader));
  EXPECT_EQ(value_of(restarted.diagnostics(), "class_1_q_s"), value_of(whole.diagnostics(), "class_1_q_s"));
  for (FractionalTransport* next : {&whole, &restarted}) {
    next->observe(armoured_bed(world, 0.1, 0.2).snapshot(2.0));  // seen again: it counts once
    next->observe(armoured_bed(world, 0.3, 0.4).snapshot(3.0));
  }
  const std::vector<Diagnostic> a = whole.results(), b = restarted.results();
  for (std::size_t n = 0; n < a.size(); ++n) EXPECT_EQ(a[n].value, b[n].value) << a[n].name;
  EXPECT_NEAR(value_of(b, "class_0_q_s_mean"), small_grains * volume(small) * 0.2 / 200.0, 1e-13);
  EXPECT_EQ(value_of(b, "measurements"), 2.0);
  EXPECT_NE(whole.remarks().front().find("armouring ratio 2.5 +- "), std::string::npos) << whole.remarks().front();
}

// The large grains, which carry all of the load, leave by a sink: what has moved keeps its size and density.
TEST(FractionalTransport, KeepsTheSizeOfAClassThatHasLeft) {
  FractionalTransport whole = of_two_classes(), restarted = of_two_classes();
  whole.observe(armoured_bed(world, 0.0, 0.4).snapshot(0.0));
  const MadeUpGrains rest(world, small_grains + large_grains, [](GlobalId id) {
    return id < small_grains ? std::optional(armoured(id, 0.0, 0.4)) : std::nullopt;
  });
  whole.observe(rest.snapshot(1.0));
  const test::MemoryArchive checkpoint = test::saved(whole, world);
  test::MemoryReader reader(checkpoint);
  ASSERT_TRUE(restarted.load(reader));
  const double share = value_of(whole.results(), "class_1_surface_share_mean");
  for (const FractionalTransport* observer : {&whole, &restarted}) {
    const std::vector<Diagnostic> results = observer->results();
    EXPECT_NEAR(value_of(results, "load_d50"), large, 1e-14);
    EXPECT_NEAR(value_of(results, "class_1_diameter"), large, 1e-14);
    EXPECT_NEAR(shown_by(*observer).at("density").at(1), 3000.0, 1e-9);
    const double of_small = small_grains * volume(small), of_large = large_grains * volume(large);
    EXPECT_NEAR(value_of(results, "class_1_bed_share"), of_large / (2.0 * of_small + of_large),
                1e-14);  // half the time
    EXPECT_NEAR(value_of(results, "bed_d50"), small, 1e-14);
    // Large over small, then small over small; the large grains alone would have 1 as well.
    EXPECT_NEAR(value_of(results, "armouring_ratio_mean"), 0.5 * (large / small + 1.0), 1e-13);
    EXPECT_EQ(value_of(results, "errors_hold"), 0.0);
    const double q_s = 0.5 * large_grains * volume(large) * 0.4 / 200.0;
    EXPECT_NEAR(value_of(results, "class_1_q_star_mean"), q_s / (share * std::sqrt(20.0)), 1e-13);
  }
  EXPECT_NE(whole.remarks().front().find("of the load 1 m"), std::string::npos) << whole.remarks().front();
}

// A bed of small grains that all leave but the large ones: at each time surface and bed are of one size.
TEST(FractionalTransport, ComparesTheSurfaceWithTheBedOfTheSameTime) {
  FractionalTransport observer = of_two_classes();
  for (const bool first : {true, false}) {
    const MadeUpGrains grains(world, small_grains + large_grains, [first](GlobalId id) {
      return (id < small_grains) == first ? std::optional(armoured(id, 0.1, 0.1)) : std::nullopt;
    });
    observer.observe(grains.snapshot(first ? 0.0 : 1.0));
  }
  EXPECT_NEAR(value_of(observer.results(), "armouring_ratio_mean"), 1.0, 1e-13);
}

TEST(FractionalTransport, CountsTheLoadWhicheverWayItGoes) {
  FractionalTransport along = of_two_classes(), against = of_two_classes();
  along.observe(armoured_bed(world, 0.1, 0.4).snapshot(0.0));
  against.observe(armoured_bed(world, -0.1, -0.4).snapshot(0.0));
  const std::vector<Diagnostic> a = along.results(), b = against.results();
  EXPECT_GT(value_of(a, "load_d50"), 0.0);
  for (const char* name : {"load_d50", "class_0_load_share", "class_1_load_share", "surface_d50_mean"})
    EXPECT_EQ(value_of(a, name), value_of(b, name)) << name;
  EXPECT_EQ(value_of(a, "class_0_q_s_mean"), -value_of(b, "class_0_q_s_mean"));
}

RunContext run_of(double smallest, double largest, bool held = false) {
  RunContext run;
  run.box = box;
  run.until = 10.0;
  run.grains.emplace();
  run.grains->populations = {{"grains_0", 0, 5, {}, held, false}};
  run.grains->smallest_free = smallest;
  run.grains->largest_free = largest;
  return run;
}

TEST(FractionalTransportKeys, HaveClassesThatCoverTheGrains) {
  const FractionalTransportKeys keys{.edges = {2e-3, 4e-3, 8e-3}};
  EXPECT_NO_THROW(check(keys, run_of(2e-3, 8e-3)));
  EXPECT_THROW(check(keys, run_of(1.9e-3, 8e-3)), KeyError);
  EXPECT_THROW(check(keys, run_of(2e-3, 8.1e-3)), KeyError);
  EXPECT_NO_THROW(check(FractionalTransportKeys{}, run_of(1e-3, 9e-3)));
  EXPECT_THROW(check(FractionalTransportKeys{}, run_of(1e-3, 9e-3, true)), KeyError) << "no grain is free";
  RunContext endless = run_of(2e-3, 8e-3);
  endless.box.periodic[2] = true;
  EXPECT_THROW(check(keys, endless), KeyError);
  EXPECT_FALSE(warning(keys, run_of(2e-3, 8e-3)));
  EXPECT_TRUE(warning(keys, run_of(8e-3, 8e-3))) << "a single size";
  RequestedObservers requested;
  requested.of<FractionalTransportKeys>() = FractionalTransportKeys{.from = 0.5};
  RunContext run = run_of(2e-3, 8e-3);
  run.until = 1.0;
  EXPECT_TRUE(warnings(requested, run).empty());
  run.until = 0.5;
  EXPECT_EQ(warnings(requested, run).size(), 1U) << "it begins when the run ends";
}

}  // namespace
}  // namespace thalweg::analysis::fractional_transport_test
