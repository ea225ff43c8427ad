// Oblique impacts with friction: the exact rebound for k_t/k_n = 2/7, where normal and tangential half periods are
// equal.
#include "tests/dem/grain_cases.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace thalweg::dem::oblique_impact_test {
namespace {

constexpr double normal_speed = 5e-4;  // m/s: slow, so that the line of centres hardly turns and overlaps are small

GrainParameters parameters_of(const ContactParameters& contact) {
  GrainParameters p;
  p.contact = contact;
  p.walls = {face_plane(test::cube().box(), 2, false, contact.wall_friction)};
  p.time_step = 2e-7;  // 1400 steps a contact on the wall, 1000 of a pair
  p.sub_steps = 50;
  p.skin = 5e-4;
  return p;
}

// -v_t'/v_t at the contact point of a sphere without spin that hits the floor at v_t/v_n = ratio.
double wall_rebound(const ContactParameters& contact, double ratio) {
  const Vec3 along = Vec3(3.0, -4.0, 0.0) / 5.0;
  const Vec3 velocity = normal_speed * (ratio * along - Vec3::UnitZ());
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, parameters_of(contact),
                       {test::glass_sphere(0, Vec3(0.025, 0.025, test::glass_radius + 1e-9), velocity)});
  for (int n = 0; n < 100; ++n) test::step(grains);  // 1 ms
  EXPECT_GT(grains.store().velocity[0][2], 0.0);
  const Vec3 surface =
      grains.store().velocity[0] + grains.store().angular_velocity[0].cross(-test::glass_radius * Vec3::UnitZ());
  return -surface.dot(along) / (ratio * normal_speed);
}

// The same of two equal spheres that meet with opposite velocities.
double pair_rebound(const ContactParameters& contact, double ratio) {
  const Vec3 n = Vec3(1.0, 2.0, 2.0) / 3.0, t = Vec3(2.0, 1.0, -2.0) / 3.0;  // from second to first; tangent
  const Vec3 half = 0.5 * normal_speed * (ratio * t - n);
  const Vec3 centre(0.025, 0.025, 0.025);
  const Vec3 arm = (test::glass_radius + 5e-10) * n;
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, parameters_of(contact),
                       {test::glass_sphere(0, centre + arm, half), test::glass_sphere(1, centre - arm, -half)});
  for (int k = 0; k < 100; ++k) test::step(grains);
  const GrainStore& s = grains.store();
  EXPECT_TRUE(grains.contacts().empty());
  const Vec3 spin = s.angular_velocity[0] + s.angular_velocity[1];
  const Vec3 surface = s.velocity[0] - s.velocity[1] - test::glass_radius * spin.cross(n);
  return -surface.dot(t) / (ratio * normal_speed);
}

TEST(ObliqueImpact, ElasticReboundIsExact) {
  // 1 up to v_t/v_n = 7 mu/2 = 1.75, then -1 + 7 mu v_n/v_t. Bound: one step of a thousand, and the turning of the line
  // of centres, 2 % at 50 mm/s and in proportion to the speed.
  const ContactParameters contact = test::glass(1.0);
  const double exact[][2] = {{0.5, 1.0}, {2.0, 0.75}, {3.0, 1.0 / 6.0}, {5.0, -0.3}};
  for (const auto& [ratio, rebound] : exact) {
    EXPECT_NEAR(wall_rebound(contact, ratio), rebound, 1e-3) << ratio;
    EXPECT_NEAR(pair_rebound(contact, ratio), rebound, 2e-3) << ratio;
  }
}

TEST(ObliqueImpact, GlassWithoutAttraction) {
  // Limits of the differential equation at e = 0.93; the restitution has an error of the order of the step.
  const ContactParameters contact = test::glass(0.93, false);
  const double limit[][2] = {{0.5, 0.9985}, {1.0, 0.9974}, {1.5, 0.9887}, {1.75, 0.8998},
                             {2.0, 0.6835}, {3.0, 0.1256}, {5.0, -0.3244}};
  for (const auto& [ratio, rebound] : limit) EXPECT_NEAR(wall_rebound(contact, ratio), rebound, 2e-3) << ratio;
}

TEST(ObliqueImpact, FullSlidingTakesAllTheFrictionThereIs) {
  // Steep enough sliding never stops: v_t' = v_t - mu (1 + e) v_n, and the spin is 5 mu (1 + e) v_n/(2 R).
  GrainParameters p = parameters_of(test::glass(0.93, true));
  p.contact.wall_friction = p.walls[0].friction = 0.1;
  const Vec3 velocity(20.0 * normal_speed, 0.0, -normal_speed);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p,
                       {test::glass_sphere(0, Vec3(0.025, 0.025, test::glass_radius + 1e-9), velocity)});
  for (int n = 0; n < 100; ++n) test::step(grains);
  // The pull at the end, |F_n| of the wrong sign, rubs as well: the friction's impulse is that of |F_n|, which exceeds
  // (1 + e) m v_n by twice the pull's. Its share, from the closed form of the damped half period, is below 1.5e-3.
  const double impulse = 0.1 * 1.93 * normal_speed;
  EXPECT_NEAR(velocity[0] - grains.store().velocity[0][0], impulse, 4e-3 * impulse);
  EXPECT_NEAR(grains.store().angular_velocity[0][1], 2.5 * impulse / test::glass_radius,
              4e-3 * 2.5 * impulse / test::glass_radius);
}

