// The height of beds whose volume below each height is known.
#include "analysis/bed/bed_height.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace thalweg::analysis::bed_height_test {
namespace {

TEST(BedHeight, OfAUniformBlockIsItsTop) {
  std::vector<double> below;
  for (int k = 0; k <= 100; ++k) below.push_back(0.6 * 2.0 * 0.1 * std::min(k, 43));  // 0.6 of 2 m^2 up to 4.3 m
  const VolumeBelow block{below, 0.1, 2.0};
  EXPECT_NEAR(bulk_solid_fraction(block), 0.6, 1e-12);
  EXPECT_NEAR(bed_height(block, 5), 4.3, 1e-12);
  const std::vector<double> nothing(101, 0.0);
  EXPECT_EQ(bed_height({nothing, 0.1, 2.0}, 5), 0.0);
}

// The same bed around a block of half its height that takes half of its plan: R = 1 m^2 up to 2 m, then 2 m^2.
TEST(BedHeight, LeavesObstaclesOut) {
  std::vector<double> grains, block;
  for (int k = 0; k <= 100; ++k) {
    block.push_back(0.1 * std::min(k, 20));
    grains.push_back(0.6 * (2.0 * 0.1 * std::min(k, 43) - block.back()));
  }
  EXPECT_NEAR(bulk_solid_fraction({grains, 0.1, 2.0, block}), 0.6, 1e-12);
  EXPECT_NEAR(bed_height({grains, 0.1, 2.0, block}, 5), 4.3, 1e-12);
  // One that reaches through the bed to the top leaves both as they are.
  for (int k = 0; k <= 100; ++k) {
    block[static_cast<std::size_t>(k)] = 0.1 * k;
    grains[static_cast<std::size_t>(k)] = 0.6 * 0.1 * std::min(k, 43);
  }
  EXPECT_NEAR(bulk_solid_fraction({grains, 0.1, 2.0, block}), 0.6, 1e-12);
  EXPECT_NEAR(bed_height({grains, 0.1, 2.0, block}, 5), 4.3, 1e-12);
}

}  // namespace
}  // namespace thalweg::analysis::bed_height_test
