#include "driver/check_report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::driver {
namespace {

// Water over glass spheres (2550 kg/m^3) of diameter d in a box that leaves `depth` above the settled bed.
Case water_over_glass(double d, double slope, double depth, double width, FaceType sides) {
  Case c;
  c.system = SystemKind::resolved;
  c.fluid.density = 1000.0;
  c.fluid.kinematic_viscosity = 1e-6;
  c.fluid.time_step = 2e-5;
  c.gravity.magnitude = 9.8;
  c.gravity.slope = slope;
  PopulationCase grains;
  grains.count = 1000;
  grains.diameter = d;
  grains.density = 2550.0;
  c.grains = {grains};
  const double length = 24.0 * d;
  const double bed = 1000.0 * std::numbers::pi / 6.0 * d * d * d / (FlowNumbers::settled_fraction * length * width);
  c.domain.size = Vec3(length, width, bed + depth);
  c.domain.spacing = 5e-4;
  for (const FaceIndex face : {x_low, x_high}) c.domain.faces[face].type = FaceType::periodic;
  for (const FaceIndex face : {y_low, y_high}) c.domain.faces[face].type = sides;
  c.domain.faces[top].type = FaceType::free_slip;
  c.contact.restitution = 0.93;
  c.run.until = 30.0;
  return c;
}

// The parameters of Zhang et al. 2022; the expected numbers are theirs, to the digits printed.
TEST(FlowNumbers, OfTheWideBed) {
  const FlowNumbers flow = flow_numbers(water_over_glass(5e-3, 0.016, 0.0412, 0.040, FaceType::periodic));
  EXPECT_FALSE(flow.side_walls);
  EXPECT_NEAR(flow.slope, 0.016, 1e-15);
  EXPECT_NEAR(flow.depth, 0.0412, 1e-12);
  EXPECT_NEAR(flow.shields_depth, 0.085, 5e-4);
  EXPECT_NEAR(flow.shields_hydraulic, flow.shields_depth, 1e-15);
  EXPECT_NEAR(flow.galileo, 1378.0, 0.5);
  EXPECT_NEAR(flow.density_ratio, 2.55, 1e-12);
  EXPECT_NEAR(flow.friction_velocity, 0.080, 5e-4);
  EXPECT_NEAR(flow.particle_reynolds, flow.friction_velocity * 5e-3 / 1e-6, 1e-9);
  EXPECT_NEAR(flow_numbers(water_over_glass(8e-3, 0.016, 0.0659, 0.064, FaceType::periodic)).galileo, 2789.0, 0.5);
}

TEST(FlowNumbers, OfTheFlumeWithSideWalls) {
  for (const FaceType wall : {FaceType::no_slip, FaceType::law_of_the_wall}) {
    const FlowNumbers flow = flow_numbers(water_over_glass(4.95e-3, 0.0748, 0.0594, 0.0105, wall));
    EXPECT_TRUE(flow.side_walls);
    EXPECT_NEAR(flow.shields_hydraulic, 0.047, 1e-4);  // S is printed with three digits
    EXPECT_NEAR(flow.shields_depth / flow.shields_hydraulic, (2.0 * 59.4 + 10.5) / 10.5, 1e-9);
  }
}

TEST(FlowNumbers, AreMissingWithoutAFlow) {
  Case still = water_over_glass(5e-3, 0.0, 0.04, 0.04, FaceType::periodic);
  EXPECT_TRUE(std::isnan(flow_numbers(still).shields_depth));
  EXPECT_FALSE(std::isnan(flow_numbers(still).galileo));
  still.grains.clear();
  EXPECT_TRUE(std::isnan(flow_numbers(still).galileo));
}

TEST(Cost, CountsCellsAndSteps) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, FaceType::periodic);
  c.domain.size = Vec3(0.120, 0.040, 0.106);
  const Cost cost = cost_of(c, 10e9);
  EXPECT_EQ(cost.cells, 240.0 * 80.0 * 212.0);
  EXPECT_EQ(cost.steps, 1.5e6);  // 30 s of 2e-5 s
  EXPECT_EQ(cost.cell_updates, cost.cells * 1.5e6);
  EXPECT_EQ(cost.grain_steps, 1000.0 * 50.0 * 1.5e6);
  // At least 19 single-precision values a cell, and not more than twice that with flags and the links of 1000 grains.
  EXPECT_GT(cost.memory, cost.cells * 19 * 4);
  EXPECT_LT(cost.memory, cost.cells * 19 * 4 * 2);
  const Cost on_faster_memory = cost_of(c, 20e9);
  EXPECT_LT(on_faster_memory.core_seconds, cost.core_seconds);
  EXPECT_GT(on_faster_memory.core_seconds, 0.5 * cost.core_seconds);  // the grains do not get faster
}

}  // namespace
}  // namespace thalweg::driver
