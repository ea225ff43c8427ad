// The flow that a case asks for by Shields number and depth is the flow that its numbers then have.
#include "driver/bed/bed_flow.hpp"
#include "tests/driver/case_texts.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::driver::derived_flow_test {
namespace {

// A bed of 230 grains whose box, slope, step and start are left open.
const std::string open_flume = R"(system: resolved
domain:
  size: [0.0594, 0.010725]
  spacing: 0.825e-3
  boundaries: {x: periodic, y: law_of_the_wall, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6}
gravity: {magnitude: 9.8}
flow: {shields_number: 0.05, depth: 0.03}
grains:
  - {count: 230, diameter: 4.95e-3, density: 2550, placement: {pattern: dense}}
initial: {fluid: {log_profile: {}}}
contact: {restitution: 0.93}
run: {until: 2}
)";

Case read(const std::vector<std::string>& overrides = {}) { return testing::read_text(open_flume, overrides); }

std::string refusal_of(const std::vector<std::string>& overrides) {
  return testing::message_of<InputError>([&] { read(overrides); });
}

// Zhang et al. 2022: tau* = g sin(alpha) R/((s - 1) g d), R = H W/(2 H + W) between two side walls and H without.
double shields_number(const Case& c, double depth, int walls) {
  const double width = c.domain.size.y(), radius = walls == 0 ? depth : depth * width / (walls * depth + width);
  return std::sin(std::atan(*c.gravity.slope)) * radius / (1.55 * 4.95e-3);
}

// Between walls W apart grains settle to a solid fraction of 0.6 (1 - d/(3 W)).
const double bed =
    230.0 * M_PI / 6.0 * std::pow(4.95e-3, 3) / (0.0594 * 0.010725) / (0.6 * (1.0 - 4.95 / (3.0 * 10.725)));

TEST(DerivedFlow, SlopeAndHeightFollowFromShieldsNumberAndDepth) {
  for (const int walls : {0, 1, 2})
    for (const double shields : {0.01, 0.05, 0.2})
      for (const double depth : {0.005, 0.03, 0.1}) {
        const std::string y = walls == 0 ? "domain.boundaries.y=free_slip"
                              : walls == 2
                                  ? "domain.boundaries.y=law_of_the_wall"
                                  : "domain.boundaries={x: periodic, y_low: law_of_the_wall, y_high: free_slip, "
                                    "bottom: no_slip, top: free_slip}";
        const Case c = read({y, "flow.shields_number=" + std::to_string(shields), "flow.depth=" + std::to_string(depth),
                             "fluid.time_step=1e-5"});
        const double of_box = c.domain.size.z() - bed;
        EXPECT_NEAR(of_box, depth, 0.5 * c.domain.spacing * (1.0 + 1e-6));
        EXPECT_NEAR(shields_number(c, of_box, walls), shields, 1e-5 * shields);
        EXPECT_NEAR(flow_numbers(c).shields_hydraulic, shields, 1e-5 * shields);
      }
}

// Between bed and lid the stress falls linearly to nothing half way up: each holds half of the water, tau* = g
// sin(alpha) R/((s - 1) g d) with R = h W/(n h + W) of the half h.
TEST(DerivedFlow, ALidHoldsHalfOfTheFlow) {
  for (const std::string y : {"free_slip", "law_of_the_wall"}) {
    const std::string lid = "domain.boundaries={x: periodic, y: " + y + ", bottom: no_slip, top: no_slip}";
    const int walls = y == "free_slip" ? 0 : 2;
    const Case c = read({lid});
    const double half = 0.5 * (c.domain.size.z() - bed);
    EXPECT_NEAR(half, 0.015, 0.25 * c.domain.spacing * (1.0 + 1e-6));
    EXPECT_NEAR(shields_number(c, half, walls), 0.05, 5e-7);
    EXPECT_NEAR(flow_numbers(c).shields_hydraulic, 0.05, 5e-7);
    const Case deep = read({lid, "flow.depth=null", "gravity.slope=0.1"});
    const double depth = deep.domain.size.z() - bed, half_a_cell = 0.5 * c.domain.spacing;
    EXPECT_LE(shields_number(deep, 0.5 * (depth - half_a_cell), walls), 0.05);
    EXPECT_GE(shields_number(deep, 0.5 * (depth + half_a_cell), walls), 0.05);
  }
}

// 0.0594 m over 0.825 m.
TEST(DerivedFlow, AsksForCellsThatFitTheBoxBeforeTheHeightFollows) {
  EXPECT_NE(refusal_of({"domain.spacing=0.825"}).find("the 0.0594 m along x are 0.072 cells of 0.825 m"),
            std::string::npos)
      << refusal_of({"domain.spacing=0.825"});
}

TEST(DerivedFlow, TheSlopeFollowsInABoxOfGivenHeight) {
  const Case c = read({"domain.size=[0.0594, 0.010725, 0.0825]", "flow.depth=null"});
  EXPECT_NEAR(shields_number(c, 0.0825 - bed, 2), 0.05, 5e-7);
}

