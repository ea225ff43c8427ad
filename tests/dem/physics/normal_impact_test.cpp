// Head-on impacts, on a wall and of two spheres: restitution, duration, order of the integrator.
#include "core/parallel/mpi_session.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::dem::normal_impact_test {
namespace {

constexpr double impact_speed = 0.1;  // m/s

struct Outcome {
  double restitution;
  double duration;  // s, in steps of the integrator
};

GrainParameters impact_parameters(const ContactParameters& contact, double time_step) {
  GrainParameters p = test::parameters(contact, time_step, 1, 5e-4);
  p.walls = {face_plane(test::cube().box(), 2, false, contact.wall_friction)};
  return p;
}

// A sphere against the floor with `steps` per contact time; phase: where in a step the contact begins.
Outcome fall_on_wall(const ContactParameters& contact, double steps, double phase) {
  const double mass = test::glass_sphere(0, Vec3::Zero()).mass();
  const double t_c = contact_time(contact.normal_stiffness, mass, Damping(contact).coefficient(mass));
  const double dt = t_c / steps;
  const double height = test::glass_radius + (2.0 + phase) * dt * impact_speed;
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, impact_parameters(contact, dt),
                       {test::glass_sphere(0, Vec3(0.025, 0.025, height), Vec3(0, 0, -impact_speed))});
  int touching = 0;
  for (int n = 0; n < 20 * steps; ++n) {
    test::step(grains);
    if (!grains.contacts().empty())
      ++touching;
    else if (touching > 0)
      break;
  }
  return {grains.store().velocity[0][2] / impact_speed, touching * dt};
}

// The largest error over where in a step the contact begins and, with a contact time of steps + part steps, ends.
double worst_error(const ContactParameters& contact, double steps, const std::vector<double>& parts) {
  double worst = 0.0;
  for (const double part : parts)
    for (int phase = 0; phase < 20; ++phase) {
      const double found = fall_on_wall(contact, steps + part, phase / 20.0).restitution;
      worst = std::max(worst, std::abs(found - *contact.restitution));
    }
  return worst;
}

TEST(NormalImpact, RestitutionIsTheOneAskedForWithBothEndings) {
  // The error falls with the step (see below): 1000 steps leave 1/20 of that at 50.
  for (const bool attraction : {false, true})
    for (const double e : {1.0, 0.93, 0.5, 0.2})
      EXPECT_NEAR(fall_on_wall(test::glass(e, attraction), 1000.0, 0.3).restitution, e, 1.5e-3) << e << attraction;
}

TEST(NormalImpact, LastsTheContactTime) {
  const double mass = test::glass_sphere(0, Vec3::Zero()).mass();
  for (const double e : {1.0, 0.93, 0.5}) {
    const ContactParameters contact = test::glass(e, true);
    const double t_c = contact_time(contact.normal_stiffness, mass, Damping(contact).coefficient(mass));
    EXPECT_NEAR(fall_on_wall(contact, 500.0, 0.3).duration, t_c, 3.0 * t_c / 500.0) << e;
  }
}

// A glass sphere at rest is met by one of another radius (m) with 500 steps in the duration (s): how long they touch.
double duration_of_collision(const ContactParameters& contact, double radius, double duration) {
  const double dt = duration / 500.0, distance = test::glass_radius + radius + 2.3 * dt * impact_speed;
  GrainParameters p = impact_parameters(contact, dt);
  p.walls.clear();
  const Vec3 place(0.02, 0.025, 0.025);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p,
                       {test::glass_sphere(0, place, Vec3(impact_speed, 0, 0)),
                        test::glass_sphere(1, place + Vec3(distance, 0, 0), Vec3::Zero(), radius)});
  int touching = 0;
  for (int n = 0; n < 1000; ++n) {
    test::step(grains);
    if (!grains.contacts().empty()) ++touching;
  }
  return touching * dt;
}

// Half a period of the damped spring, whatever the loss and the two masses.
TEST(NormalImpact, LastsAsLongAsTheStiffnessIsFor) {
  const double mass = test::glass_sphere(0, Vec3::Zero()).mass(), duration = 1.2e-3;
  for (const double radius : {test::glass_radius, 1.5e-3}) {
    const double other = mass * std::pow(radius / test::glass_radius, 3), effective = mass * other / (mass + other);
    for (const double e : {1.0, 0.93, 0.5}) {
      ContactParameters by_loss = test::glass(e, true);
      by_loss.normal_stiffness = stiffness_lasting(duration, by_loss, effective);
      EXPECT_NEAR(duration_of_collision(by_loss, radius, duration), duration, 3.0 * duration / 500.0) << radius << e;
      EXPECT_NEAR(contact_time(by_loss.normal_stiffness, effective, Damping(by_loss).coefficient(effective)), duration,
                  1e-12 * duration);
      ContactParameters by_dashpot = by_loss;
      by_dashpot.restitution.reset();
      by_dashpot.damping = Damping(by_loss).coefficient(effective);
      EXPECT_NEAR(stiffness_lasting(duration, by_dashpot, effective), by_loss.normal_stiffness,
                  1e-9 * by_loss.normal_stiffness);
    }
  }
}

