#include "driver/bed/bed_flow.hpp"
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

// Grains that are held in a region reach up to its top, whatever their solid fraction; those that settle on them make
// the bed higher by their own height.
TEST(FlowNumbers, KnowThatHeldGrainsStayWhereTheyAre) {
  constexpr double d = 5e-3;
  Case c = water_over_glass(d, 0.016, 0.06, 0.040, lbm::FaceType::periodic);
  const double settled = settled_height(c), area = c.domain.size.x() * c.domain.size.y();
  const auto region = [&](double height) {
    return beds::RegionKeys{Vec3::Zero(), Vec3(c.domain.size.x(), c.domain.size.y(), height)};
  };
  Case held = c;
  held.grains[0].fixed = true;
  held.grains[0].placement.region = region(1.5 * settled);
  EXPECT_NEAR(settled_height(held), 1.5 * settled, 0.2 * d);
  EXPECT_NEAR(flow_numbers(held).depth, held.domain.size.z() - settled_height(held), 1e-12);

  Case layer = c;  // one of 24 x 8 beneath the bed: its surface is where half of it is above, 0.89 d
  layer.grains.push_back(c.grains[0]);
  layer.grains[1].count = 24 * 8;
  layer.grains[1].fixed = true;
  layer.grains[1].placement.region = region(d);
  EXPECT_NEAR(settled_height(layer) - settled, 0.89 * d, 0.02 * d);

  Case apart = layer;  // too few to bear a bed, which they thicken
  apart.grains[1].count = 24;
  const double volume = (1000.0 + 24.0) * std::numbers::pi / 6.0 * d * d * d;
  EXPECT_NEAR(settled_height(apart), volume / (0.6 * area), 1e-9);
  apart.grains.erase(apart.grains.begin());
  EXPECT_EQ(settled_height(apart), 0.0);
}

// A bed file has no region: its grains have the heights of a slab with the same mean and deviation.
TEST(FlowNumbers, KnowHowHighHeldGrainsOfAFileReach) {
  constexpr double d = 5e-3, height = 0.03;
  Case c = water_over_glass(d, 0.016, 0.06, 0.040, lbm::FaceType::periodic);
  beds::Population& grains = c.grains[0];
  grains.fixed = true;
  grains.figures.rows = grains.count = 1000;
  grains.figures.volume = 1000.0 * std::numbers::pi / 6.0 * d * d * d;
  grains.figures.sizes = {{d, 1000}};
  grains.figures.mean_height = 0.5 * height;
  grains.figures.height_deviation = std::sqrt((height * height - 0.6 * d * d) / 12.0);  // less that of a sphere
  EXPECT_NEAR(settled_height(c), height, 0.2 * d);
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