TEST(ObliqueImpact, EnergyNeverRises) {
  // Total energy, with that of the springs, of two frictional spheres at every step of an oblique, spinning impact. The
  // elastic integrator's own oscillation is bounded by (omega dt)^2/8 of the energy, 1.3e-6 at 1000 steps a contact.
  for (const bool attraction : {false, true})
    for (const double ratio : {0.3, 1.0, 2.0, 4.0}) {
      GrainParameters p = parameters_of(test::glass(0.93, attraction));
      p.sub_steps = 1;
      const Vec3 n = Vec3::UnitX();
      const Vec3 half = 0.05 * (ratio * Vec3(0.0, 0.6, 0.8) - n);
      GrainSeed first = test::glass_sphere(0, Vec3(0.0276, 0.025, 0.025), half);
      GrainSeed second = test::glass_sphere(1, Vec3(0.0225, 0.025, 0.025), -half);
      first.angular_velocity = Vec3(3.0, -8.0, 5.0);
      GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {first, second});
      const auto energy = [&] {
        double sum = grains.kinetic_energy();
        for (const Contact& c : grains.contacts())
          sum += 0.5 * p.contact.normal_stiffness * c.overlap * c.overlap +
                 0.5 * p.contact.tangential_stiffness * Vec3(c.history.data()).squaredNorm();
        return sum;
      };
      const double start = energy();
      double lowest = start;
      bool touched = false;
      for (int k = 0; k < 8000; ++k) {
        test::step(grains);
        touched = touched || !grains.contacts().empty();
        const double now = energy();
        ASSERT_LT(now, lowest + 4e-6 * start) << "ratio " << ratio << ", step " << k;
        lowest = std::min(lowest, now);
      }
      EXPECT_TRUE(touched && grains.contacts().empty());
      EXPECT_LT(lowest, 0.99 * start);
      EXPECT_GT(lowest, 0.0);
    }
}

TEST(ObliqueImpact, AngularMomentumIsConserved) {
  const ContactParameters contact = test::glass(0.7);
  GrainParameters p = parameters_of(contact);
  const Vec3 v(0.4, 0.1, -0.1);
  GrainSeed first = test::glass_sphere(0, Vec3(0.0275, 0.025, 0.026), -v, 2e-3);
  GrainSeed second = test::glass_sphere(1, Vec3(0.0225, 0.025, 0.025), v, 3e-3);
  first.angular_velocity = Vec3(30.0, 0.0, -50.0);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {first, second});
  const auto angular_momentum = [&] {
    const GrainStore& s = grains.store();
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 2; ++i)
      sum += s.mass[i] * s.position[i].cross(s.velocity[i]) + s.inertia[i] * s.angular_velocity[i];
    return sum;
  };
  const Vec3 start = angular_momentum();
  for (int k = 0; k < 200; ++k) test::step(grains);
  EXPECT_GT((grains.store().velocity[0] + v).norm(), 0.1);                      // they did collide
  EXPECT_NEAR((angular_momentum() - start).norm() / start.norm(), 0.0, 1e-11);  // round-off of 10^4 steps
}

// Springs of the linear law are lengths and angles, those of Hertz and Mindlin areas and angles times a length: one law
// does not take over the other's.
TEST(ObliqueImpact, SpringsOfAnotherLawAreNotGoneOnWith) {
  GrainParameters p = parameters_of(test::glass(0.9));
  p.walls[0].rolling_friction = 0.1;
  GrainDynamics linear(
      test::cube(), MPI_COMM_SELF, p,
      {test::glass_sphere(0, Vec3(0.025, 0.025, test::glass_radius + 1e-9), Vec3(1e-4, 0.0, -normal_speed))});
  for (int n = 0; n < 5; ++n) test::step(linear);
  const auto saved = [](const GrainDynamics& grains) { return thalweg::test::saved(grains, MPI_COMM_SELF); };
  const auto largest = [](const thalweg::test::MemoryArchive& archive, const char* name) {
    double value = -1.0;
    for (const double x : std::get<std::vector<double>>(archive.datasets.at(name).values))
      value = std::max(value, std::abs(x));
    return value;
  };
  const thalweg::test::MemoryArchive archive = saved(linear);
  EXPECT_GT(largest(archive, "grains/contact_spring"), 0.0);
  EXPECT_GT(largest(archive, "grains/contact_rolling"), 0.0);
  const auto restarted = [&archive](const GrainParameters& with) {
    auto grains = std::make_unique<GrainDynamics>(test::cube(), MPI_COMM_SELF, with, GrainSeeds{});
    thalweg::test::load(*grains, archive);
    return grains;
  };
  EXPECT_EQ(thalweg::test::first_difference(saved(*restarted(p)), archive), "");
  p.contact.law = Law::hertz_mindlin;
  p.contact.youngs_modulus = 1e7;
  p.contact.poisson_ratio = 0.3;
  for (const char* spring : {"grains/contact_mindlin_spring", "grains/contact_mindlin_rolling"})
    EXPECT_LE(largest(saved(*restarted(p)), spring), 0.0) << spring;  // rows of zeros are not saved
}

}  // namespace
}  // namespace thalweg::dem::oblique_impact_test
