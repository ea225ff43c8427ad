#include "analysis/transport_rate.hpp"

#include "tests/analysis/made_up_grains.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace thalweg::analysis {
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

// In memory only: what observers put into a checkpoint.
class AttributeStore : public ArchiveWriter, public ArchiveReader {
public:
  void write(const std::string&, std::span<const double>, const ArrayBox&) override { FAIL(); }
  void write(const std::string&, std::span<const float>, const ArrayBox&) override { FAIL(); }
  void write(const std::string&, std::span<const std::int64_t>, const ArrayBox&) override { FAIL(); }
  void attribute(const std::string& path, double value) override { reals_[path] = value; }
  void attribute(const std::string& path, std::int64_t value) override { integers_[path] = value; }
  void attribute(const std::string&, const std::string&) override { FAIL(); }
  bool has(const std::string& path) const override { return reals_.contains(path) || integers_.contains(path); }
  std::vector<std::uint64_t> shape(const std::string&) const override { return {}; }
  void read(const std::string&, std::span<double>, const ArrayBox&) override { FAIL(); }
  void read(const std::string&, std::span<float>, const ArrayBox&) override { FAIL(); }
  void read(const std::string&, std::span<std::int64_t>, const ArrayBox&) override { FAIL(); }
  double real_attribute(const std::string& path) const override { return reals_.at(path); }
  std::int64_t integer_attribute(const std::string& path) const override { return integers_.at(path); }
  std::string text_attribute(const std::string&) const override { return {}; }

private:
  std::map<std::string, double> reals_;
  std::map<std::string, std::int64_t> integers_;
};

TEST(TransportRate, IsTheVolumeFluxOfAllGrainsPerWidth) {
  const MadeUpGrains grains(world, 300, [](GlobalId id) { return runner(id, 1.0); });
  TransportRate rate(world, scales, 0.0);
  rate.observe(grains.snapshot(0.0));

  const double volume = std::numbers::pi / 6.0 * 0.25 * 0.25 * 0.25;
  const double q_s = volume * sum_of_speeds / (20.0 * 10.0);
  EXPECT_NEAR(value_of(rate.figures(), "q_s"), q_s, 4e-16 * 1e3 * q_s);  // a few roundings a term
  EXPECT_NEAR(value_of(rate.figures(), "q_star"), q_s / 0.75, 4e-16 * 1e3 * q_s);
  EXPECT_EQ(value_of(rate.figures(), "moving_grains"), 200.0);  // 0.03 m/s itself is not moving
  EXPECT_NEAR(value_of(rate.figures(), "largest_grain_speed"), std::sqrt(2.99 * 2.99 + 1.0), 1e-15 * 4);
}

TEST(TransportRate, TakesAClumpForOneGrainWithItsVolumeAtItsCentre) {
  // The last six of the grains, ids 294 to 299, are one clump of 0.05 m^3 at 0.5 m/s; four of them moved.
  MadeUpGrains grains(world, 300, [](GlobalId id) { return runner(id, 1.0); });
  grains.bind(6, {294, 1.0, 0.05, Vec3::Zero(), Vec3(0.5, 0.0, 0.0), 0.0});
  TransportRate rate(world, scales, 0.0);
  rate.observe(grains.snapshot(0.0));
  const double volume = std::numbers::pi / 6.0 * 0.25 * 0.25 * 0.25;
  const double gone = (295.0 + 296.0 + 298.0 + 299.0) / 100.0;
  const double q_s = (volume * (sum_of_speeds - gone) + 0.05 * 0.5) / (20.0 * 10.0);
  EXPECT_NEAR(value_of(rate.figures(), "q_s"), q_s, 4e-16 * 1e3 * q_s);
  EXPECT_EQ(value_of(rate.figures(), "moving_grains"), 197.0);
  EXPECT_NEAR(value_of(rate.figures(), "largest_grain_speed"), std::sqrt(2.93 * 2.93 + 1.0), 1e-15 * 4);
}

TEST(TransportRate, HasTheSameBitsOnAnyNumberOfRanks) {
  const auto made = [](GlobalId id) {
    const double phase = static_cast<double>(id);
    return MadeUpGrain{0.1 + 0.05 * std::cos(phase), 1.0, Vec3(std::sin(3.0 * phase), 0.0, 0.0), Vec3::Zero()};
  };
  TransportRate alone(MPI_COMM_SELF, scales, 0.0), shared(world, scales, 0.0);
  alone.observe(MadeUpGrains(MPI_COMM_SELF, 1000, made).snapshot(0.0));
  shared.observe(MadeUpGrains(world, 1000, made).snapshot(0.0));
  for (const char* name : {"q_s", "q_star", "moving_grains", "largest_grain_speed"})
    EXPECT_EQ(value_of(alone.figures(), name), value_of(shared.figures(), name)) << name;
}

TEST(TransportRate, TakesTheMeanFromAGivenTimeAndCarriesItOverARestart) {
  const auto grains = [](double factor) {
    return MadeUpGrains(world, 300, [factor](GlobalId id) { return runner(id, factor); });
  };
  TransportRate rate(world, scales, 2.0);
  rate.observe(grains(100.0).snapshot(1.9));
  EXPECT_EQ(value_of(rate.results(), "q_star_mean"), 0.0);
  rate.observe(grains(1.0).snapshot(2.0));
  AttributeStore checkpoint;
  rate.save(checkpoint);

  TransportRate restarted(world, scales, 2.0), other_window(world, scales, 2.5);
  for (TransportRate* next : {&restarted, &other_window}) {
    next->load(checkpoint);
    next->observe(grains(1.0).snapshot(2.0));  // what the checkpoint holds, seen again: it counts once
    next->observe(grains(3.0).snapshot(3.0));
  }
  // Measurements 1 and 3 times the same flux: mean 2, standard deviation 1.
  const double one = std::numbers::pi / 6.0 / 64.0 * sum_of_speeds / 200.0 / 0.75;
  EXPECT_NEAR(value_of(restarted.results(), "q_star_mean"), 2.0 * one, 1e-12 * one);
  EXPECT_NEAR(value_of(restarted.results(), "q_star_deviation"), one, 1e-12 * one);
  EXPECT_EQ(value_of(restarted.results(), "measurements"), 2.0);
  EXPECT_NEAR(value_of(other_window.results(), "q_star_mean"), 3.0 * one, 1e-12 * one);
}

TEST(TransportRate, OfDryGrainsHasNoQStar) {
  TransportRate rate(world, {0.25, 2500.0, 0.0, 9.8}, 0.0);
  rate.observe(MadeUpGrains(world, 10, [](GlobalId id) { return runner(id, 1.0); }).snapshot(0.0));
  EXPECT_THROW(value_of(rate.figures(), "q_star"), std::out_of_range);
  // v_x = 0.01, 0.02, 0.04, 0.05, 0.07, 0.08 m/s: sum 0.27 m/s.
  const double q_s = std::numbers::pi / 6.0 / 64.0 * 0.27 / 200.0;
  EXPECT_NEAR(value_of(rate.figures(), "q_s"), q_s, 1e-14 * q_s);
}

}  // namespace
}  // namespace thalweg::analysis
