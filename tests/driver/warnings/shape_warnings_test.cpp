#include "driver/warnings/shape_warnings.hpp"

#include "driver/warnings/case_warnings.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/driver/text_search.hpp"

#include <gtest/gtest.h>

namespace thalweg::driver::shape_warnings_test {
namespace {

TEST(ShapeWarnings, AClumpThatHardlyFillsItsSurfaceIsNamed) {
  Case c = testing::read_text(
      testing::flume,
      {"grains.0.shape={clump: [{position: [0, 0, 0], diameter: 1.0}, {position: [0.5, 0, 0], diameter: 1.0}]}"});
  const std::string words = "The 2 spheres of grains.0.shape hold only 2.6 % of the surface's volume";
  EXPECT_FALSE(any_contains(warnings(c), "before they grow"));
  c.grains[0].shape->inscribed = 0.026;
  EXPECT_TRUE(any_contains(warnings(c), words));
  c.grains[0].shape->inscribed = 0.51;  // as a single sphere in a cube
  EXPECT_FALSE(any_contains(warnings(c), "before they grow"));
}

}  // namespace
}  // namespace thalweg::driver::shape_warnings_test
