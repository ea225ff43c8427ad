// Gear's predictor-corrector with forces that change in every sub-step.
#include "dem/motion/grain_volume.hpp"
#include "model_fluid/model_fluid_field.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace thalweg::model_fluid::model_fluid_gear_test {
namespace {

using namespace dem;

using test::glass_density;
using test::glass_radius;
using test::glass_sphere;

ModelFluidParameters slow_fluid(double gravity) {
  const double diameter = 2.0 * glass_radius;
  ModelFluidParameters parameters;
  parameters.numbers = {0.3, 0.5, 0.0, ModelDrag::linear, 0.5};
  parameters.scales = {diameter, glass_density * grain_volume(glass_radius, 0.0), gravity};
  parameters.profile = VelocityProfile::of_spheres();
  parameters.solid_fraction.largest_radius = glass_radius;
  parameters.solid_fraction.margin = diameter;
  parameters.solid_fraction.tolerance = 0.01 * diameter;
  return parameters;
}

GrainDynamics sphere_in(const ModelFluidParameters& fluid, const Vec3& place, const Vec3& velocity, double fall,
                        double time_step, bool rough_floor = false) {
  const Decomposition box = test::cube();
  GrainParameters p = test::parameters(test::glass(0.5), time_step, 1, glass_radius);
  p.contact.normal_stiffness = 20.0;  // a contact of many steps
  p.contact.tangential_stiffness = 6.0;
  p.integrator = Integrator::gear;
  p.walls = face_planes(box.box(), p.contact);
  p.walls[0].rough = rough_floor;
  p.body_force = [fall](double mass, double /*radius*/) { return Vec3(0.0, 0.0, -mass * fall); };
  p.field = std::make_shared<ModelFluidField>(box.box(), fluid);
  p.attached_width = p.field->attached_columns();
  return GrainDynamics(box, MPI_COMM_SELF, p, {glass_sphere(0, place, velocity)});
}

// Alone in the fluid a grain has v = v_0 f [1 - exp(-B_1 t/m)]. The derivatives beyond the second are unknown at the
// start, which leaves an error of second order, as with a dashpot (gear_test.cpp).
double error_of_speed(double step) {
  const ModelFluidParameters fluid = slow_fluid(9.81);
  const ModelFluidCoefficients c = coefficients_of(fluid.numbers, fluid.scales);
  const double time = fluid.scales.mass / c.viscous, around = 3.0 * glass_radius;
  const double phi = std::pow(glass_radius / around, 3), speed = c.velocity * fluid.profile(phi);
  GrainDynamics grains = sphere_in(fluid, Vec3(0.01, 0.02, 0.025), Vec3::Zero(), 0.0, step * time);
  double worst = 0.0;
  for (int n = 1; n * step <= 0.5; ++n) {
    test::step(grains);
    worst = std::max(worst, std::abs(grains.store().velocity[0].x() / speed - (1.0 - std::exp(-n * step))));
  }
  return worst;
}

TEST(ModelFluidGear, GivesAGrainTheSpeedOfTheFluid) {
  const double coarse = error_of_speed(0.02), fine = error_of_speed(0.01);
  EXPECT_LT(coarse, 0.02 * 0.02);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.2);
}

// It comes down on the floor with a speed along it, and stays where it has touched it.
TEST(ModelFluidGear, HoldsAGrainOnTheFloor) {
  GrainDynamics grains =
      sphere_in(slow_fluid(9.81), Vec3(0.01, 0.02, glass_radius + 1e-5), Vec3(0.05, 0.0, -0.02), 9.81, 1e-6, true);
  const double surely = glass_radius - 1e-7;  // more than it moves in a step
  while (grains.store().position[0].z() > surely) test::step(grains);
  const Vec3 touched = grains.store().position[0];
  EXPECT_GT(touched.x(), 0.01);
  for (int n = 0; n < 20000 && grains.store().position[0].z() < surely; ++n) {
    test::step(grains);
    ASSERT_EQ(grains.store().velocity[0].x(), 0.0) << n;
    ASSERT_EQ(grains.store().position[0].x(), touched.x()) << n;
  }
}

}  // namespace
}  // namespace thalweg::model_fluid::model_fluid_gear_test
