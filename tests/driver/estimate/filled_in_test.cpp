#include "driver/estimate/filled_in.hpp"

#include "driver/estimate/flow_estimate.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <gtest/gtest.h>

namespace thalweg::driver::filled_in_test {
namespace {

Case bed(double slope = 0.016) { return water_over_glass(5e-3, slope, 0.0412, 0.040, lbm::FaceType::periodic); }

// A log profile that is left to the program, in laminar flow and under a lid, where the flow has another profile.
TEST(LogProfile, HasTheDischargeOfTheFlow) {
  for (const lbm::FaceType lid : {lbm::FaceType::free_slip, lbm::FaceType::no_slip})
    for (const double viscosity : {1e-6, 2e-4}) {
      Case c = bed();
      c.domain.faces[top].type = lid;
      c.fluid.kinematic_viscosity = viscosity;
      c.fluid.mean_velocity = coupling::FlowTargetKeys{.velocity = 0.1, .response_time = 1.0};
      c.initial.fluid.log_profile.emplace();
      complete(c);
      const double bed = *c.initial.fluid.log_profile->bed_height, height = c.domain.size.z();
      const auto start = coupling::initial_fluid(c.initial.fluid, {1, 1, 1}, {true, true, false}, c.domain.spacing);
      constexpr int heights = 10000;
      double mean = 0.0;
      for (int n = 0; n < heights; ++n)
        mean += start(Vec3(0.0, 0.0, bed + (n + 0.5) / heights * (height - bed))).velocity.x() / heights;
      // To what the estimate of a turbulent profile leaves out, z_0/H.
      const double bulk = flow_estimate(c).bulk_velocity;
      EXPECT_NEAR(mean, bulk, 0.01 * bulk) << viscosity;
    }
}

// The start of a flow to the left goes to the left.
TEST(LogProfile, GoesTheWayOfTheFlow) {
  const auto shear_velocity = [](Case c) {
    c.initial.fluid.log_profile.emplace();
    complete(c);
    return *c.initial.fluid.log_profile->shear_velocity;
  };
  Case by_slope = bed(0.016), steered = bed(0.0), fed = bed(0.0);
  const double right = shear_velocity(by_slope);
  EXPECT_GT(right, 0.0);
  by_slope.gravity.slope = -0.016;
  EXPECT_EQ(shear_velocity(by_slope), -right);
  steered.fluid.mean_velocity = coupling::FlowTargetKeys{.velocity = -0.1, .response_time = 1.0};
  EXPECT_LT(shear_velocity(steered), 0.0);
  fed.domain.faces[x_low].type = lbm::FaceType::pressure_outlet;
  fed.domain.faces[x_high].type = lbm::FaceType::velocity_inlet;
  fed.domain.faces[x_high].velocity = Vec3(-0.1, 0.0, 0.0);
  EXPECT_LT(shear_velocity(fed), 0.0);
  Case across = bed();  // the profile is along x
  across.gravity.magnitude.reset();
  across.gravity.slope.reset();
  across.gravity.vector = Vec3(0.0, 0.15, -9.8);
  EXPECT_EQ(shear_velocity(across), 0.0);
  across.gravity.vector = Vec3(-0.09, 0.12, -9.8);
  EXPECT_NEAR(shear_velocity(across), -0.6 * flow_estimate(across).friction_velocity, 1e-12);
}

}  // namespace
}  // namespace thalweg::driver::filled_in_test
