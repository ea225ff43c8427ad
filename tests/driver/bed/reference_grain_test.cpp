#include "driver/bed/reference_grain.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace thalweg::driver::reference_grain_test {
namespace {

beds::Population population(std::int64_t count, double diameter, double density) {
  beds::Population grains;
  grains.count = count;
  grains.diameter = diameter;
  grains.density = density;
  return grains;
}

TEST(ReferenceGrain, OfOnePopulationIsItsOwn) {
  Case c;
  c.grains = {population(70, 4.95e-3, 2550.1)};
  EXPECT_EQ(reference_grain(c).diameter, 4.95e-3);
  EXPECT_EQ(reference_grain(c).density, 2550.1);
}

// Volumes as 10 : 3 2^3 : 1 3^3 = 10 : 24 : 27, of which half is 30.5: the middle size, in any order. The mass over the
// volume is (10 2000 + 24 2500 + 27 3000)/61.
TEST(ReferenceGrain, DoesNotDependOnTheOrderOfPopulations) {
  Case c;
  c.grains = {population(10, 1e-3, 2000.0), population(3, 2e-3, 2500.0), population(1, 3e-3, 3000.0)};
  std::vector<int> order{0, 1, 2};
  const std::vector<beds::Population> grains = c.grains;
  do {
    for (std::size_t n = 0; n < 3; ++n) c.grains[n] = grains[static_cast<std::size_t>(order[n])];
    EXPECT_EQ(reference_grain(c).diameter, 2e-3);
    EXPECT_NEAR(reference_grain(c).density, 161000.0 / 61.0, 1e-9);
  } while (std::next_permutation(order.begin(), order.end()));
}

// Five grains to two whose diameter is 1.4 times as large: 5 : 5.5 by the volume of spheres, 5 : 3.9 by that of disks.
TEST(ReferenceGrain, OfDisksIsByTheirArea) {
  Case c;
  c.grains = {population(5, 1e-3, 2000.0), population(2, 1.4e-3, 2000.0)};
  EXPECT_EQ(reference_grain(c).diameter, 1.4e-3);
  c.disks.emplace();
  EXPECT_EQ(reference_grain(c).diameter, 1e-3);
}

TEST(ReferenceGrain, LeavesOutWhatIsHeldAndMovedWhileThereIsAnythingFree) {
  Case c;
  c.grains = {population(1000, 8e-3, 7000.0), population(5, 2e-3, 2500.0), population(1000, 9e-3, 7000.0)};
  c.grains[0].fixed = true;
  c.grains[2].motion.emplace();
  EXPECT_EQ(reference_grain(c).diameter, 2e-3);
  EXPECT_EQ(reference_grain(c).density, 2500.0);
  c.grains[1].prescribed_velocity = Vec3(0.1, 0.0, 0.0);
  EXPECT_EQ(reference_grain(c).diameter, 9e-3);
}

TEST(ReferenceGrain, IsWhatTheUserSays) {
  Case c;
  c.grains = {population(10, 1e-3, 2000.0)};
  c.analysis.reference_diameter = 1.5e-3;
  EXPECT_EQ(reference_grain(c).diameter, 1.5e-3);
  EXPECT_EQ(reference_grain(c).density, 2000.0);
}

}  // namespace
}  // namespace thalweg::driver::reference_grain_test
