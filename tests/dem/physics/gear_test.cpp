// Gear's predictor-corrector beside velocity Verlet: free flight, a smooth motion with an exact solution, an impact.
#include "dem/motion/gear_predictor.hpp"
#include "tests/dem/grain_cases.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace thalweg::dem::gear_test {
namespace {

constexpr double gravity = 9.81;

GrainParameters parameters_of(Integrator integrator, double restitution, double time_step, double g) {
  GrainParameters p = test::parameters(test::glass(restitution, true), time_step, 1, 5e-4);
  p.walls = {face_plane(test::cube().box(), 2, false, 0.0)};
  p.integrator = integrator;
  p.initial_overlap = 0.3;
  if (g > 0.0) p.body_force = [g](double mass, double) { return Vec3(0, 0, -mass * g); };
  return p;
}

// A sphere lying on the floor swings about its place there without leaving it: z'' + 2 beta z' + omega_0^2 z = 0, z the
// height above rest, from z_0 without speed. Returns the largest error over `periods` periods, relative to z_0.
double error_of_swing(Integrator integrator, double restitution, int steps_per_period, int periods) {
  const double mass = test::glass_sphere(0, Vec3::Zero()).mass();
  const ContactParameters contact = test::glass(restitution, true);
  const double omega_0 = std::sqrt(contact.normal_stiffness / mass);
  const double beta = Damping(contact).coefficient(mass) / (2.0 * mass);
  const double omega = std::sqrt(omega_0 * omega_0 - beta * beta);
  const double dt = 2.0 * std::numbers::pi / omega / steps_per_period;
  const double heavy = 1e4 * gravity;  // so that the amplitude is far above round-off
  const double rest = mass * heavy / contact.normal_stiffness, swing = 0.3 * rest;
  const double bottom = test::glass_radius - rest;
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, parameters_of(integrator, restitution, dt, heavy),
                       {test::glass_sphere(0, Vec3(0.025, 0.025, bottom + swing))});
  double worst = 0.0;
  for (int n = 1; n <= periods * steps_per_period; ++n) {
    test::step(grains);
    const double t = n * dt;
    const double exact = swing * std::exp(-beta * t) * (std::cos(omega * t) + beta / omega * std::sin(omega * t));
    worst = std::max(worst, std::abs(grains.store().position[0][2] - bottom - exact) / swing);
  }
  return worst;
}

// Verlet's frequency is off by (omega dt)^2/24, so that after five periods the phase is by 10 pi times that. Gear's
// error falls with the fifth power of the step once the derivatives it began without are found, with the second where
// a dashpot gives the acceleration a slope from the beginning.
TEST(Gear, FollowsASmoothSwingToHighOrder) {
  const auto verlet = [](int steps) { return error_of_swing(Integrator::velocity_verlet, 1.0, steps, 5); };
  const auto gear = [](double e, int steps) { return error_of_swing(Integrator::gear, e, steps, 5); };
  for (const int steps : {40, 80, 160}) {
    const double phase = 10.0 * std::pow(std::numbers::pi, 3) / (6.0 * steps * steps);
    EXPECT_NEAR(verlet(steps), phase, 0.06 * phase);
  }
  for (const int steps : {40, 80, 160}) {
    const double order = std::log2(gear(1.0, steps) / gear(1.0, 2 * steps));
    EXPECT_GT(order, 4.5) << steps;
    EXPECT_LT(order, 5.5) << steps;
    EXPECT_NEAR(std::log2(gear(0.8, steps) / gear(0.8, 2 * steps)), 2.0, 0.1) << steps;
  }
  EXPECT_LT(gear(1.0, 160), 1e-4 * verlet(160));
  EXPECT_LT(gear(0.8, 160), 0.01 * error_of_swing(Integrator::velocity_verlet, 0.8, 160, 5));
}

