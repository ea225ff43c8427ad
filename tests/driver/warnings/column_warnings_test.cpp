#include "driver/warnings/column_warnings.hpp"

#include "driver/warnings/case_warnings.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/driver/text_search.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::driver::column_warnings_test {
namespace {

const std::string column = R"(system: continuum
fluid: {density: 1000, kinematic_viscosity: 1.0e-6}
grains: {diameter: 5.0e-3, density: 2550}
gravity: {magnitude: 9.8, slope: 0.016}
column: {shields_number: 0.085, bed: 5.0}
run: {until: 300, time_step: 5}
)";

std::vector<std::string> said(const std::vector<std::string>& overrides) {
  return warnings(testing::read_text(column, overrides));
}

// tau/p at the floor of a bed of n diameters: tau*/(phi_m n cos) + tan (phi_m rho_s + (1 - phi_m) rho_f)/(phi_m (rho_s
// - rho_f)).
double ratio(double shields, double bed, double slope) {
  const double phi = 0.62, excess = phi * 1550.0;
  return shields / (phi * bed * std::cos(std::atan(slope))) + slope * (excess + 1000.0) / excess;
}

TEST(ColumnWarnings, ABedThatRestsUnderDeepWaterHasNone) {
  EXPECT_LT(ratio(0.085, 5.0, 0.016), 0.37);
  EXPECT_EQ(said({}), std::vector<std::string>{});
}

TEST(ColumnWarnings, ABedThatFlowsToItsFloorIsNamed) {
  const std::vector<std::string> steep = said({"gravity.slope=0.3", "column.shields_number=0.5"});
  ASSERT_EQ(steep.size(), 1u);
  EXPECT_TRUE(contains(steep[0], fmt::format("shear stress is {:.2g} times", ratio(0.5, 5.0, 0.3)))) << steep[0];
  EXPECT_TRUE(contains(steep[0], "begin to flow at 0.37")) << steep[0];
  EXPECT_TRUE(contains(steep[0], "consider gravity.slope: 0.")) << steep[0];
  EXPECT_FALSE(contains(steep[0], "column.bed")) << steep[0];  // no bed is thick enough
  // Just above and below the limit.
  EXPECT_GT(ratio(0.5, 5.0, 0.104), 0.37);
  EXPECT_TRUE(any_contains(said({"gravity.slope=0.104", "column.shields_number=0.5"}), "flows as a whole"));
  EXPECT_LT(ratio(0.5, 5.0, 0.1), 0.37);
  EXPECT_EQ(said({"gravity.slope=0.1", "column.shields_number=0.5"}), std::vector<std::string>{});
}

TEST(ColumnWarnings, AThinBedIsToBeThicker) {
  EXPECT_GT(ratio(1.0, 4.0, 0.016), 0.37);
  EXPECT_LT(ratio(1.0, 5.0, 0.016), 0.37);
  const std::vector<std::string> thin = said({"column.shields_number=1", "column.bed=4"});
  ASSERT_EQ(thin.size(), 1u);
  // 1/(0.62 (0.37 - 0.0326)) = 4.78 diameters.
  EXPECT_TRUE(contains(thin[0], "consider column.bed: 4.8")) << thin[0];
}

// tau* = rho_f sin h/((rho_s - rho_f) d): 0.05 on a slope of 0.1 is 0.779 d.
TEST(ColumnWarnings, ShallowWaterIsNamed) {
  const std::vector<std::string> shallow = said({"gravity.slope=0.1", "column.shields_number=0.05"});
  ASSERT_EQ(shallow.size(), 1u);
  EXPECT_TRUE(contains(shallow[0], "only 0.78 diameters deep")) << shallow[0];
  EXPECT_TRUE(contains(shallow[0], "consider gravity.slope: 0.077, or column.shields_number: 0.0642")) << shallow[0];
  const std::vector<std::string> by_depth = said({"column={depth: 0.004, bed: 5}"});
  ASSERT_EQ(by_depth.size(), 1u);
  EXPECT_TRUE(contains(by_depth[0], "consider column.depth: 0.005")) << by_depth[0];
  EXPECT_EQ(said({"column={depth: 0.005, bed: 5}"}), std::vector<std::string>{});
}

}  // namespace
}  // namespace thalweg::driver::column_warnings_test
