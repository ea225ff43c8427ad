#include "driver/estimate/solid_cells.hpp"

#include "tests/driver/case_texts.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace thalweg::driver::solid_cells_test
