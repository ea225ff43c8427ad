// The film of a liquid in a contact: its dashpot, and what it leaves of a rebound.
#include "dem/laws/contact_film.hpp"
#include "core/parallel/mpi_session.hpp"
#include "dem/laws/material.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::dem::contact_film_test {
namespace {

constexpr double water = 1e-3;  // Pa s
const double mass = test::glass_sphere(0, Vec3::Zero()).mass();

// m/s, of a sphere that meets a wall: St = m v/(6 pi eta R^2).
double speed_at(double stokes) {
  return stokes * 6.0 * std::numbers::pi * water * test::glass_radius * test::glass_radius / mass;
}

ContactMotion motion_along_normal(double closing, double radius) {
  return {.overlap = 1e-6, .nx = 0, .ny = 0, .nz = 1, .vx = 0, .vy = 0, .vz = -closing, .effective_radius = radius};
}

TEST(ContactFilm, IsCriticalAtRestAndHalfAtItsStokesNumber) {
  const ContactFilm film(water);
  const double stiffness = 300.0, critical = 2.0 * std::sqrt(stiffness * mass);
  const auto at = [&](double stokes) {
    return film(motion_along_normal(speed_at(stokes), test::glass_radius), speed_at(stokes), critical, stiffness);
  };
  EXPECT_DOUBLE_EQ(at(0.0).along, critical);
  EXPECT_NEAR(at(15.0).along, 0.5 * critical, 1e-12 * critical);
  EXPECT_NEAR(at(150.0).along, critical / 101.0, 1e-12 * critical);
  EXPECT_NEAR(at(15.0).across, 2.0 / 7.0 * at(15.0).along, 1e-15);
}

// Half the mass of two equal spheres counts and half the radius: St is twice as large at the same speed of approach.
TEST(ContactFilm, OfTwoSpheresIsThatOfAWallAtTwiceTheSpeed) {
  const ContactFilm film(water);
  const double stiffness = 300.0;
  const auto share = [&](double effective_mass, double radius, double speed) {
    const double critical = 2.0 * std::sqrt(stiffness * effective_mass);
    return film(motion_along_normal(speed, radius), speed, critical, stiffness).along / critical;
  };
  for (const double stokes : {3.0, 15.0, 80.0})
    EXPECT_NEAR(share(0.5 * mass, 0.5 * test::glass_radius, speed_at(stokes)),
                share(mass, test::glass_radius, 2.0 * speed_at(stokes)), 1e-12);
}

// A sphere falls on the floor without weight: e.
double rebound(const ContactParameters& contact, double speed) {
  const double dt = contact_time(contact.normal_stiffness, mass, 0.0) / 400.0;
  GrainParameters p = test::parameters(contact, dt, 1, 5e-4);
  p.walls = {face_plane(test::cube().box(), 2, false, contact.wall_friction)};
  GrainDynamics grains(
      test::cube(), MPI_COMM_SELF, p,
      {test::glass_sphere(0, Vec3(0.025, 0.025, test::glass_radius + 2.3 * dt * speed), Vec3(0, 0, -speed))});
  for (int n = 0; n < 4000; ++n) test::step(grains);
  return std::max(0.0, grains.store().velocity[0][2] / speed);
}

// x'' = -x - 2 [zeta + g(x')] x', g = 1/(1 + (s x')^2), from x = 0 at the speed 1 to where the force ends, in units of
// the impact speed and the spring; s: St over 15. By steps small enough that four digits stand.
double restitution_by_equation(double zeta, double s) {
  constexpr double h = 1e-4;
  double x = 0.0, v = 1.0;
  const auto force = [&](double at, double speed) {
    return at + 2.0 * (zeta + 1.0 / (1.0 + s * s * speed * speed)) * speed;
  };
  for (;;) {
    const double half = v - 0.5 * h * force(x, v), middle = x + 0.5 * h * v;
    const double next = v - h * force(middle, half);
    x += h * half;
    v = next;
    if (v < 0.0 && force(x, v) <= 0.0) return -v;
  }
}

// The film does not pull, so that its contacts end without a force whether or not the dry dashpot may pull.
TEST(ContactFilm, ReboundsObeyTheEquation) {
  ContactParameters contact = test::glass(0.93);
  contact.film_viscosity = water;
  const double zeta = damping_ratio_of_restitution(0.93, false);
  for (const double stokes : {10.0, 40.0, 150.0, 1000.0})
    // The error of the integrator at 400 steps a contact, as in normal_impact_test.cpp.
    EXPECT_NEAR(rebound(contact, speed_at(stokes)), restitution_by_equation(zeta, stokes / 15.0), 4e-3) << stokes;
}

// A dry dashpot that may pull slows the end of the contact by less than its own damping ratio.
TEST(ContactFilm, DoesNotHoldGrainsTogether) {
  ContactParameters contact = test::glass(0.93);
  contact.film_viscosity = water;
  const double pushing = rebound(contact, speed_at(10.0));
  contact.attraction = true;
  EXPECT_NEAR(rebound(contact, speed_at(10.0)), pushing, damping_ratio_of_restitution(0.93, true));
}

// A fast impact is that of dry grains, a slow one leaves less than a critical contact, exp(-2).
TEST(ContactFilm, FastImpactsAreDryAndSlowOnesEnd) {
  ContactParameters contact = test::glass(0.93);
  contact.film_viscosity = water;
  // 1 - e = 2 pi (15/St)^2 for large St, by the work of the film in an undisturbed swing.
  EXPECT_NEAR(rebound(contact, speed_at(5000.0)), 0.93, 1e-3);
  EXPECT_LE(rebound(contact, speed_at(1.0)), std::exp(-2.0));
}

// Elastic spheres: the same film, whose dashpot goes with theirs.
TEST(ContactFilm, StopsElasticSpheresToo) {
  ContactParameters contact = test::glass(0.93);
  contact.law = Law::hertz_mindlin;
  contact.youngs_modulus = 1e7;
  contact.poisson_ratio = 0.3;
  contact.normal_stiffness = 50.0;  // only for the step: shorter than a contact of these spheres
  const double dry = rebound(contact, speed_at(1.0));
  contact.film_viscosity = water;
  EXPECT_NEAR(dry, 0.93, 5e-3);
  EXPECT_LE(rebound(contact, speed_at(1.0)), std::exp(-2.0));
}

}  // namespace
}  // namespace thalweg::dem::contact_film_test
