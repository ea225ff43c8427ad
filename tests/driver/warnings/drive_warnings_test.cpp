#include "driver/warnings/drive_warnings.hpp"

#include "driver/bed/bed_flow.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "driver/warnings/case_warnings.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/driver/text_search.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::driver::drive_warnings_test {
namespace {

// A sphere half as heavy again as the water in a box without any wall.
const std::string falling_sphere = R"(system: resolved
name: falling
domain:
  size: [0.0032, 0.0032, 0.0032]
  spacing: 0.0001
  boundaries: {x: periodic, y: periodic, bottom: periodic, top: periodic}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, time_step: 6.666666667e-5, collision: trt, precision: double}
gravity: {vector: [0, 0, -9.81]}
grains: [{density: 1500, diameter: 0.001, placement: {positions: [[0.0016, 0.0016, 0.0016]]}}]
contact: {normal_stiffness: 5, tangential_stiffness: 1.5, restitution: 0.5, friction: 0.3}
coupling: {links: cli, grain_steps_per_fluid_step: auto}
run: {until: 0.4}
)";

std::string only_warning(const Case& c) {
  const std::vector<std::string> found = drive_warnings(c);
  EXPECT_LE(found.size(), 1U);
  return found.empty() ? std::string() : found.front();
}

// (rho_s - rho) V g over the mass of everything.
TEST(DriveWarnings, OfAWeightThatNothingCarries) {
  const double volume = std::numbers::pi / 6.0 * 1e-9, gained = 500.0 * volume * 9.81 / (3.2768e-5 + 500.0 * volume);
  const std::string warning = only_warning(testing::read_text(falling_sphere));
  EXPECT_TRUE(contains(warning, fmt::format("gain {:.3g} m/s each second", gained))) << warning;
  EXPECT_NEAR(gained, 0.0778, 1e-4);
  EXPECT_TRUE(contains(warning, "periodic along z")) << warning;
  EXPECT_TRUE(contains(warning, "consider gravity.mode: balanced.")) << warning;
  EXPECT_EQ(only_warning(testing::read_text(falling_sphere, {"gravity.mode=balanced"})), "");
}

TEST(DriveWarnings, OfNothingWhereAWallOrAGrainHolds) {
  for (const char* held :
       {"domain.boundaries.y=no_slip", "domain.boundaries={x: periodic, y: periodic, bottom: no_slip, top: free_slip}",
        "gravity.vector=[0, 0, 0]", "grains.0.fixed=true"})
    EXPECT_EQ(only_warning(testing::read_text(falling_sphere, {held})), "") << held;
  // A wall that lets the fluid slide past holds nothing.
  EXPECT_TRUE(
      contains(only_warning(testing::read_text(falling_sphere, {"domain.boundaries.y=free_slip"})), "balanced"));
}

TEST(DriveWarnings, NameWallsWhereBalancedGravityIsImpossible) {
  const std::string across = only_warning(testing::read_text(
      falling_sphere,
      {"domain.boundaries.bottom=free_slip", "domain.boundaries.top=free_slip", "gravity.vector=[1, 0, -9]"}));
  EXPECT_TRUE(contains(across, "periodic along x")) << across;
  EXPECT_TRUE(contains(across, "consider domain.boundaries.bottom: no_slip.")) << across;
  EXPECT_EQ(only_warning(testing::read_text(
                falling_sphere,
                {"domain.boundaries.bottom=no_slip", "domain.boundaries.top=free_slip", "gravity.vector=[1, 0, -9]"})),
            "");
}

TEST(DriveWarnings, OfDryGrainsThatFallForEver) {
  Case c;
  c.system = SystemKind::grains;
  c.domain.size = Vec3(0.1, 0.1, 0.1);
  for (coupling::FaceKeys& face : c.domain.faces) face.type = lbm::FaceType::periodic;
  c.gravity.vector = Vec3(0.0, 0.0, -9.8);
  c.grains.resize(1);
  EXPECT_TRUE(contains(only_warning(c), "the grains gain 9.8 m/s each second"));
  c.domain.faces[bottom].type = c.domain.faces[top].type = lbm::FaceType::no_slip;
  EXPECT_EQ(only_warning(c), "");
}

// A closed tank: the slope drives no flow, and there is no Shields number by depth and slope.
TEST(DriveWarnings, OfASlopeBetweenEndWalls) {
  Case c = wide_bed();
  EXPECT_EQ(only_warning(c), "");
  EXPECT_TRUE(std::isfinite(flow_numbers(c).shields_depth));
  c.domain.faces[x_low].type = c.domain.faces[x_high].type = lbm::FaceType::no_slip;
  EXPECT_TRUE(contains(only_warning(c), "consider domain.boundaries.x: periodic, or gravity.slope: 0"))
      << only_warning(c);
  EXPECT_FALSE(std::isfinite(flow_numbers(c).shields_depth));
  EXPECT_EQ(flow_estimate(c).drive, FlowCause::none);
  EXPECT_EQ(estimated_velocity(c), 0.0);
}

TEST(DriveWarnings, OfAFlowUphill) {
  Case c = wide_bed();
  c.gravity.slope = -0.02;
  EXPECT_TRUE(contains(only_warning(c), "consider gravity.slope: 0.02.")) << only_warning(c);
  c.initial.fluid.log_profile.emplace();
  EXPECT_TRUE(contains(only_warning(c), "the log profile at the start"));
  c.gravity.slope.reset();
  c.gravity.magnitude.reset();
  c.gravity.vector = Vec3(-0.2, 0.0, -9.8);
  EXPECT_TRUE(contains(only_warning(c), "consider gravity.vector: [0.2, 0, -9.8].")) << only_warning(c);
}

// All that is measured of a flow is measured along x.
TEST(DriveWarnings, OfAFlowAcross) {
  Case c = wide_bed();
  c.gravity.magnitude.reset();
  c.gravity.slope.reset();
  c.gravity.vector = Vec3(0.1, 0.2, -9.8);
  EXPECT_TRUE(contains(only_warning(c), "drives the flow along y")) << only_warning(c);
  c.gravity.vector = Vec3(0.2, 0.1, -9.8);
  EXPECT_EQ(only_warning(c), "");
}

}  // namespace
}  // namespace thalweg::driver::drive_warnings_test
