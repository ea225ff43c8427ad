// Populations whose number follows from the depth of their settled bed.
#include "beds/sizes/size_distribution.hpp"
#include "core/base/error.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/input/case_reader.hpp"
#include "tests/driver/case_texts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::driver::grain_fill_test {
namespace {

using testing::flume;
using testing::message_of;

// The first population of the flume, without its number.
Case read(std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(), "grains.0.count=null");
  return testing::read_text(flume, overrides);
}

std::int64_t count(const std::vector<std::string>& overrides) { return read(overrides).grains[0].count; }

// Solid fraction between walls 10.5 mm apart, of grains of this diameter (m).
double fraction(double diameter) { return 0.6 * (1.0 - diameter / (3.0 * 0.0105)); }

// Between near walls 0.5057 of 0.02 m over the floor of 0.06 x 0.0105 m, of spheres 4.95 mm wide: 100.34 of them.
TEST(GrainFill, ADepthGivesTheNumberOfGrains) {
  EXPECT_EQ(count({"grains.0.fill={depth: 0.02}"}), 100);
  EXPECT_EQ(count({"grains.0.fill={depth: 0.02, porosity: 0.45}"}), 109);  // 109.12
  // A region that stands on half of the floor.
  EXPECT_EQ(count({"grains.0.fill={depth: 0.02}", "grains.0.placement.region.upper=[0.03, 0.0105, 0.05]"}),
            50);  // 50.17
}

TEST(GrainFill, LayersAreDeepAsManyDiameters) {
  EXPECT_EQ(count({"grains.0.fill={layers: 4}"}), 99);  // of 0.0198 m: 99.33
  EXPECT_EQ(count({"grains.0.fill={layers: 4}", "analysis.reference_diameter=4e-3"}),
            83);                                                          // of 0.016 m, 0.5238 of it: 83.14
  EXPECT_EQ(count({"grains.0.fill={layers: 2.5, porosity: 0.45}"}), 68);  // of 0.012375 m: 67.52
}

// The bed that check expects is as deep as the fill, whatever its porosity and wherever the walls are.
TEST(GrainFill, TheBedSettlesToItsDepth) {
  const double a_grain =
      0.02 / 73.0;  // of the bed of fewest; two are fixed above it, and half of one is lost in rounding
  for (const char* fill : {"grains.0.fill={depth: 0.02}", "grains.0.fill={depth: 0.02, porosity: 0.6}"})
    for (const char* sides : {"domain.boundaries.y=no_slip", "domain.boundaries.y=periodic"})
      EXPECT_NEAR(settled_height(read({fill, sides})), 0.02, 2.5 * a_grain) << fill << sides;
}

// The volume of the bed is that of the depth to within half a grain, and layers go by the median by mass.
TEST(GrainFill, MixedSizesFillTheSameDepth) {
  const std::string sizes =
      "grains.0.diameter={distribution: lognormal, median: 4.0e-3, geometric_deviation: 1.3, minimum: 3e-3, maximum: "
      "6e-3}";
  const Case deep = read({sizes, "grains.0.fill={depth: 0.02}"}), layers = read({sizes, "grains.0.fill={layers: 4}"});
  const double floor = 0.06 * 0.0105, largest = beds::sphere_volume(6e-3);
  EXPECT_NEAR(deep.grains[0].volume(), fraction(deep.grains[0].diameter) * 0.02 * floor, largest);
  EXPECT_NEAR(layers.grains[0].volume(), fraction(layers.grains[0].diameter) * 4.0 * layers.grains[0].diameter * floor,
              largest);
}

TEST(GrainFill, EveryPopulationHasItsShare) {
  const std::string two =
      "grains=[{fill: {depth: 0.01}, diameter: 4e-3, density: 2550}, {fill: {layers: 2}, diameter: 5e-3, density: "
      "2550}]";
  const Case c = testing::read_text(flume, {two});
  EXPECT_EQ(c.grains[0].count, 98);  // 98.48
  EXPECT_EQ(c.grains[1].count, 49);  // 48.58, of 0.0100 m
}

TEST(GrainFill, DisksCountByTheirArea) {
  const Case c =
      testing::read_text(defaults_yaml("grains"), {"disks={thickness: 4e-3}", "domain.boundaries.y=periodic",
                                                   "grains=[{fill: {depth: 0.02}, diameter: 5e-3, density: 2550}]"});
  EXPECT_EQ(c.grains[0].count, 49);  // 0.8 of 0.06 x 0.02 m, 48.9
}

TEST(GrainFill, ClumpsCountByTheirVolume) {
  const Case c = testing::read_text(
      flume, {"grains=[{shape: {clump: [{position: [0, 0, 0], diameter: 4.0e-3}, {position: [0, 0, 2.0e-3], diameter: "
              "4.0e-3}]}, density: 2500, fill: {depth: 0.02}, placement: {pattern: dense}}]"});
  const double volume = (8.0 / 3.0 - 5.0 / 12.0) * std::numbers::pi * 8e-9;  // of the union of two spheres
  EXPECT_EQ(c.grains[0].count, std::llround(fraction(c.grains[0].diameter) * 0.02 * 0.06 * 0.0105 / volume));
}

// The case as run has the number itself, so that nothing can change it at a restart.
TEST(GrainFill, TheCaseAsRunHasTheNumber) {
  const Case c = read({"grains.0.fill={layers: 4}"});
  EXPECT_EQ(testing::read_text(resolved_yaml(c)), c) << resolved_yaml(c);
  EXPECT_NE(resolved_yaml(c).find("count: 99"), std::string::npos);
  EXPECT_EQ(resolved_yaml(c).find("    fill:"), std::string::npos);
}

TEST(GrainFill, Refusals) {
  const auto refused = [](const std::vector<std::string>& overrides) {
    return message_of<InputError>([&] { testing::read_text(flume, overrides); });
  };
  const std::string no_count = "grains.0.count=null";
  EXPECT_NE(refused({"grains.0.fill={depth: 0.02}"}).find("count or solid_fraction gives the number"),
            std::string::npos);
  EXPECT_NE(refused({no_count}).find("give a whole number, for example 100, solid_fraction, fill or"),
            std::string::npos);
  EXPECT_NE(refused({no_count, "grains.0.fill={}"}).find("give either the depth in m or the number of layers"),
            std::string::npos);
  EXPECT_NE(
      refused({no_count, "grains.0.fill={depth: 0.02, layers: 2}"}).find("grains.0.fill.depth = 0.02: give either"),
      std::string::npos);
  EXPECT_NE(refused({no_count, "grains.0.fill={depth: 0.06}"})
                .find("grains.0.fill.depth = 0.06: a bed of 0.06 m is deeper than its region of 0.05 m; give at most "
                      "0.05 m, or a higher region"),
            std::string::npos);
  EXPECT_NE(refused({no_count, "grains.0.fill={layers: 11}"}).find("at most 10.1 layers of 0.00495 m"),
            std::string::npos);
  EXPECT_NE(refused({no_count, "grains.0.fill={depth: 0.02, porosity: 1}"}).find("below 1"), std::string::npos);
  EXPECT_NE(refused({no_count, "grains.0.fill={depth: 0.02}", "grains.0.diameter=1e-7"})
                .find("grains.0.fill.depth = 0.02: it takes"),
            std::string::npos);
}

}  // namespace
}  // namespace thalweg::driver::grain_fill_test