TEST(Gear, FreeFlightIsExact) {
  GrainParameters p = parameters_of(Integrator::gear, 1.0, 1e-5, gravity);
  p.sub_steps = 10;
  GrainSeed seed = test::glass_sphere(0, Vec3(0.025, 0.025, 0.03), Vec3(0.3, -0.2, 0.5));
  seed.angular_velocity = Vec3(10.0, 20.0, 30.0);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {seed});
  for (int n = 0; n < 500; ++n) test::step(grains);
  const double t = 0.05;  // a quadratic: 5000 additions each round by up to 2^-54 of 0.05 m and 0.6 m/s
  EXPECT_NEAR(grains.store().position[0][0], 0.025 + 0.3 * t, 2e-14);
  EXPECT_NEAR(grains.store().position[0][2], 0.03 + 0.5 * t - 0.5 * gravity * t * t, 2e-14);
  EXPECT_NEAR(grains.store().velocity[0][2], 0.5 - gravity * t, 2e-13);
  EXPECT_EQ(grains.store().angular_velocity[0], Vec3(10.0, 20.0, 30.0));
}

double rebound(Integrator integrator, double restitution, double steps, double phase) {
  const double mass = test::glass_sphere(0, Vec3::Zero()).mass();
  const ContactParameters contact = test::glass(restitution, true);
  const double dt = contact_time(contact.normal_stiffness, mass, Damping(contact).coefficient(mass)) / steps;
  const double height = test::glass_radius + (2.0 + phase) * dt * 0.1;
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, parameters_of(integrator, restitution, dt, 0.0),
                       {test::glass_sphere(0, Vec3(0.025, 0.025, height), Vec3(0, 0, -0.1))});
  for (int n = 0; n < 4 * steps; ++n) test::step(grains);
  return grains.store().velocity[0][2] / 0.1;
}

double worst_rebound(Integrator integrator, int steps) {
  double worst = 0.0;
  for (int phase = 0; phase < 20; ++phase)
    for (const double part : {0.0, 0.2, 0.4, 0.6, 0.8})
      worst = std::max(worst, std::abs(rebound(integrator, 1.0, steps + part, phase / 20.0) - 1.0));
  return worst;
}

// The force of a contact sets in with a kink, between two steps: with a dt-long piece of the motion on the wrong side
// of it, the energy is off by up to (omega_0 dt)^2/8 of itself and the speed by half of that or less, in any
// integrator: at 50 steps a contact (omega_0 dt = pi/50) 4.9e-4 for an overlap on one side, and the order is two.
TEST(Gear, HasNoAdvantageInAnImpact) {
  for (const int steps : {25, 50, 100}) {
    const double bound = std::pow(std::numbers::pi / steps, 2) / 8.0;
    const double verlet = worst_rebound(Integrator::velocity_verlet, steps);
    const double gear = worst_rebound(Integrator::gear, steps);
    EXPECT_LT(gear, bound);
    EXPECT_GT(gear, 0.5 * bound);
    EXPECT_NEAR(gear, verlet, 0.02 * verlet);
  }
}

// The columns of another kind of run are not those of the predictor, though there are as many of both.
TEST(Gear, DoesNotTakeOtherColumnsForItsOwn) {
  GrainParameters p = parameters_of(Integrator::velocity_verlet, 0.9, 2e-6, 0.0);
  const GrainSeed seed = test::glass_sphere(0, Vec3(0.025, 0.025, 0.025), Vec3(0.1, 0.0, 0.0));
  p.attached_width = 24 + GearPredictor::columns;
  GrainDynamics other(test::cube(), MPI_COMM_SELF, p, {seed});
  std::fill(other.store().attached.begin(), other.store().attached.end(), 7.0);
  const thalweg::test::MemoryArchive archive = thalweg::test::saved(other, MPI_COMM_SELF);
  const auto taken = [&archive, &p] {
    GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, GrainSeeds{});
    thalweg::test::MemoryReader reader(archive);
    grains.take(reader);
    return grains.store().attached;
  };
  EXPECT_EQ(taken(), std::vector<double>(42, 7.0));  // of a run like the other
  p.attached_width = 24;
  p.integrator = Integrator::gear;
  EXPECT_EQ(taken(), std::vector<double>(42, 0.0));
}

}  // namespace
}  // namespace thalweg::dem::gear_test
