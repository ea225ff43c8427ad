#include "analysis/bed/union_of_spheres.hpp"

#include "analysis/tools/sphere_in_layer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace thalweg::analysis::union_of_spheres_test {
namespace {

constexpr double r = 0.8, whole = 4.0 / 3.0 * std::numbers::pi * r * r * r;
const PeriodicBox box{{6.0, 5.0, 4.0}, {true, true, false}};

TEST(UnionOfSpheres, OfOneIsItsVolumeInEveryLayer) {
  for (const std::array<double, 3>& centre : {std::array<double, 3>{3.0, 2.5, 2.0}, {0.1, 4.9, 2.0}, {5.7, 0.2, 1.1}}) {
    const std::vector<double> below = union_below(box, std::vector<SphereInBed>{{0, centre, r}}, 40);
    ASSERT_EQ(below.size(), 41U);
    for (std::size_t k = 0; k < below.size(); ++k)
      EXPECT_NEAR(below[k], sphere_volume_below(r, 0.1 * static_cast<double>(k) - centre[2] + r), 2e-3 * whole) << k;
  }
}

TEST(UnionOfSpheres, CountsNothingBelowTheFloorOrBeyondAWall) {
  const SphereInBed low{0, {3.0, 2.5, 0.3}, r};
  EXPECT_NEAR(union_below(box, std::vector{low}, 1).back(), whole - sphere_volume_below(r, r - 0.3), 2e-3 * whole);
  const PeriodicBox walled{box.size, {false, false, false}};
  const SphereInBed beside{0, {0.0, 2.5, 2.0}, r};
  EXPECT_NEAR(union_below(walled, std::vector{beside}, 1).back(), 0.5 * whole, 2e-3 * whole);
}

// The lens of two equal spheres s apart: pi (4 r + s)(2 r - s)^2/12. Through a periodic face as well.
TEST(UnionOfSpheres, CountsOverlapsOnce) {
  const double s = 0.7, lens = std::numbers::pi * (4.0 * r + s) * std::pow(2.0 * r - s, 2) / 12.0;
  for (const double x : {2.0, 5.6}) {
    const double other = std::fmod(x + s, 6.0);
    const std::vector<SphereInBed> two{{0, {x, 2.0, 2.0}, r}, {1, {other, 2.0, 2.0}, r}};
    EXPECT_NEAR(union_below(box, two, 10).back(), 2.0 * whole - lens, 2e-3 * whole);
  }
  const std::vector<SphereInBed> same(5, {0, {3.0, 2.5, 2.0}, r});
  EXPECT_NEAR(union_below(box, same, 10).back(), whole, 2e-3 * whole);
  EXPECT_EQ(union_below(box, {}, 2), (std::vector<double>{0.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace thalweg::analysis::union_of_spheres_test