// The error of the restitution at so many steps a contact, at most, for a damping ratio zeta: at either end up to dt/2
// of the dashpot, 2 zeta omega v, is missed or counted twice, and in between it sees the velocity of half a step ago,
// as if the grain were lighter by zeta omega dt of its mass.
double error_of_dashpot(double restitution, double steps) {
  const double loss = std::log(restitution), zeta = -loss / std::hypot(std::numbers::pi, loss);
  const double undamped = std::sqrt(1.0 - zeta * zeta), omega_dt = std::numbers::pi / (steps * undamped);
  return restitution * zeta * omega_dt * (2.0 + 0.5 * std::numbers::pi * zeta / std::pow(undamped, 3));
}

TEST(NormalImpact, ErrorsOfVelocityVerletAtFiftyStepsAContact) {
  const ContactParameters elastic = test::glass(1.0, true), glass = test::glass(0.93, true),
                          soft = test::glass(0.2, true);
  const std::vector<double> whole{0.0}, any{0.0, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9};
  const auto order = [](const ContactParameters& contact, const std::vector<double>& parts) {
    return std::log2(worst_error(contact, 50.0, parts) / worst_error(contact, 100.0, parts));
  };
  // Elastic, a whole number N of steps a contact: the errors of its two ends cancel, but the spring swings too fast by
  // (omega dt)^2/24, and half a step of its last force is missed: pi^4/(48 N^3).
  EXPECT_NEAR(worst_error(elastic, 50.0, whole), std::pow(std::numbers::pi, 4) / (48.0 * 50.0 * 50.0 * 50.0), 5e-7);
  EXPECT_NEAR(order(elastic, whole), 3.0, 0.1);
  // Any number: an end in the middle of a step misses (omega dt)^2/8 of the speed.
  const double bound = std::pow(std::numbers::pi / 50.0, 2) / 8.0;
  EXPECT_LT(worst_error(elastic, 50.0, any), bound);
  EXPECT_GT(worst_error(elastic, 50.0, any), 0.9 * bound);
  EXPECT_NEAR(order(elastic, any), 2.0, 0.1);
  // With damping: first order.
  EXPECT_LT(worst_error(glass, 50.0, any), error_of_dashpot(0.93, 50.0));
  EXPECT_NEAR(order(glass, any), 1.0, 0.1);
  EXPECT_LT(worst_error(soft, 50.0, whole), error_of_dashpot(0.2, 50.0));
  EXPECT_NEAR(order(soft, whole), 1.0, 0.1);
}

TEST(NormalImpact, SpheresOfDifferentSizePartWithTheRestitution) {
  // Across a periodic face and in a slanted direction; the damping follows the effective mass of the pair.
  for (const bool attraction : {false, true}) {
    GrainParameters p = impact_parameters(test::glass(0.8, attraction), 2e-7);
    p.walls.clear();
    p.sub_steps = 20;
    const Vec3 direction = Vec3(2.0, 1.0, 2.0) / 3.0;
    const double radius = 1.5e-3, distance = test::glass_radius + radius + 1e-6;
    const Vec3 first(0.0495, 0.0251, 0.0249);
    const PeriodicBox box = test::cube().box();
    GrainDynamics grains(test::cube(), MPI_COMM_SELF, p,
                         {test::glass_sphere(0, first, impact_speed * direction),
                          test::glass_sphere(1, box.wrapped(first + distance * direction), Vec3::Zero(), radius)});
    for (int n = 0; n < 250; ++n) test::step(grains);  // 1 ms: about six contact times
    const GrainStore& s = grains.store();
    const Vec3 parting = s.velocity[1] - s.velocity[0];
    EXPECT_NEAR(parting.dot(direction), 0.8 * impact_speed, 1e-3 * impact_speed);
    EXPECT_NEAR((parting - parting.dot(direction) * direction).norm(), 0.0, 1e-9 * impact_speed);
    const Vec3 momentum = s.mass[0] * s.velocity[0] + s.mass[1] * s.velocity[1];
    EXPECT_NEAR((momentum - s.mass[0] * impact_speed * direction).norm(), 0.0, 1e-13 * s.mass[0] * impact_speed);
  }
}

}  // namespace
}  // namespace thalweg::dem::normal_impact_test
