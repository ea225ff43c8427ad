// The load of a step from the exchanges up to then, and the filter of light grains.
#include "coupling/loads/light_load.hpp"
#include "coupling/loads/load_averaging.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace thalweg::coupling::load_test {
namespace {

constexpr LoadAveraging both_rules[] = {LoadAveraging::extrapolated, LoadAveraging::mean};

// The loads of a grain that has had no exchange before.
std::vector<Vec3> loads(LoadAveraging rule, const std::vector<Vec3>& exchanges) {
  std::vector<Vec3> loads;
  Vec3 last = Vec3::Zero(), before_last = Vec3::Zero();
  for (const Vec3& now : exchanges) {
    loads.push_back(averaged_load(rule, now, last, before_last));
    before_last = last;
    last = now;
  }
  return loads;
}

TEST(Load, GivesTheImpulseOfEveryExchangeInFull) {
  for (const LoadAveraging rule : both_rules)
    for (std::size_t struck = 0; struck < 4; ++struck) {
      std::vector<Vec3> exchanges(8, Vec3::Zero());
      exchanges[struck] = Vec3(3.0, -2.0, 0.5);
      Vec3 impulse = Vec3::Zero();
      for (const Vec3& load : loads(rule, exchanges)) impulse += load;
      EXPECT_EQ(impulse, exchanges[struck]) << "in step " << struck;
    }
}

TEST(Load, HasNoPartThatAlternatesFromStepToStep) {
  std::vector<Vec3> exchanges;
  for (int n = 0; n < 8; ++n) exchanges.push_back(Vec3(1.0, 2.0, n % 2 == 0 ? 5.0 : -5.0));
  for (const LoadAveraging rule : both_rules) EXPECT_EQ(loads(rule, exchanges).back(), Vec3(1.0, 2.0, 0.0));
}

// The load of a force that grows evenly is that of the middle of the coming step, one step after the mean.
TEST(Load, HasNoLagWhereItIsExtrapolated) {
  std::vector<Vec3> exchanges;
  for (int n = 0; n < 8; ++n) exchanges.push_back(Vec3(n, 0.0, 0.0));
  EXPECT_EQ(loads(LoadAveraging::mean, exchanges).back().x(), 6.5);
  EXPECT_EQ(loads(LoadAveraging::extrapolated, exchanges).back().x(), 7.5);
}

constexpr LightLoad water{1000.0, 5e-4};  // kg/m^3, m

TEST(LightLoad, ConcernsGrainsBelowEightCellsOverTheDiameterOfTheFluidsDensity) {
  const double radius = 2.5e-3, displaced = 1000.0 * Sphere{radius}.volume();  // ten cells
  EXPECT_TRUE(water.concerns({0.79 * displaced, radius, 2.0 * radius}));
  EXPECT_FALSE(water.concerns({0.81 * displaced, radius, 2.0 * radius}));
  EXPECT_NEAR(water.share({0.5 * displaced, radius, 2.0 * radius}), 0.5, 1e-12);  // m_C is half of the displaced mass
  // A clump of this volume that is half as wide.
  EXPECT_TRUE(water.concerns({1.59 * displaced, radius, radius}));
  EXPECT_FALSE(water.concerns({1.61 * displaced, radius, radius}));
  EXPECT_NEAR(water.share({displaced, radius, radius}), 0.5, 1e-12);
}

TEST(LightLoad, PassesImpulsesInFullAndSteadyLoadsUnchanged) {
  const double share = 0.2;
  Vec3 given = Vec3::Zero(), impulse = Vec3::Zero();
  for (int n = 0; n < 200; ++n) {
    given = LightLoad::filtered(given, n == 0 ? Vec3(1.0, -4.0, 2.0) : Vec3(Vec3::Zero()), share);
    impulse += given;
  }
  EXPECT_NEAR((impulse - Vec3(1.0, -4.0, 2.0)).norm(), 0.0, 1e-12);
  const Vec3 steady(0.3, 0.1, -0.7);
  EXPECT_EQ(LightLoad::filtered(steady, steady, share), steady);
}

}  // namespace
}  // namespace thalweg::coupling::load_test
