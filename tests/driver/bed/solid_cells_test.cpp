#include "driver/bed/solid_cells.hpp"

#include "tests/driver/case_texts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace thalweg::driver::solid_cells_test {
namespace {

// A box of 40 x 20 x 20 cells of 1 mm with a round stone at x = 30 mm, half-way between the walls.
Case with_stone(double height, double radius) {
  Case c = testing::read_text(testing::channel);
  SolidCase stone;
  stone.sphere = SphereCase{Vec3(0.030, 0.010, height), radius};
  c.solids = {stone};
  return c;
}

TEST(SolidCells, OpenABoxDownToTheFloorBesideASolidAndToItsTopAboveIt) {
  const Case c = with_stone(0.006, 0.006);
  const SolidCells solids(c);
  EXPECT_EQ(solids.lowest_opening({0.020, 0.0, 0.0}, {0.040, 0.020, 0.020}), 0.0);
  EXPECT_EQ(solids.lowest_opening({0.020, 0.0, 0.0025}, {0.040, 0.020, 0.020}), 0.0025);  // the region begins there
  EXPECT_NEAR(solids.lowest_opening({0.029, 0.009, 0.005}, {0.031, 0.011, 0.020}), 0.012, 1e-12);
  EXPECT_EQ(solids.lowest_opening({0.029, 0.009, 0.005}, {0.031, 0.011, 0.008}),
            std::numeric_limits<double>::infinity());
}

TEST(SolidCells, OfAStoneLeaveAWayThroughTheCornersOfTheBoxUntilItCoversThem) {
  EXPECT_TRUE(SolidCells(with_stone(0.010, 0.012)).opens_along_x(0.0));
  EXPECT_FALSE(SolidCells(with_stone(0.010, 0.0145)).opens_along_x(0.0));
}

// What lies over many periodic boxes covers the cells of one, as often as it likes.
TEST(SolidCells, OfASillOverFiftyBoxesCoverOne) {
  Case c = testing::read_text(testing::channel);
  SolidCase sill;
  sill.stl = "sill.stl";
  for (int n = 0; n < 8; ++n)
    sill.surface.points.emplace_back(n & 1 ? 1.0 : -1.0, n & 2 ? 5e-3 : 0.0, n & 4 ? 1e-2 : 0.0);
  sill.surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                            {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  c.solids = {sill};
  const SolidCells solids(c);
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 20; ++k) EXPECT_EQ(solids.covered({i, j, k}), j < 5 && k < 10) << i << " " << j << " " << k;
}

TEST(SolidCells, LeaveNoneOpenOnceTheCornersOfTheBoxAreCovered) {
  EXPECT_TRUE(SolidCells(testing::read_text(testing::channel)).any_open());
  const double corner = std::sqrt(0.0195 * 0.0195 + 2.0 * 0.0095 * 0.0095);  // m, of the last centre of a cell
  const auto stone = [&](double radius) {
    Case c = with_stone(0.010, radius);
    c.solids.front().sphere->centre.x() = 0.020;
    c.domain.faces[x_low].type = c.domain.faces[x_high].type = lbm::FaceType::no_slip;
    return SolidCells(c);
  };
  EXPECT_TRUE(stone(0.999 * corner).any_open());
  EXPECT_FALSE(stone(1.001 * corner).any_open());
}

}  // namespace
}  // namespace thalweg::driver::solid_cells_test