TEST(DerivedFlow, TheDepthFollowsFromSlopeAndShieldsNumber) {
  const Case c = read({"flow.depth=null", "gravity.slope=0.1"});
  const double depth = c.domain.size.z() - bed, half_a_cell = 0.5 * c.domain.spacing;
  EXPECT_LE(shields_number(c, depth - half_a_cell, 2), 0.05);
  EXPECT_GE(shields_number(c, depth + half_a_cell, 2), 0.05);
}

TEST(DerivedFlow, TheHeightFollowsFromTheDepthAlone) {
  const Case c = read({"flow.shields_number=null", "gravity.slope=0.02"});
  EXPECT_NEAR(c.domain.size.z() - bed, 0.03, 0.5 * c.domain.spacing * (1.0 + 1e-6));
  EXPECT_EQ(*c.gravity.slope, 0.02);
}

// u(z) = u_tau/0.41 ln((z - bed)/z_0) with u_tau^2 = g sin(alpha) R and z_0 = d/15.
TEST(DerivedFlow, TheProfileAtTheStartIsThatOfTheFlow) {
  const Case c = read();
  const coupling::LogProfileKeys& profile = *c.initial.fluid.log_profile;
  EXPECT_NEAR(*profile.bed_height, bed, 1e-9);
  EXPECT_NEAR(std::pow(*profile.shear_velocity, 2), 0.05 * 1.55 * 9.8 * 4.95e-3, 1e-3 * std::pow(0.06, 2));
  EXPECT_NEAR(*profile.roughness, 4.95e-3 / 15.0, 1e-12);
  EXPECT_EQ(*read({"initial.fluid.log_profile.shear_velocity=0.03"}).initial.fluid.log_profile->shear_velocity, 0.03);
}

TEST(DerivedFlow, TheCaseIsKeptAsItRuns) {
  const Case c = read();
  const std::string kept = resolved_yaml(c);
  EXPECT_EQ(kept.find("shields_number"), std::string::npos);
  EXPECT_EQ(testing::read_text(kept), c) << kept;
}

TEST(DerivedFlow, RefusesMoreOrLessThanOneFlow) {
  const auto refused = [](const std::vector<std::string>& overrides, const std::string& reason) {
    const std::string said = refusal_of(overrides);
    EXPECT_NE(said.find(reason), std::string::npos) << said;
  };
  refused({"flow.depth=null"}, "the height is missing");
  refused({"gravity.slope=0.1"}, "it follows from flow.shields_number and flow.depth");
  refused({"domain.size=[0.0594, -1e-300]"}, "expected numbers in m above 0");
  refused({"domain.size=[0.0594, 0.010725, 0.0825]"}, "the box has a height already");
  refused({"domain.size=[0.0594, 0.010725, 0.0825]", "flow.depth=null", "gravity.slope=0.1"},
          "it follows from flow.shields_number; remove one of the two");
  refused({"gravity={vector: [0.1, 0, -9.8]}"}, "the section flow sets the slope");
  refused({"domain.boundaries.x=no_slip"}, "walls close the box along x");
  refused({"flow.shields_number=2"}, "no slope gives it");
  refused({"flow.depth=null", "gravity.slope=0.002"}, "however deep the water");
  refused({"grains.0.density=900"}, "no heavier than the fluid");
  refused({"grains.0.count=null", "grains.0.solid_fraction=0.3"}, "cannot give their number");
  refused({"domain.size=[0.0594, 0.010725, 0.033]", "flow.depth=null"}, "fills the box");
  refused({"system=fluid"}, "flow");
  refused({"flow={}"}, "the section is empty");
}

// What follows stands at the place of what was given: --set domain.size is said only where it was.
TEST(DerivedFlow, SaysThePlaceOfWhatWasGiven) {
  EXPECT_EQ(refusal_of({"domain.spacing=0.00032"}).find("--set"), std::string::npos);
  EXPECT_NE(refusal_of({"domain.spacing=0.00032"}).find("domain.size = [0.0594, 0.010725]: "), std::string::npos);
  EXPECT_NE(refusal_of({"domain.size=[0.0594, 0.0108]"}).find("--set domain.size=[0.0594, 0.0108]: "),
            std::string::npos);
}

TEST(DerivedFlow, RefusesFlowsThatDoNotFollowFromASlope) {
  const auto refused = [](const std::vector<std::string>& overrides, const std::string& reason) {
    const std::string said = refusal_of(overrides);
    EXPECT_NE(said.find(reason), std::string::npos) << said;
  };
  for (const std::string slope : {"0", "-0.01"})
    refused({"flow.depth=null", "gravity.slope=" + slope}, "give a slope above 0");
  const std::string inlet =
      "domain.boundaries={x_low: {type: velocity_inlet, velocity: [0.2, 0, 0]}, x_high: pressure_outlet, y: periodic, "
      "bottom: no_slip, top: free_slip}";
  refused({inlet}, "an inlet across x sets how much flows");
  refused({"domain.boundaries.bottom=periodic", "domain.boundaries.top=periodic"}, "has no bed");
  refused({"gravity.magnitude=0"}, "the grains make no bed");
}

}  // namespace
}  // namespace thalweg::driver::derived_flow_test
