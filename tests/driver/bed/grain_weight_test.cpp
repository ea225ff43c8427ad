// The weight of a grain under gravity and a held flow.
#include "driver/bed/grain_weight.hpp"

#include "tests/driver/water_over_glass.hpp"

#include <gtest/gtest.h>

namespace thalweg::driver::grain_weight_test {
namespace {

// A litre of glass: 2.55 kg in 1 kg of water, on a slope that gives a twentieth of gravity along x.
const double mass = 2.55, radius = std::cbrt(0.75e-3 / std::numbers::pi);

Case flume(GravityMode mode) {
  Case c = water_over_glass(5e-3, 0.05, 0.04, 0.01, lbm::FaceType::law_of_the_wall);
  c.gravity.mode = mode;
  return c;
}

TEST(GrainWeight, IsWholeAlongTheBedAndSubmergedAcrossIt) {
  const Case c = flume(GravityMode::reduced);
  const Vec3 g = gravity_vector(c.gravity), weight = body_force(c)(mass, radius);
  EXPECT_NEAR(weight.x(), 2.55 * g.x(), 1e-12);
  EXPECT_NEAR(weight.z(), 1.55 * g.z(), 1e-12);
  EXPECT_NEAR(body_force(flume(GravityMode::full))(mass, radius).z(), 2.55 * g.z(), 1e-12);
}

// The pressure gradient carries the weight of the fluid.
TEST(GrainWeight, IsSubmergedAlongAHeldFlow) {
  for (const GravityMode mode : {GravityMode::reduced, GravityMode::full}) {
    Case c = flume(mode);
    const double across = body_force(c)(mass, radius).z();
    c.fluid.mean_velocity = coupling::FlowTargetKeys{.velocity = 0.5, .response_time = 0.1};
    const double along = gravity_vector(c.gravity).x();
    EXPECT_NEAR(body_force(c)(mass, radius).x(), 1.55 * along, 1e-12);
    EXPECT_EQ(body_force(c)(mass, radius).z(), across);
    c.fluid.mean_velocity->on_grains = false;
    EXPECT_NEAR(body_force(c)(mass, radius).x(), 2.55 * along, 1e-12);
  }
}

TEST(GrainWeight, LacksWhatTheLoadOfTheFluidHas) {
  const auto lacks = [](const Case& c) { return buoyancy_in_load(c)(mass, radius); };
  Case held = flume(GravityMode::reduced);
  const Vec3 g = gravity_vector(held.gravity);
  EXPECT_EQ(lacks(held), Vec3(0.0, 0.0, 0.0));
  EXPECT_TRUE(lacks(flume(GravityMode::full)).isApprox(Vec3(0.0, 0.0, -g.z()), 1e-12));
  held.fluid.mean_velocity = coupling::FlowTargetKeys{.velocity = 0.5, .response_time = 0.1};
  EXPECT_TRUE(lacks(held).isApprox(Vec3(g.x(), 0.0, 0.0), 1e-12));
  held.fluid.mean_velocity->on_grains = false;
  EXPECT_EQ(lacks(held), Vec3(0.0, 0.0, 0.0));
}

}  // namespace
}  // namespace thalweg::driver::grain_weight_test
