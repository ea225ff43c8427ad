#include "beds/packing/packing.hpp"

#include "beds/packing/random_packing.hpp"
#include "core/base/error.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace thalweg::beds::packing_test {
namespace {

using namespace dem;

const PeriodicBox flume{Vec3(0.12, 0.04, 0.106), {true, true, false}};

std::vector<GrainSeed> seeds_at(const std::vector<Vec3>& centres, double radius) {
  std::vector<GrainSeed> seeds;
  for (std::size_t i = 0; i < centres.size(); ++i)
    seeds.push_back(test::glass_sphere(static_cast<GlobalId>(i), centres[i], Vec3::Zero(), radius));
  return seeds;
}

std::string refusal(const std::function<void()>& place) {
  try {
    place();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(UniformPacking, FillsTheBoxWithoutOverlap) {
  const std::vector<Vec3> centres = uniform_packing(flume, whole(flume), 2884, 2.5e-3, 1e-3, 1);
  ASSERT_EQ(centres.size(), 2884u);
  EXPECT_NO_THROW(check(seeds_at(centres, 2.5e-3), flume, face_planes(flume, test::glass(0.9))));
  // Evenly: every eighth of the box holds an eighth of the grains, up to a layer's share.
  for (int octant = 0; octant < 8; ++octant) {
    const auto inside = std::count_if(centres.begin(), centres.end(), [&](const Vec3& x) {
      return (x[0] < 0.06) == (octant % 2 == 0) && (x[1] < 0.02) == (octant / 2 % 2 == 0) &&
             (x[2] < 0.053) == (octant / 4 == 0);
    });
    EXPECT_NEAR(static_cast<double>(inside), 2884.0 / 8.0, 60.0);
  }
  EXPECT_EQ(centres, uniform_packing(flume, whole(flume), 2884, 2.5e-3, 1e-3, 1));
  EXPECT_NE(centres, uniform_packing(flume, whole(flume), 2884, 2.5e-3, 1e-3, 2));
}

// The share of the volume that spheres within `cut` of a sphere's centre have their centres in, over that of points at
// random: the pair correlation up to there.
double neighbours_within(const PeriodicBox& box, const std::vector<Vec3>& centres, double cut) {
  std::int64_t pairs = 0;
  for (std::size_t a = 0; a < centres.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) pairs += box.difference(centres[a], centres[b]).norm() < cut;
  return 2.0 * static_cast<double>(pairs) / static_cast<double>(centres.size());
}

TEST(DensePacking, FillsAPeriodicBoxToThreeFifthsWithoutOverlap) {
  const double radius = 2.5e-3, volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  const PeriodicBox cube{Vec3::Constant(0.04), {true, true, true}};
  const auto count = static_cast<std::size_t>(0.6 * cube.size.prod() / volume);
  const std::vector<double> radii(count, radius);
  const std::vector<Vec3> centres = dense_packing(cube, whole(cube), radii, 0.0, 1);
  ASSERT_EQ(centres.size(), count);
  EXPECT_NO_THROW(check(seeds_at(centres, radius), cube, {}));
  EXPECT_EQ(centres, dense_packing(cube, whole(cube), radii, 0.0, 1));
  EXPECT_NE(centres, dense_packing(cube, whole(cube), radii, 0.0, 2));
  // A random packing: a grain has six neighbours or so that nearly touch (a crystal twelve), and thirteen to fourteen
  // within the first minimum of the pair correlation at 1.4 diameters.
  EXPECT_LT(neighbours_within(cube, centres, 2.04 * radius), 8.0);
  EXPECT_NEAR(neighbours_within(cube, centres, 2.8 * radius), 13.5, 1.5);
}

TEST(DensePacking, KeepsToItsRegionAndClearOfObstacles) {
  const PeriodicBox box{Vec3(0.04, 0.03, 0.05), {true, true, false}};
  const Region region{Vec3(0.0, 0.0, 0.01), Vec3(0.04, 0.03, 0.04)};
  const std::vector<PlacedSphere> obstacles{{Vec3(0.02, 0.015, 0.02), 6e-3}, {Vec3(0.0, 0.0, 0.03), 4e-3}};
  std::vector<double> radii;
  for (int n = 0; n < 200; ++n) radii.push_back(n % 2 == 0 ? 2.5e-3 : 2e-3);
  const std::vector<Vec3> centres = dense_packing(box, region, radii, 1e-3, 3, obstacles);
  for (std::size_t n = 0; n < centres.size(); ++n) {
    EXPECT_GE(centres[n].z(), 0.011 + radii[n] - 1e-15);
    EXPECT_LE(centres[n].z(), 0.039 - radii[n] + 1e-15);
    for (const PlacedSphere& obstacle : obstacles)
      EXPECT_GE(box.difference(centres[n], obstacle.position).norm(), radii[n] + obstacle.radius);
    for (std::size_t m = 0; m < n; ++m) EXPECT_GE(box.difference(centres[n], centres[m]).norm(), radii[n] + radii[m]);
  }
}

TEST(DensePacking, RefusesWhatDoesNotFit) {
  const PeriodicBox cube{Vec3::Constant(0.015), {true, true, true}};
  const std::string message =
      refusal([&] { dense_packing(cube, whole(cube), std::vector<double>(40, 2.5e-3), 0.0, 1); });
  EXPECT_NE(message.find("do not fit"), std::string::npos) << message;  // 0.78 of the volume
}

TEST(UniformPacking, TakesExactlyAsManyAsFitAndNamesThem) {
  // 24 x 8 x 21 touching spheres.
  EXPECT_EQ(uniform_packing(flume, whole(flume), 24 * 8 * 21, 2.5e-3, 0.0, 1).size(), 24u * 8u * 21u);
  EXPECT_NO_THROW(
      check(seeds_at(uniform_packing(flume, whole(flume), 24 * 8 * 21, 2.5e-3, 0.0, 1), 2.5e-3), flume, {}));
  const std::string message = refusal([] { uniform_packing(flume, whole(flume), 24 * 8 * 21 + 1, 2.5e-3, 0.0, 1); });
  EXPECT_NE(message.find("4032 would"), std::string::npos) << message;
}

// 72 cells of 0.833333333 mm (nine digits) are 0.06 m less 24 pm, for 12 grains of 5 mm; they are moved together by
// less than a seed may overlap.
TEST(UniformPacking, FillsABoxOfRoundedCells) {
  const auto refused = [](double shorter) {
    const PeriodicBox box{Vec3((1.0 - shorter) * 0.06, 0.03, 0.05), {true, true, false}};
    const Region layer{Vec3::Zero(), Vec3(box.size.x(), box.size.y(), (1.0 - shorter) * 5e-3)};
    return refusal([&] { check(seeds_at(uniform_packing(box, layer, 72, 2.5e-3, 0.0, 1), 2.5e-3), box, {}); });
  };
  EXPECT_EQ(refused(1.0 - 72.0 * 0.833333333e-3 / 0.06), "");
  EXPECT_EQ(refused(0.99e-6), "");
  EXPECT_NE(refused(1.1e-6).find("0 would"), std::string::npos);  // one layer is too high
}

TEST(UniformPacking, SpreadsDisksOverTheMiddlePlane) {
  // 12 x 10 disks of 5 mm fill 60 x 50 mm; one more does not fit.
  const PeriodicBox tray{Vec3(0.06, 0.02, 0.05), {true, true, false}};
  Region sheet = whole(tray);
  sheet.plane = true;
  for (const int count : {1, 7, 100, 120}) {
    const std::vector<Vec3> centres = uniform_packing(tray, sheet, count, 2.5e-3, 0.0, 1);
    ASSERT_EQ(centres.size(), static_cast<std::size_t>(count));
    EXPECT_TRUE(std::all_of(centres.begin(), centres.end(), [](const Vec3& x) { return x[1] == 0.01; }));
    EXPECT_NO_THROW(check(seeds_at(centres, 2.5e-3), tray, face_planes(tray, test::glass(0.9))));
  }
  const std::string message = refusal([&] { uniform_packing(tray, sheet, 121, 2.5e-3, 0.0, 1); });
  EXPECT_NE(message.find("120 would"), std::string::npos) << message;
}

TEST(RandomPacking, KeepsClearOfWallsObstaclesAndEachOther) {
  std::vector<double> radii;
  for (int i = 0; i < 1200; ++i) radii.push_back(i % 3 == 0 ? 3.0e-3 : 2.0e-3);
  const Region region{Vec3(0.0, 0.0, 0.01), Vec3(0.12, 0.04, 0.1)};
  const PlacedSphere obstacle{Vec3(0.06, 0.02, 0.05), 8e-3};
  const std::vector<Vec3> centres = random_packing(flume, region, radii, 1e-3, 7, {{obstacle}});
  ASSERT_EQ(centres.size(), radii.size());
  for (std::size_t i = 0; i < centres.size(); ++i) {
    ASSERT_GE(centres[i][2], 0.01 + radii[i] + 1e-3 - 1e-12);
    ASSERT_LE(centres[i][2], 0.1 - radii[i] - 1e-3 + 1e-12);
    ASSERT_GE(flume.difference(centres[i], obstacle.position).norm(), radii[i] + obstacle.radius);
    for (std::size_t j = 0; j < i; ++j) ASSERT_GE(flume.difference(centres[i], centres[j]).norm(), radii[i] + radii[j]);
  }
}

TEST(RandomPacking, SaysHowManyFitted) {
  const std::vector<double> radii(4000, 2.5e-3);
  const std::string message = refusal([&] { random_packing(flume, whole(flume), radii, 0.0, 7); });
  EXPECT_NE(message.find("4000 grains do not fit"), std::string::npos) << message;
  EXPECT_NE(message.find(" did;"), std::string::npos) << message;
}

}  // namespace
}  // namespace thalweg::beds::packing_test
