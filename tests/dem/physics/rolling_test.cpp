// Rolling friction: how a rolling sphere slows down, when it stays on a slope, and what a pair keeps.
#include "core/base/error.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>

namespace thalweg::dem::rolling_test {
namespace {

constexpr double g = 9.8;

TEST(RollingFriction, SlowsARollingSphereByFiveSeventhsOfItsFriction) {
  // m a = -f and I alpha = f R - mu_r R m g with a = alpha R and I = 2/5 m R^2: a = -5/7 mu_r g, until it stands.
  const double rolling = 0.05, v0 = 0.1, a = 5.0 / 7.0 * rolling * g;
  for (const bool elastic : {false, true}) {
    GrainSeed seed = test::glass_sphere(0, Vec3(0.01, 0.025, test::glass_radius), Vec3(v0, 0.0, 0.0));
    seed.angular_velocity = Vec3(0.0, v0 / test::glass_radius, 0.0);
    GrainDynamics grains(test::cube(), MPI_COMM_SELF, test::on_floor(test::damped_glass(elastic), rolling, 0.0),
                         {seed});
    const Vec3 &x = grains.store().position[0], &v = grains.store().velocity[0];
    double v1 = 0.0;
    for (int n = 0; n < 800; ++n) {
      test::step(grains);
      const double time = (n + 1) * 2.5e-4;
      if (n == 199) v1 = v[0];
      // From 0.05 s on the setting down has died out; it stands at v0/a = 0.286 s.
      if (n > 199) {
        EXPECT_NEAR(v[0], v1 - a * (time - 0.05), 2e-3 * v0) << time;
      }
    }
    // The time before that is the setting down: the moment is that of the force, whose mean is the weight.
    EXPECT_NEAR(v1, v0 - a * 0.05, 5e-3 * v0);
    for (int n = 0; n < 2400; ++n) test::step(grains);
    // 0.8 s: the rolling spring has swung back, 5/7 mu_r g/omega_r at first, and its swing has died out.
    EXPECT_NEAR(v[0], 0.0, 1e-6);
    EXPECT_NEAR(x[0] - 0.01, v0 * v0 / (2.0 * a), 5e-3 * v0 * v0 / (2.0 * a));
  }
}

TEST(RollingFriction, HoldsASphereOnASlopeBelowItsCoefficient) {
  // The moment about the contact, m g R sin, must be below mu_r R m g cos. The spring overshoots by less than half at
  // zeta_r = 0.3, so that on two thirds of the slope nothing gives way.
  const double rolling = 0.1;
  for (const bool elastic : {false, true}) {
    GrainDynamics grains(test::cube(), MPI_COMM_SELF,
                         test::on_floor(test::damped_glass(elastic), rolling, 0.65 * rolling),
                         {test::glass_sphere(0, Vec3(0.01, 0.025, test::glass_radius))});
    for (int n = 0; n < 2000; ++n) test::step(grains);
    const double settled = grains.store().position[0][0];
    // The overlap at rest, delta, turns the sphere by (tan/mu_r) delta/(2.25 mu_r R) at most before it balances,
    // thrice that with the overlap still small when it is set down.
    const double weight = test::glass_sphere(0, Vec3::Zero()).mass() * g;
    const double overlap =
        elastic ? std::pow(weight / (4.0 / 3.0 * 5e6 / (2.0 * 0.91) * std::sqrt(test::glass_radius)), 2.0 / 3.0)
                : weight / 20000.0;
    EXPECT_GT(settled - 0.01, 0.0);
    EXPECT_LT(settled - 0.01, 3.0 * overlap / (2.25 * rolling));
    EXPECT_LT(grains.store().velocity[0].norm(), 1e-9);
    for (int n = 0; n < 2000; ++n) test::step(grains);
    EXPECT_NEAR(grains.store().position[0][0], settled, 1e-9 * 2.0 * test::glass_radius);
  }
}

TEST(RollingFriction, LetsASphereRollOnASteeperSlope) {
  const double rolling = 0.1, slope = 0.2, angle = std::atan(slope);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, test::on_floor(test::damped_glass(false), rolling, slope),
                       {test::glass_sphere(0, Vec3(0.01, 0.025, test::glass_radius))});
  const double a = 5.0 / 7.0 * g * (std::sin(angle) - rolling * std::cos(angle));
  for (int n = 0; n < 200; ++n) test::step(grains);
  const double v1 = grains.store().velocity[0][0];
  for (int n = 0; n < 400; ++n) test::step(grains);
  EXPECT_NEAR(grains.store().velocity[0][0] - v1, a * 0.1, 2e-3 * a * 0.1);
}

TEST(RollingFriction, PairsKeepMomentumAndAngularMomentum) {
  for (const bool elastic : {false, true}) {
    GrainParameters p = test::parameters(test::damped_glass(elastic), 2e-6, 25);
    p.contact.rolling_friction = 0.2;
    GrainSeed a = test::glass_sphere(0, Vec3(0.020, 0.025, 0.025), Vec3(0.2, 0.01, 0.0));
    GrainSeed b = test::glass_sphere(1, Vec3(0.0245, 0.0255, 0.025), Vec3(-0.2, 0.0, 0.02), 0.8 * test::glass_radius);
    a.angular_velocity = Vec3(3.0, 40.0, -20.0);
    b.angular_velocity = Vec3(-5.0, -30.0, 10.0);
    const auto angular_momentum = [](const GrainDynamics& grains) {
      const GrainStore& s = grains.store();
      Vec3 sum = Vec3::Zero();
      for (std::size_t i = 0; i < s.owned; ++i)
        sum += s.mass[i] * s.position[i].cross(s.velocity[i]) + s.inertia[i] * s.angular_velocity[i];
      return sum;
    };
    const auto spin_energy = [](const GrainDynamics& grains) {
      const GrainStore& s = grains.store();
      return 0.5 * s.inertia[0] * s.angular_velocity[0].squaredNorm() +
             0.5 * s.inertia[1] * s.angular_velocity[1].squaredNorm();
    };
    double left[2];
    for (const bool rolling : {false, true}) {
      p.contact.rolling_friction = rolling ? 0.2 : 0.0;
      GrainDynamics grains(test::cube(true), MPI_COMM_SELF, p, {a, b});
      const Vec3 momentum = grains.momentum(), turning = angular_momentum(grains);
      const double energy = grains.kinetic_energy();
      int touching = 0;
      for (int n = 0; n < 40; ++n) {
        test::step(grains);
        touching += static_cast<int>(grains.contact_count());
      }
      EXPECT_GT(touching, 0);
      EXPECT_EQ(grains.contact_count(), 0);
      EXPECT_LT(grains.kinetic_energy(), energy);
      // 1000 steps, each with a few roundings of terms of these sizes.
      EXPECT_LT((grains.momentum() - momentum).norm(), 4000.0 * 1.2e-16 * 2.0 * grains.store().mass[0] * 0.2);
      EXPECT_LT((angular_momentum(grains) - turning).norm(),
                4000.0 * 1.2e-16 * 2.0 * grains.store().mass[0] * 0.2 * 0.045);
      left[rolling] = spin_energy(grains);
    }
    EXPECT_LT(left[1], left[0]);
  }
}

TEST(RollingFriction, ImpossibleCoefficientsAreRefused) {
  ContactParameters contact = test::glass(0.5);
  contact.rolling_friction = -0.1;
  EXPECT_THROW(check(contact), InputError);
  contact.rolling_friction = 0.1;
  contact.rolling_damping = std::nan("");
  EXPECT_THROW(check(contact), InputError);
  contact.rolling_damping = 0.3;
  ContactParameters other = test::glass(0.5);
  other.rolling_damping = 0.1;
  EXPECT_THROW(mixed(test::glass(0.5), other), InputError);
  EXPECT_DOUBLE_EQ(mixed(contact, test::glass(0.5)).rolling_friction, 0.0);
  Plane plane;
  plane.rolling_friction = -1.0;
  EXPECT_THROW(check(plane), InputError);
}

}  // namespace
}  // namespace thalweg::dem::rolling_test
