#include "driver/estimate/drag_accuracy.hpp"

#include "driver/estimate/flow_estimate.hpp"
#include "driver/estimate/settling.hpp"
#include "tests/driver/text_search.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::driver::drag_accuracy_test {
namespace {

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

// The table of benchmarks/validation/simple_cubic_arrays, and second order beyond it.
TEST(SlowDrag, IsThatOfTheValidation) {
  EXPECT_NEAR(slow_drag_error(10.0, false).among_others, -0.044, 1e-12);
  EXPECT_NEAR(slow_drag_error(7.1, false).alone, 0.5 * (-0.041 - 0.023), 1e-12);
  EXPECT_NEAR(slow_drag_error(40.2, false).among_others, -0.009 / 4.0, 1e-12);
  EXPECT_NEAR(slow_drag_error(5.0, true).alone, -0.017 * 1.44, 1e-12);
}

// The table of benchmarks/validation/sphere_drag_curve, and second order beyond its cells.
TEST(StreamDrag, IsThatOfTheValidation) {
  EXPECT_NEAR(stream_drag_error(10.0, 1000.0), 0.41, 1e-12);
  EXPECT_NEAR(stream_drag_error(20.0, 300.0), 0.05, 1e-12);
  EXPECT_NEAR(stream_drag_error(6.0, 9000.0), 1.29, 1e-12);
  EXPECT_NEAR(stream_drag_error(40.0, 3000.0), 0.102 / 4.0, 1e-12);
  EXPECT_NEAR(stream_drag_error(10.0, std::sqrt(1000.0 * 3000.0)), 0.5 * (0.41 + 0.58), 1e-12);
  EXPECT_NEAR(stream_drag_error(std::sqrt(8.0 * 10.0), 300.0), 0.5 * (0.24 + 0.18), 1e-12);
}

TEST(DragText, DependsOnReynoldsNumberAndSubgridModel) {
  Case c = wide_bed();
  c.fluid.collision = lbm::CollisionModel::trt_at_bodies;
  c.fluid.subgrid_model = lbm::SubgridModel::qr;
  EXPECT_NE(drag_text(c).find("of a grain alone in a stream about 5"), std::string::npos)
      << drag_text(c);  // 41 to 58 %
  c.fluid.subgrid_model.reset();
  c.fluid.smagorinsky_constant = 0.27;
  EXPECT_NE(drag_text(c).find("28 % too slowly"), std::string::npos) << drag_text(c);
  c.fluid.smagorinsky_constant = 0.1;
  EXPECT_NE(drag_text(c).find("14 % too slowly"), std::string::npos) << drag_text(c);
  c.fluid.smagorinsky_constant.reset();
  c.fluid.subgrid_model = lbm::SubgridModel::none;
  EXPECT_NE(drag_text(c).find("not validated"), std::string::npos) << drag_text(c);
  c.fluid.kinematic_viscosity = 1e-3;  // Re 0.5
  EXPECT_NE(drag_text(c).find("off by -1.6 % alone and -4.4 % among others"), std::string::npos) << drag_text(c);
  c.fluid.collision = lbm::CollisionModel::bgk;  // 12 % too large among others at tau = 0.52
  EXPECT_EQ(drag_text(c).find("-4.4 %"), std::string::npos) << drag_text(c);
  EXPECT_NE(drag_text(c).find("depends on the relaxation time"), std::string::npos) << drag_text(c);
  c.grains.clear();
  EXPECT_EQ(drag_text(c), "");
}

}  // namespace
}  // namespace thalweg::driver::drag_accuracy_test
