#include "driver/estimate/bed_flow.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::driver::bed_flow_test {
namespace {

// The parameters of Zhang et al. 2022; the expected numbers are theirs, to the digits printed.
TEST(FlowNumbers, OfTheWideBed) {
  const FlowNumbers flow = flow_numbers(water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic));
  EXPECT_FALSE(flow.side_walls);
  EXPECT_NEAR(flow.slope, 0.016, 1e-15);
  EXPECT_NEAR(flow.depth, 0.0412, 1e-12);
  EXPECT_NEAR(flow.shields_depth, 0.085, 5e-4);
  EXPECT_NEAR(flow.shields_hydraulic, flow.shields_depth, 1e-15);
  EXPECT_NEAR(flow.galileo, 1378.0, 0.5);
  EXPECT_NEAR(flow.density_ratio, 2.55, 1e-12);
  EXPECT_NEAR(flow.friction_velocity, 0.080, 5e-4);
  EXPECT_NEAR(flow.particle_reynolds, flow.friction_velocity * 5e-3 / 1e-6, 1e-9);
  EXPECT_NEAR(flow_numbers(water_over_glass(8e-3, 0.016, 0.0659, 0.064, lbm::FaceType::periodic)).galileo, 2789.0, 0.5);
}

TEST(FlowNumbers, OfTheFlumeWithSideWalls) {
  for (const lbm::FaceType wall : {lbm::FaceType::no_slip, lbm::FaceType::law_of_the_wall}) {
    const FlowNumbers flow = flow_numbers(water_over_glass(4.95e-3, 0.0748, 0.0594, 0.0105, wall));
    EXPECT_TRUE(flow.side_walls);
    EXPECT_NEAR(flow.shields_hydraulic, 0.047, 3e-5 + 0.003 * 0.047);  // S has three digits; they take it for the sine
    EXPECT_NEAR(flow.shields_depth / flow.shields_hydraulic, (2.0 * 59.4 + 10.5) / 10.5, 1e-9);
  }
}

// Table of the flume's slopes by hand: S = tau* (s - 1) d (2 H + W)/(H W) with H = 12 d.
TEST(FlowNumbers, GiveTheSlopeForAShieldsNumber) {
  const FlowNumbers flow =
      flow_numbers(water_over_glass(4.95e-3, 0.05, 0.0594, 0.0105, lbm::FaceType::law_of_the_wall));
  EXPECT_NEAR(std::sin(std::atan(slope_for(flow, 0.028))), 0.0445, 5e-5);
  EXPECT_NEAR(std::sin(std::atan(slope_for(flow, 0.068))), 0.1082, 5e-5);
  const FlowNumbers wide = flow_numbers(water_over_glass(5e-3, 0.05, 0.0412, 0.040, lbm::FaceType::periodic));
  EXPECT_NEAR(std::sin(std::atan(slope_for(wide, 0.085))), 0.085 * 1.55 * 5e-3 / 0.0412, 1e-12);
  EXPECT_NEAR(slope_for(wide, wide.shields_hydraulic), wide.slope, 1e-15);
  EXPECT_TRUE(std::isinf(slope_for(wide, 6.0)));  // the sine would be 1.13
}

// The force along the bed is g times the sine: at a slope of 5 a fifth of what the tangent would make of it.
TEST(FlowNumbers, TakeTheSineOfTheSlope) {
  for (const double slope : {0.01, 0.5, 5.0}) {
    const FlowNumbers flow = flow_numbers(water_over_glass(5e-3, slope, 0.0412, 0.040, lbm::FaceType::periodic));
    const double sine = slope / std::sqrt(1.0 + slope * slope);
    EXPECT_NEAR(flow.shields_depth, sine * 0.0412 / (1.55 * 5e-3), 1e-9);
    EXPECT_NEAR(flow.friction_velocity, std::sqrt(9.8 * sine * 0.0412), 1e-9);
    EXPECT_NEAR(flow.slope, slope, 1e-12);
  }
}

