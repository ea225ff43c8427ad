#include "driver/warnings/unit_warnings.hpp"

#include "driver/warnings/case_warnings.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/driver/text_search.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace thalweg::driver::unit_warnings_test {
namespace {

std::vector<std::string> said(const std::vector<std::string>& settings) {
  return warnings(testing::read_text(testing::flume, settings));
}

TEST(UnitWarnings, NameTheReferenceDiameterBesideGrainsInMetres) {
  const std::vector<std::string> found = said({"analysis.reference_diameter=5"});
  EXPECT_TRUE(any_contains(found, "analysis.reference_diameter = 5 m looks like 5 mm"));
  EXPECT_TRUE(any_contains(found, "consider analysis.reference_diameter: 0.005."));
  EXPECT_FALSE(any_contains(found, "The grains are"));
  EXPECT_FALSE(any_contains(said({"analysis.reference_diameter=0.005"}), "looks like"));
}

// The dynamic viscosity of water is 1e-3 Pa s; silicone oil of 970 kg/m^3 and glycerine of 1260 have 1e-3 m^2/s.
TEST(UnitWarnings, TellWaterInPascalSecondsFromOilsAndGlycerine) {
  const auto fluid = [](double density, double viscosity) {
    return said({fmt::format("fluid.density={}", density), fmt::format("fluid.kinematic_viscosity={}", viscosity)});
  };
  EXPECT_TRUE(
      any_contains(fluid(1000.0, 1e-3), "looks like that of water in Pa s, which divided by the density is 1e-06"));
  EXPECT_FALSE(any_contains(fluid(970.0, 1e-3), "in Pa s"));
  EXPECT_FALSE(any_contains(fluid(1260.0, 1e-3), "in Pa s"));
  EXPECT_FALSE(any_contains(fluid(1000.0, 1e-4), "in Pa s"));
  EXPECT_FALSE(any_contains(fluid(1000.0, 8.33e-4), "in Pa s"));  // benchmarks/validation/rotate
}

}  // namespace
}  // namespace thalweg::driver::unit_warnings_test
