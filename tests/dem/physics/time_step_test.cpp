// The longest step that is allowed: what a contact does in it dies out, whichever of its springs and dashpots is the
// fastest.
#include "core/base/error.hpp"
#include "dem/laws/material.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

namespace thalweg::dem::time_step_test {
namespace {

constexpr double g = 9.8;

struct Contact {
  std::string name;
  ContactParameters parameters;
};

Contact contact(const std::string& name, const std::function<void(ContactParameters&)>& change) {
  ContactParameters parameters = test::glass(0.9);
  parameters.wall_friction = 10.0;  // nothing slides
  change(parameters);
  return {name, parameters};
}

class LongestStep : public ::testing::TestWithParam<Contact> {};

// A sphere that rests on a floor is pushed along it, turned about it and dropped on it a little.
TEST_P(LongestStep, GainsNoEnergy) {
  const ContactParameters& material = GetParam().parameters;
  const double mass = test::glass_density * 4.0 / 3.0 * std::numbers::pi * std::pow(test::glass_radius, 3.0);
  const double longest = longest_wall_step(material, material, mass, test::glass_radius);
  EXPECT_NO_THROW(check_wall_time_step(material, material, mass, test::glass_radius, 0.999 * longest));
  EXPECT_THROW(check_wall_time_step(material, material, mass, test::glass_radius, 1.001 * longest), InputError);
  GrainParameters p = test::parameters(material, longest, 1);
  p.walls = {face_plane(test::cube().box(), 2, false, material.wall_friction)};
  p.walls[0].rolling_friction = material.wall_rolling_friction;
  p.body_force = [](double of, double) { return Vec3(0.0, 0.0, -of * g); };
  const double speed = 1e-4;
  GrainSeed seed = test::glass_sphere(0, Vec3(0.01, 0.025, test::glass_radius), Vec3(speed, 0.0, -speed));
  seed.angular_velocity = Vec3(0.0, -speed / test::glass_radius, 0.0);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {seed});
  // Energy of motion along the floor and about it, which gravity does not feed.
  const auto energy = [&] {
    const Vec3 &v = grains.store().velocity[0], &w = grains.store().angular_velocity[0];
    return 0.5 * mass * v.head<2>().squaredNorm() + 0.2 * mass * std::pow(test::glass_radius, 2.0) * w.squaredNorm();
  };
  const double start = energy();
  for (int n = 0; n < 3000; ++n) {
    test::step(grains);
    ASSERT_LT(energy(), 1.1 * start)
        << n;  // the swing of Verlet's scheme at ten steps in half a period: (w dt)^2/4 = 2 %
  }
  EXPECT_LT(grains.store().velocity[0].z(), 0.1);
}

INSTANTIATE_TEST_SUITE_P(
    Contacts, LongestStep,
    ::testing::Values(
        contact("Published", [](ContactParameters&) {}),
        contact("StiffAcross", [](ContactParameters& c) { c.tangential_stiffness = 100.0 * c.normal_stiffness; }),
        contact("StronglyDampedAcross", [](ContactParameters& c) { c.restitution = 0.1, c.tangential_damping = 3.0; }),
        contact("HardlyRebounding", [](ContactParameters& c) { c.restitution = 1e-3, c.tangential_damping = 1.0; }),
        contact("HardlyReboundingElastic",
                [](ContactParameters& c) {
                  c.law = Law::hertz_mindlin, c.youngs_modulus = 5e6, c.poisson_ratio = 0.3;
                  c.restitution = 1e-3, c.tangential_damping = 1.0;
                }),
        contact("Rolling",
                [](ContactParameters& c) {
                  c.wall_rolling_friction = 3.0, c.rolling_damping = 2.0, c.tangential_damping = 0.5;
                })),
    [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace thalweg::dem::time_step_test
