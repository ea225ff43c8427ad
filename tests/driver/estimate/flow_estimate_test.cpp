#include "driver/estimate/flow_estimate.hpp"

#include "driver/bed/bed_flow.hpp"
#include "driver/estimate/contact_estimate.hpp"
#include "driver/warnings/case_warnings.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/driver/text_search.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::driver::flow_estimate_test {
namespace {

constexpr double d = 5e-3, depth = 0.0412;

Case bed(double slope = 0.016) { return water_over_glass(d, slope, depth, 0.040, lbm::FaceType::periodic); }

TEST(FlowEstimate, OfASlopeIsTheLogLaw) {
  const FlowEstimate flow = flow_estimate(bed());
  const double along = 9.8 * std::sin(std::atan(0.016));
  EXPECT_EQ(flow.cause, FlowCause::slope);
  EXPECT_FALSE(flow.laminar);
  EXPECT_NEAR(flow.speed, 0.94, 0.01);
  EXPECT_NEAR(flow.friction_velocity, std::sqrt(along * depth), 1e-12);
  // The mean of a log law is u_tau/kappa below its largest value.
  EXPECT_NEAR(flow.bulk_velocity, flow.speed - flow.friction_velocity / 0.41, 1e-12);
  EXPECT_NEAR(flow.spin_up, 2.0 * flow.bulk_velocity / along, 1e-12);
}

// Side walls take a share of the force, and make no flow faster.
TEST(FlowEstimate, OfASlopeIsNotFasterBetweenSideWalls) {
  const FlowEstimate wide = flow_estimate(bed());
  for (const lbm::FaceType side : {lbm::FaceType::no_slip, lbm::FaceType::law_of_the_wall}) {
    Case c = bed();
    c.domain.faces[y_low].type = c.domain.faces[y_high].type = side;
    const FlowEstimate flow = flow_estimate(c);
    EXPECT_LT(flow.friction_velocity, wide.friction_velocity);
    EXPECT_LE(flow.speed, wide.speed);
    EXPECT_LE(flow.bulk_velocity, wide.bulk_velocity * (1.0 + 1e-12));
    EXPECT_LE(flow.spin_up, wide.spin_up * (1.0 + 1e-12));
  }
}

// g_x t, and as much more than the start; the friction velocity stays that of the developed flow.
TEST(FlowEstimate, OfASlopeIsNoMoreThanTheRunHasTimeFor) {
  Case c = bed();
  hold_bed(c, depth);  // or water that falling grains push aside would be faster
  const FlowEstimate developed = flow_estimate(c);
  const double along = 9.8 * std::sin(std::atan(0.016));
  c.run.until = 2.0;
  EXPECT_TRUE(flow_estimate(c).still_gaining);
  EXPECT_NEAR(flow_estimate(c).speed, 2.0 * along, 1e-12);
  EXPECT_EQ(flow_estimate(c).friction_velocity, developed.friction_velocity);
  c.initial.fluid.uniform = Vec3(0.2, 0.0, 0.0);
  EXPECT_NEAR(flow_estimate(c).speed, 0.2 + 2.0 * along, 1e-12);
  c.run.until = 10.0;
  EXPECT_FALSE(flow_estimate(c).still_gaining);
  EXPECT_EQ(flow_estimate(c).speed, developed.speed);
  c.run.until = 2.0;
  c.initial.from.run = "another run";  // whose speed is not known
  EXPECT_EQ(flow_estimate(c).speed, developed.speed);
}

// A very slow start of a short run is meant to be slow; that of a long run is a mistake to warn of.
TEST(FlowEstimate, WarnsOfAnInitialShearVelocityThatDoesNotLast) {
  Case c = bed();
  c.initial.fluid.log_profile.emplace();
  c.initial.fluid.log_profile->bed_height = c.domain.size.z() - depth;
  c.initial.fluid.log_profile->shear_velocity = 0.008;
  c.initial.fluid.log_profile->roughness = 3e-4;
  c.run.until = 2.0;
  EXPECT_FALSE(any_contains(warnings(c), "shear velocity"));
  c.initial.fluid.log_profile->shear_velocity = 0.04;  // half of it
  EXPECT_TRUE(any_contains(warnings(c), "shear velocity of 0.04"));
  c.initial.fluid.log_profile->shear_velocity = 0.008;
  c.run.until = 30.0;
  EXPECT_TRUE(any_contains(warnings(c), "shear velocity of 0.008"));
}

TEST(FlowEstimate, OfAFilmOfOilIsItsParabola) {
  const FlowEstimate flow = flow_estimate(film(1e-3));
  const double along = 9.8 * std::sin(std::atan(0.016));
  EXPECT_TRUE(flow.laminar);
  EXPECT_NEAR(flow.speed, along * 4e-4 / 2e-3, 1e-12);
  EXPECT_NEAR(flow.bulk_velocity, flow.speed / 1.5, 1e-12);
  EXPECT_NEAR(flow.spin_up, 1.2 * 4e-4 / 1e-3, 1e-12);
  // exp(-pi^2 nu t/(4 H^2)) of the difference, 8/pi^2 of the mean at first, is left: 5 %.
  const double left = 8.0 / (std::numbers::pi * std::numbers::pi) *
                      std::exp(-0.25 * std::numbers::pi * std::numbers::pi * 1e-3 * flow.spin_up / 4e-4);
  EXPECT_NEAR(left, 0.05, 0.01);
}

// Plates hold the flow on both sides: u_max = g H^2/(8 nu), a quarter of a film's.
TEST(FlowEstimate, BetweenFloorAndLidIsTheParabolaOfPlates) {
  Case c = film(1e-3);
  c.domain.faces[top].type = lbm::FaceType::no_slip;
  const FlowEstimate flow = flow_estimate(c);
  const double along = 9.8 * std::sin(std::atan(0.016));
  EXPECT_TRUE(flow.laminar);
  EXPECT_NEAR(flow.speed, along * 4e-4 / 8e-3, 1e-12);
  EXPECT_NEAR(flow.bulk_velocity, flow.speed / 1.5, 1e-12);
  EXPECT_NEAR(flow.friction_velocity, std::sqrt(along * 0.01), 1e-12);
  EXPECT_NEAR(flow.spin_up, 1.2 * 1e-4 / 1e-3, 1e-12);
}

// A slot much narrower than deep: u_max = g W^2/(8 nu), and Re 0.2 is laminar.
TEST(FlowEstimate, BetweenNearSideWallsIsThatOfTheSlot) {
  Case c = film(1e-3);
  c.domain.size.y() = 0.002;
  c.domain.faces[y_low].type = c.domain.faces[y_high].type = lbm::FaceType::no_slip;
  const double along = 9.8 * std::sin(std::atan(0.016));
  FlowEstimate flow = flow_estimate(c);
  EXPECT_TRUE(flow.laminar);
  EXPECT_NEAR(flow.speed, along * 4e-6 / 8e-3, 1e-6 * flow.speed);
  EXPECT_NEAR(flow.bulk_velocity, flow.speed / 1.5, 0.035 * flow.speed);  // less at the floor, by 0.63 W/(2 H)
  EXPECT_NEAR(flow.friction_velocity, std::sqrt(along * 0.02 * 0.002 / 0.042), 1e-12);
  // The same slot without a floor, and half of one as wide: a plane of symmetry.
  c.domain.faces[bottom].type = lbm::FaceType::free_slip;
  EXPECT_NEAR(flow_estimate(c).bulk_velocity, along * 4e-6 / 12e-3, 1e-12);
  c.domain.faces[y_high].type = lbm::FaceType::free_slip;
  EXPECT_NEAR(flow_estimate(c).speed, along * 4e-6 / 2e-3, 1e-12);
}

// U R/nu = 500, the 2000 of the hydraulic diameter: of a film U = g H^2/(3 nu).
TEST(FlowEstimate, IsLaminarByItsReynoldsNumber) {
  const double along = 9.8 * std::sin(std::atan(0.016)), nu = std::sqrt(along * 8e-6 / 3.0 / 500.0);
  EXPECT_TRUE(flow_estimate(film(1.01 * nu)).laminar);
  EXPECT_FALSE(flow_estimate(film(0.99 * nu)).laminar);
  EXPECT_LT(flow_estimate(film(0.99 * nu)).speed, flow_estimate(film(1.01 * nu)).speed);
}

// A mean velocity that is held makes the same profile as a slope that gives it.
TEST(FlowEstimate, OfASlowMeanVelocityIsThatOfTheSameChannel) {
  Case c = film(1e-3);
  c.domain.faces[top].type = lbm::FaceType::no_slip;
  c.domain.faces[y_low].type = c.domain.faces[y_high].type = lbm::FaceType::no_slip;
  const FlowEstimate by_slope = flow_estimate(c);
  c.gravity.slope = 0.0;
  c.fluid.mean_velocity = coupling::FlowTargetKeys{.velocity = by_slope.bulk_velocity, .response_time = 0.5};
  const FlowEstimate held = flow_estimate(c);
  EXPECT_TRUE(held.laminar);
  EXPECT_NEAR(held.speed, by_slope.speed, 1e-12);
  EXPECT_NEAR(held.friction_velocity, by_slope.friction_velocity, 1e-12);
}

TEST(FlowEstimate, OfAMovingTopIsCouetteFlow) {
  Case c = film(1e-3);
  c.gravity.slope = 0.0;
  c.domain.faces[top] = {.type = lbm::FaceType::moving, .velocity = Vec3(0.05, 0.0, 0.0)};
  FlowEstimate flow = flow_estimate(c);
  EXPECT_EQ(flow.cause, FlowCause::moving_face);
  EXPECT_EQ(flow.speed, 0.05);
  EXPECT_TRUE(flow.laminar);
  EXPECT_NEAR(flow.friction_velocity, std::sqrt(1e-3 * 0.05 / 0.02), 1e-12);
  // In water: Re_tau of turbulent Couette flow with V H/nu = 5200 (half and half: 1300) is 80 to 83 (Kitoh et al.
  // 2005).
  c.fluid.kinematic_viscosity = 1e-6;
  c.domain.faces[top].velocity.x() = 0.26;
  flow = flow_estimate(c);
  EXPECT_FALSE(flow.laminar);
  EXPECT_NEAR(flow.friction_velocity * 0.01 / 1e-6, 81.0, 12.0);
}

TEST(FlowEstimate, OfAMeanVelocityCountsTheWaterAboveTheBedAlone) {
  Case c = bed(0.0);
  hold_bed(c, depth);  // else they fall faster than this
  c.fluid.mean_velocity = coupling::FlowTargetKeys{.velocity = 0.2, .response_time = 0.5};
  const FlowEstimate flow = flow_estimate(c);
  const Vec3 size = c.domain.size;
  const double water = size.prod() - 1000.0 * std::numbers::pi / 6.0 * d * d * d;
  EXPECT_EQ(flow.cause, FlowCause::mean_velocity);
  EXPECT_NEAR(flow.bulk_velocity, 0.2 * water / (size.x() * size.y() * flow.depth), 1e-12);
  const double logarithm = std::log(flow.depth / (d / 15.0));
  EXPECT_NEAR(flow.bulk_velocity, flow.friction_velocity / 0.41 * (logarithm - 1.0), 1e-9);
  EXPECT_NEAR(flow.speed, flow.friction_velocity / 0.41 * logarithm, 1e-9);
}

// In air the terminal speed of glass beads is 20 m/s; a fall through the box, on a slope, gives sqrt(2 g H/cos).
TEST(FlowEstimate, OfGrainsThatFallIsAtMostThatOfTheBox) {
  Case c = bed(0.0);
  c.gravity.slope = 0.3;
  c.domain.faces[x_low].type = c.domain.faces[x_high].type = lbm::FaceType::no_slip;
  c.fluid.density = 1.2;
  c.fluid.kinematic_viscosity = 1.5e-5;
  const double height = c.domain.size.z() * std::sqrt(1.0 + 0.3 * 0.3);
  const double fastest = std::sqrt(2.0 * 9.8 * (1.0 - 1.2 / 2550.0) * height);
  EXPECT_GT(settling_velocity(c), 10.0);
  EXPECT_EQ(flow_estimate(c).cause, FlowCause::settling);
  EXPECT_NEAR(flow_estimate(c).speed, fastest, 1e-9);
  EXPECT_NEAR(expected_overlaps(c).speed, fastest, 1e-9);
  for (const FaceIndex face : {x_low, x_high, bottom, top}) c.domain.faces[face].type = lbm::FaceType::periodic;
  EXPECT_EQ(falling_speed(c), settling_velocity(c));
}

TEST(FlowEstimate, KnowsInletsStartsAndGrainsThatFall) {
  Case c = bed(0.0);
  EXPECT_EQ(flow_estimate(c).cause, FlowCause::settling);
  EXPECT_NEAR(flow_estimate(c).speed, settling_velocity(d, 2.55, 9.8, 1e-6), 1e-12);
  hold_bed(c, depth);
  EXPECT_EQ(flow_estimate(c).speed, 0.0);
  c.initial.fluid.uniform = Vec3(0.1, 0.0, 0.0);
  EXPECT_EQ(flow_estimate(c).cause, FlowCause::initial_fluid);
  c.domain.faces[x_low] = {.type = lbm::FaceType::velocity_inlet, .velocity = Vec3(0.3, 0.0, 0.0)};
  c.domain.faces[x_high].type = lbm::FaceType::pressure_outlet;
  EXPECT_EQ(flow_estimate(c).cause, FlowCause::inlet);
  // All of it above the bed, with the profile that it may come to.
  const FlowEstimate flow = flow_estimate(c);
  EXPECT_NEAR(flow.speed, 0.3 * c.domain.size.z() / flow.depth + flow.friction_velocity / 0.41, 1e-12);
}

// With the step that follows, the check of the lattice velocity accepts them.
TEST(FlowEstimate, KnowsGrainsThatSpin) {
  Case c = bed(0.0);
  beds::Population& grains = c.grains.front();
  grains.angular_velocity = Vec3(0.0, 0.0, 2000.0);
  EXPECT_EQ(flow_estimate(c).cause, FlowCause::moving_grains);
  EXPECT_NEAR(flow_estimate(c).speed, 2000.0 * 0.5 * d, 1e-12);
  grains.angular_velocity = Vec3::Zero();
  grains.count = 2;
  grains.motion.emplace().rotation = dem::RotationKeys{.point = Vec3(0.02, 0.02, 0.02), .angular_velocity = 50.0};
  grains.motion->rotation->axis = Vec3(0.0, 0.0, 1.0);
  grains.placement.positions = {Vec3(0.03, 0.02, 0.01), Vec3(0.015, 0.02, 0.03)};
  EXPECT_NEAR(flow_estimate(c).speed, 50.0 * (0.01 + 0.5 * d), 1e-12);
}

// What enters over the whole face flows above the bed, and so has the friction velocity of the log law of its mean.
TEST(FlowEstimate, OfAnInletOverABedIsThatOfItsDischarge) {
  Case c = bed(0.0);
  hold_bed(c, depth);
  c.domain.faces[x_low] = {.type = lbm::FaceType::velocity_inlet, .velocity = Vec3(0.2, 0.0, 0.0)};
  c.domain.faces[x_high].type = lbm::FaceType::pressure_outlet;
  const FlowEstimate passing = flow_estimate(c);
  EXPECT_EQ(passing.drive, FlowCause::inlet);
  EXPECT_NEAR(passing.depth, depth, 0.2 * d);
  const double mean = 0.2 * c.domain.size.z() / passing.depth;
  EXPECT_NEAR(passing.bulk_velocity, mean, 1e-12);
  EXPECT_NEAR(mean, passing.friction_velocity / 0.41 * (std::log(passing.depth / (d / 15.0)) - 1.0), 1e-9);
  EXPECT_NEAR(passing.spin_up, c.domain.size.x() / mean, 1e-12);
  c.domain.faces[x_low].recycling_plane = 0.5 * c.domain.size.x();  // the flow develops, as in a periodic box
  EXPECT_NEAR(flow_estimate(c).spin_up, 10.0 * passing.depth / passing.friction_velocity, 1e-9);
}

// The inlet sets how much flows, on a steep slope as on none: what the slope drives in excess, pressure balances.
TEST(FlowEstimate, OfAnInletDoesNotDependOnTheSlope) {
  Case level = bed(0.0);
  hold_bed(level, depth);
  level.domain.faces[x_low] = {.type = lbm::FaceType::velocity_inlet, .velocity = Vec3(0.1, 0.0, 0.0)};
  level.domain.faces[x_high].type = lbm::FaceType::pressure_outlet;
  Case steep = level;
  steep.gravity.slope = 0.05;
  const FlowEstimate flow = flow_estimate(steep);
  EXPECT_EQ(flow.drive, FlowCause::inlet);
  EXPECT_NEAR(flow.bulk_velocity, 0.1 * steep.domain.size.z() / (steep.domain.size.z() - settled_height(steep)), 1e-12);
  EXPECT_NEAR(flow.speed, flow_estimate(level).speed, 1e-12);
  EXPECT_EQ(estimated_velocity(steep), 0.0);
}

// Two outlets with a difference of pressure drive the water as the slope (p_low - p_high)/(rho g L) would, but no
// faster than water from rest enters by their head.
TEST(FlowEstimate, OfTwoOutletsIsThatOfTheirPressures) {
  const auto between = [](double pressure) {
    Case c = bed(0.0);
    hold_bed(c, depth);
    c.domain.faces[x_low] = {.type = lbm::FaceType::pressure_outlet, .pressure = pressure};
    c.domain.faces[x_high].type = lbm::FaceType::pressure_outlet;
    return c;
  };
  EXPECT_EQ(flow_estimate(between(0.0)).drive, FlowCause::none);
  const Case c = between(20.0);
  const FlowEstimate flow = flow_estimate(c);
  EXPECT_EQ(flow.drive, FlowCause::outlets);
  EXPECT_EQ(flow.way, 1.0);
  EXPECT_NEAR(flow.speed, std::sqrt(2.0 * 20.0 / 1000.0), 1e-12);
  EXPECT_LT(flow.friction_velocity, std::sqrt(20.0 / (1000.0 * c.domain.size.x()) * flow.depth));
  EXPECT_EQ(flow_estimate(between(-20.0)).way, -1.0);
  Case viscous = between(0.02), sloping = between(0.0);
  viscous.fluid.kinematic_viscosity = sloping.fluid.kinematic_viscosity = 1e-3;
  sloping.gravity.slope = std::tan(std::asin(0.02 / (1000.0 * 9.8 * viscous.domain.size.x())));
  EXPECT_NEAR(flow_estimate(viscous).speed, flow_estimate(sloping).speed, 1e-9);
  EXPECT_EQ(flow_estimate(sloping).drive, FlowCause::slope);
}

// dp/(rho c_s^2) = 3 p dt^2/(rho dx^2) is at most a twentieth.
TEST(SuitableTimeStep, KeepsTheCompressionByAnOutlet) {
  Case c = bed(0.0);
  c.domain.faces[x_low] = {.type = lbm::FaceType::velocity_inlet, .velocity = Vec3(0.01, 0.0, 0.0)};
  c.domain.faces[x_high] = {.type = lbm::FaceType::pressure_outlet, .pressure = -500.0};
  const double limit = c.domain.spacing * std::sqrt(0.05 * 1000.0 / (3.0 * 500.0));
  EXPECT_LE(suitable_time_step(c), limit);
  EXPECT_GT(suitable_time_step(c), 0.9 * limit);
}

// Held grains that fill the box let the water through between them, as much as there is.
TEST(FlowEstimate, OfAMeanVelocityInABoxFullOfHeldGrainsIsThatOfTheWater) {
  Case c = bed(0.0);
  hold_bed(c, depth);
  c.domain.size.z() -= depth;
  c.fluid.mean_velocity = coupling::FlowTargetKeys{.velocity = 0.2, .response_time = 0.5};
  EXPECT_NEAR(flow_estimate(c).bulk_velocity, 0.2, 1e-12);
}

// 8 spheres on a cubic lattice 1.25 diameters wide: between their equators the water is (1 - phi)/(1 - pi/4 0.8^2)
// times as fast as in the mean, and 1/(1 - pi/4 0.8^2) times as fast as where it enters.
TEST(FlowEstimate, ThroughPoresIsThatOfTheNarrowestSection) {
  constexpr double pi = std::numbers::pi, side = 0.0125, narrowest = 1.0 - pi / 4.0 * 0.64;
  constexpr double fraction = pi / 6.0 * 0.512;  // spheres of 5 mm, 6.25 mm apart
  Case c = bed(0.0);
  c.gravity.magnitude = 0.0;
  c.grains[0].count = 8;
  c.grains[0].fixed = true;
  c.domain.size = Vec3(side, side, side);
  for (coupling::FaceKeys& face : c.domain.faces) face.type = lbm::FaceType::periodic;
  c.fluid.mean_velocity = coupling::FlowTargetKeys{.velocity = 0.1, .response_time = 0.5};
  EXPECT_NEAR(flow_estimate(c).speed, 0.1 * (1.0 - fraction) / narrowest, 1e-12);
  c.fluid.mean_velocity.reset();
  c.domain.faces[bottom] = {.type = lbm::FaceType::velocity_inlet, .velocity = Vec3(0.0, 0.0, 0.1)};
  c.domain.faces[top].type = lbm::FaceType::pressure_outlet;
  EXPECT_NEAR(flow_estimate(c).speed, 0.1 / narrowest, 1e-12);
  EXPECT_EQ(flow_estimate(c).cause, FlowCause::inlet);
}

// A mean velocity replaces gravity along x and leaves that across.
TEST(FlowEstimate, OfAMeanVelocityLeavesGravityAcross) {
  Case along = bed(0.0), across = bed(0.0);
  along.gravity.vector = Vec3(0.5, 0.0, -9.8);
  across.gravity.vector = Vec3(0.0, 0.5, -9.8);
  const double free = flow_estimate(across).speed;
  EXPECT_GT(free, 1.0);
  for (Case* c : {&along, &across}) c->fluid.mean_velocity.emplace().velocity = 0.01;
  EXPECT_LT(flow_estimate(along).speed, 0.6);  // of grains that fall, 0.48 m/s
  EXPECT_NEAR(flow_estimate(across).speed, free, 1e-12);
  EXPECT_EQ(flow_estimate(across).cause, FlowCause::slope);
}

// Roughness and fall of a clump are those of the sphere of its volume, however small its members are.
TEST(FlowEstimate, OfClumpsIsThatOfTheirNominalDiameter) {
  const std::string shape =
      "grains.0.shape={clump: [{position: [0, 0, 0], diameter: 1.0}, {position: [0.5, 0, 0], diameter: 1.0}]}";
  const Case spheres = testing::read_text(testing::flume), clumps = testing::read_text(testing::flume, {shape});
  EXPECT_LT(clumps.grains[0].largest_diameter(), 0.9 * spheres.grains[0].largest_diameter());
  EXPECT_NEAR(flow_estimate(clumps).speed, flow_estimate(spheres).speed, 1e-9);
  EXPECT_NEAR(settling_velocity(clumps), settling_velocity(spheres), 1e-9);
}

TEST(FlowEstimate, OfAStreamThatNothingHoldsBackHasNoFriction) {
  Case c = bed(0.0);
  c.grains.clear();
  c.domain.faces[bottom].type = c.domain.faces[top].type = lbm::FaceType::free_slip;
  c.domain.faces[x_low] = {.type = lbm::FaceType::velocity_inlet, .velocity = Vec3(0.2, 0.0, 0.0)};
  c.domain.faces[x_high].type = lbm::FaceType::pressure_outlet;
  EXPECT_EQ(flow_estimate(c).drive, FlowCause::none);
  EXPECT_EQ(flow_estimate(c).speed, 0.2);
}

// The mean pressure gradient carries what a slope would drive.
TEST(FlowEstimate, OfBalancedGravityIsWithoutASlope) {
  Case c = bed();
  c.domain.faces[bottom].type = c.domain.faces[top].type = lbm::FaceType::periodic;
  c.gravity.mode = GravityMode::balanced;
  EXPECT_NE(flow_estimate(c).drive, FlowCause::slope);
}

}  // namespace
}  // namespace thalweg::driver::flow_estimate_test
