#include "driver/estimate/drag_accuracy.hpp"

#include "driver/estimate/flow_estimate.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace thalweg::driver::drag_accuracy_test {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(DragText, IsOfTheFinestGrainsAtTheirOwnSpeed) {
  Case c = wide_bed();
  EXPECT_TRUE(contains(drag_text(c), "at 10 cells and a Reynolds number of")) << drag_text(c);
  EXPECT_FALSE(contains(drag_text(c), "finest"));
  c.grains.push_back(c.grains.front());
  c.grains[1].diameter = 3e-3;
  const double reynolds = settling_velocity(3e-3, 2.55, 9.8, 1e-6) * 3e-3 / 1e-6;
  EXPECT_NEAR(reynolds, 0.385 * 3e3, 0.05 * 0.385 * 3e3);  // sqrt(4/3 1.55 g d/0.42)
  const std::string of_finest =
      fmt::format("at 6 cells and a Reynolds number of {:.4g} of the finest grains", reynolds);
  EXPECT_TRUE(contains(drag_text(c), of_finest)) << drag_text(c);
  c.grains.push_back(c.grains.front());
  c.grains[2].diameter = 1e-3;
  c.grains[2].fixed = true;  // a rough floor does not settle
  EXPECT_TRUE(contains(drag_text(c), of_finest)) << drag_text(c);
}

// In clear water by the speed of the flow and the width of the solid.
TEST(DragText, IsOfTheThinnestSolidInClearWater) {
  Case c = wide_bed();
  c.system = SystemKind::fluid;
  c.grains.clear();
  EXPECT_EQ(drag_text(c), "");
  c.solids.resize(2);
  c.solids[0].sphere = SphereCase{{0.02, 0.02, 0.02}, 5e-3};
  c.solids[1].sphere = SphereCase{{0.02, 0.02, 0.06}, 3e-3};
  const double reynolds = flow_estimate(c).speed * 6e-3 / 1e-6;
  EXPECT_TRUE(contains(drag_text(c), fmt::format("at 12 cells and a Reynolds number of {:.4g} of solids.1", reynolds)))
      << drag_text(c);
  c.gravity.slope = 0.0;
  EXPECT_EQ(drag_text(c), "");  // nothing flows past it
}

}  // namespace
}  // namespace thalweg::driver::drag_accuracy_test
