#include "dem/motion/cell_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>

namespace thalweg::dem::cell_grid_test {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Vec3> cloud(int count, const Vec3& lower, const Vec3& upper, const PeriodicBox& box, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<Vec3> points;
  for (int n = 0; n < count; ++n) {
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = lower[axis] + share(random) * (upper[axis] - lower[axis]);
      if (box.periodic[axis]) point[axis] -= box.size[axis] * std::floor(point[axis] / box.size[axis]);
    }
    points.push_back(point);
  }
  return points;
}

double distance_between(const Vec3& a, const Vec3& b, const PeriodicBox& box) {
  Vec3 apart = a - b;
  for (int axis = 0; axis < 3; ++axis)
    if (box.periodic[axis]) apart[axis] -= box.size[axis] * std::round(apart[axis] / box.size[axis]);
  return apart.norm();
}

// Every pair within the distance is found, and none is visited twice. Returns the number of pairs visited.
std::size_t expect_all_pairs(const PeriodicBox& box, double distance, const std::vector<Vec3>& points) {
  const CellGrid grid(box, distance, points);
  std::set<Pair> visited;
  std::size_t visits = 0;
  grid.for_each_near_pair([&](std::uint32_t m, std::uint32_t n) {
    const auto [low, high] = std::minmax(grid.order()[m], grid.order()[n]);
    visited.insert({low, high});
    ++visits;
  });
  EXPECT_EQ(visits, visited.size()) << "a pair was visited twice";
  for (std::uint32_t a = 0; a < points.size(); ++a)
    for (std::uint32_t b = a + 1; b < points.size(); ++b)
      EXPECT_TRUE(distance_between(points[a], points[b], box) >= distance || visited.contains({a, b}))
          << a << " and " << b;
  return visits;
}

TEST(CellGrid, FindsAllPairsInAFullBox) {
  for (const bool periodic : {true, false})
    for (const double size : {1.2, 2.5, 3.5, 6.0}) {
      const PeriodicBox box{Vec3(size, 4.0, size), {periodic, periodic, false}};
      expect_all_pairs(box, 1.0, cloud(200, Vec3(0, 0, 0), box.size, box, 1));
    }
}

// Points as on a rank whose block is a corner of the box: on both sides of the periodic faces.
TEST(CellGrid, FindsAllPairsAcrossPeriodicFaces) {
  const PeriodicBox box{Vec3(40.0, 30.0, 20.0), {true, true, false}};
  for (unsigned seed = 1; seed <= 5; ++seed) {
    expect_all_pairs(box, 1.0, cloud(200, Vec3(-2, -2, 3), Vec3(2, 2, 6), box, seed));
    expect_all_pairs(box, 1.0, cloud(200, Vec3(17, -1.5, 0), Vec3(21, 1.5, 2), box, seed));
    expect_all_pairs(box, 1.0, cloud(200, Vec3(-1, 0, 18), Vec3(0.4, 30, 20), box, seed));  // the whole of one axis
  }
  EXPECT_EQ(expect_all_pairs(box, 1.0, {}), 0u);
  EXPECT_EQ(expect_all_pairs(box, 1.0, {Vec3(39.9, 1.0, 1.0)}), 0u);
  EXPECT_EQ(expect_all_pairs(box, 1.0, {Vec3(39.9, 1.0, 1.0), Vec3(0.1, 1.0, 1.0)}), 1u);
}

TEST(CellGrid, PointsBeyondAFaceCountToItsCells) {
  const PeriodicBox box{Vec3(10.0, 10.0, 10.0), {true, true, false}};
  expect_all_pairs(box, 1.0, cloud(200, Vec3(4, 4, -1), Vec3(6, 6, 1), box, 1));
}

// A position that has blown up is somebody else's to report; the pairs of the other points are found.
TEST(CellGrid, TakesPointsThatAreNotNumbers) {
  const PeriodicBox box{Vec3(10.0, 10.0, 10.0), {true, true, false}};
  std::vector<Vec3> points = cloud(100, Vec3(0, 0, 0), Vec3(4, 4, 4), box, 1);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity})
    points.push_back(Vec3(value, 1.0, value));
  const CellGrid grid(box, 1.0, points);
  std::set<Pair> visited;
  grid.for_each_near_pair([&](std::uint32_t m, std::uint32_t n) {
    const auto [low, high] = std::minmax(grid.order()[m], grid.order()[n]);
    visited.insert({low, high});
  });
  for (std::uint32_t a = 0; a < 100; ++a)
    for (std::uint32_t b = a + 1; b < 100; ++b)
      EXPECT_TRUE(distance_between(points[a], points[b], box) >= 1.0 || visited.contains({a, b})) << a << " and " << b;
}

// The work depends on the points, not on how large the box is of which a rank has a block.
TEST(CellGrid, VisitsNoMorePairsInALargerBox) {
  const Vec3 lower(0.0, 0.0, 0.0), upper(8.0, 8.0, 8.0);
  const PeriodicBox small{Vec3(8.0, 8.0, 8.0), {false, false, false}};
  const PeriodicBox large{Vec3(800.0, 800.0, 8.0), {true, true, false}};
  const std::size_t alone = expect_all_pairs(small, 1.0, cloud(1000, lower, upper, small, 1));
  const std::size_t within = expect_all_pairs(large, 1.0, cloud(1000, lower, upper, large, 1));
  EXPECT_NEAR(static_cast<double>(within), static_cast<double>(alone), 0.2 * static_cast<double>(alone));
}

}  // namespace
}  // namespace thalweg::dem::cell_grid_test