// 969 grains in the paper's flume, of two diameters' width, settle to 19.5 to 20 diameters
// (benchmarks/validation/flume), 2884 on its wide bed to 13 (0.6 of the volume is grain).
TEST(FlowNumbers, KnowHowHighABedSettles) {
  Case flume = water_over_glass(4.95e-3, 0.05, 0.06, 0.0105, lbm::FaceType::law_of_the_wall);
  flume.grains.front().count = 969;
  EXPECT_NEAR(flow_numbers(flume).bed_height / 4.95e-3, 19.7, 0.1);
  Case bed = water_over_glass(5e-3, 0.016, 0.06, 0.040, lbm::FaceType::periodic);
  bed.grains.front().count = 2884;
  EXPECT_NEAR(flow_numbers(bed).bed_height / 5e-3, 13.1, 0.05);
  // Dry spheres of friction 0.5 poured between walls (cases/settled_bed), whose porosity far from walls is 0.41 in
  // place of 0.4; two packings differ by up to 0.01.
  for (const auto& [widths, porosity] :
       {std::pair{2.12, 0.493}, {2.5, 0.496}, {3.0, 0.468}, {4.0, 0.459}, {8.0, 0.436}}) {
    flume.domain.size.y() = widths * 4.95e-3;
    EXPECT_NEAR(1.0 - settled_fraction(flume), porosity, 0.02) << widths;
  }
}

// Floating grains do not lie in the bed, and a top that moves drives the water beside the slope.
TEST(FlowNumbers, LeaveOutWhatFloats) {
  Case c = water_over_glass(5e-3, 0.016, 0.06, 0.040, lbm::FaceType::periodic);
  const double height = settled_height(c);
  c.grains.push_back(c.grains.front());
  c.grains.back().density = 900.0;
  EXPECT_NEAR(settled_height(c), height, 1e-12);
  EXPECT_TRUE(std::isfinite(flow_numbers(c).shields_depth));
  c.domain.faces[top].type = lbm::FaceType::moving;
  c.domain.faces[top].velocity = Vec3(0.1, 0.0, 0.0);
  EXPECT_FALSE(std::isfinite(flow_numbers(c).shields_depth));
}

// Disks lie in one layer, as wide as they are thick: 60 of 4 mm on 60 mm, 0.8 of whose plane they cover.
TEST(FlowNumbers, KnowHowHighDisksSettle) {
  Case c = water_over_glass(4e-3, 0.0, 0.05, 0.009, lbm::FaceType::periodic);
  c.domain.size.x() = 0.06;
  c.disks.emplace().thickness = 2e-3;
  c.grains.front().thickness = 2e-3;
  c.grains.front().count = 60;
  EXPECT_NEAR(settled_height(c), 60.0 * std::numbers::pi * 4e-6 / (0.8 * 0.06), 1e-9);
}

// Grains without weight, as in a shear cell, are where they are put.
TEST(FlowNumbers, KnowThatGrainsWithoutWeightDoNotSettle) {
  Case c = water_over_glass(5e-3, 0.0, 0.05, 0.040, lbm::FaceType::periodic);
  EXPECT_GT(settled_height(c), 0.0);
  c.gravity.magnitude = 0.0;
  EXPECT_EQ(settled_height(c), 0.0);
}

TEST(FlowNumbers, AreMissingWithoutAFlow) {
  Case still = water_over_glass(5e-3, 0.0, 0.04, 0.04, lbm::FaceType::periodic);
  EXPECT_TRUE(std::isnan(flow_numbers(still).shields_depth));
  EXPECT_FALSE(std::isnan(flow_numbers(still).galileo));
  still.grains.clear();
  EXPECT_TRUE(std::isnan(flow_numbers(still).galileo));
}

}  // namespace
}  // namespace thalweg::driver::bed_flow_test
