#include "dem/laws/material.hpp"

#include "core/base/error.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::dem::material_test {
namespace {

// Restitution of m x'' + gamma x' + k x = 0 with m = k = 1 by classical Runge-Kutta steps of 1e-4: no closed form.
double restitution_by_integration(double zeta, bool attraction) {
  const double h = 1e-4, gamma = 2.0 * zeta;
  const auto force = [&](double x, double v) {
    const double pressed = x + gamma * v;  // x: overlap, v: its rate
    return attraction ? -pressed : -std::max(pressed, 0.0);
  };
  double x = 0.0, v = 1.0;
  for (int step = 0; step < 10'000'000; ++step) {
    const double k1x = v, k1v = force(x, v);
    const double k2x = v + 0.5 * h * k1v, k2v = force(x + 0.5 * h * k1x, v + 0.5 * h * k1v);
    const double k3x = v + 0.5 * h * k2v, k3v = force(x + 0.5 * h * k2x, v + 0.5 * h * k2v);
    const double k4x = v + h * k3v, k4v = force(x + h * k3x, v + h * k3v);
    x += h / 6.0 * (k1x + 2.0 * k2x + 2.0 * k3x + k4x);
    v += h / 6.0 * (k1v + 2.0 * k2v + 2.0 * k3v + k4v);
    if (x <= 0.0 || (!attraction && x + gamma * v <= 0.0)) return -v;
  }
  return 0.0;
}

TEST(Restitution, ClosedFormsAreThoseOfTheDifferentialEquation) {
  // The event is found to one step of 1e-4, during which the velocity changes by less than 1e-4.
  for (const double zeta : {0.01, 0.0231, 0.2, 0.6, 0.8, 0.95})
    EXPECT_NEAR(restitution_of_damping_ratio(zeta, true), restitution_by_integration(zeta, true), 2e-4) << zeta;
  for (const double zeta : {0.01, 0.0231, 0.2, 0.6, 0.8, 0.95, 1.0, 1.2, 3.0})
    EXPECT_NEAR(restitution_of_damping_ratio(zeta, false), restitution_by_integration(zeta, false), 2e-4) << zeta;
}

TEST(Restitution, KnownPairsOfGlassSpheres) {
  const double mass = test::glass_sphere(0, Vec3::Zero()).mass();
  // 5 mm spheres, k = 20000 N/m: damping ratio and damping that give 0.93 where attraction is allowed, and what the
  // same damping gives without (last digits printed).
  EXPECT_NEAR(damping_ratio_of_restitution(0.93, true), 0.023094, 5e-7);
  EXPECT_NEAR(Damping(test::glass(0.93, true)).coefficient(0.5 * mass), 0.05967, 5e-6);
  EXPECT_NEAR(Damping(test::glass(0.93, true)).coefficient(mass), 0.0844, 5e-5);
  EXPECT_NEAR(restitution_of_damping_ratio(0.023094, false), 0.9310, 5e-5);
  // gamma = 0.09 and 2.11 kg/s against a wall and of a pair, both endings.
  const auto zeta = [&](double gamma, double m) { return gamma / (2.0 * std::sqrt(20000.0 * m)); };
  EXPECT_NEAR(restitution_of_damping_ratio(zeta(0.09, mass), true), 0.9255, 5e-5);
  EXPECT_NEAR(restitution_of_damping_ratio(zeta(0.09, 0.5 * mass), true), 0.8963, 5e-5);
  EXPECT_NEAR(restitution_of_damping_ratio(zeta(2.11, mass), true), 0.1084, 5e-5);
  EXPECT_NEAR(restitution_of_damping_ratio(zeta(2.11, 0.5 * mass), true), 0.0117, 5e-5);
  EXPECT_NEAR(restitution_of_damping_ratio(zeta(0.09, mass), false), 0.927, 5e-4);
  EXPECT_NEAR(restitution_of_damping_ratio(zeta(0.09, 0.5 * mass), false), 0.8985, 1e-4);
  EXPECT_NEAR(restitution_of_damping_ratio(zeta(2.11, mass), false), 0.259, 5e-4);
  EXPECT_NEAR(restitution_of_damping_ratio(zeta(2.11, 0.5 * mass), false), 0.175, 5e-4);
  EXPECT_NEAR(contact_time(20000.0, mass, 0.09), 2.871e-4, 5e-8);
  EXPECT_NEAR(contact_time(20000.0, 0.5 * mass, 0.09), 2.031e-4, 5e-8);
}

TEST(Restitution, InverseIsExact) {
  for (const bool attraction : {false, true})
    for (const double e : {1.0, 0.99, 0.93, 0.5, 0.14, 0.1, 0.01})
      EXPECT_NEAR(restitution_of_damping_ratio(damping_ratio_of_restitution(e, attraction), attraction), e, 1e-13) << e;
}

// m* (pi/t)^2/max(1 - zeta^2, zeta^2): at zeta = 1, which is e = exp(-2), m* (pi/t)^2 from both sides.
TEST(Stiffness, GoesOnWhereNothingSwings) {
  constexpr double mass = 1e-4, duration = 5e-4, limit = mass * std::numbers::pi * std::numbers::pi / 25e-8;
  for (const double e : {0.3, 0.2, 0.16, 0.1354, 0.1353, 0.13, 0.05}) {
    ContactParameters contact = test::glass(e);
    contact.normal_stiffness = stiffness_lasting(duration, contact, mass);
    EXPECT_NEAR(contact_time(contact.normal_stiffness, mass, Damping(contact).coefficient(mass)), duration,
                1e-12 * duration)
        << e;
  }
  for (const double e : {0.999 * std::exp(-2.0), 1.001 * std::exp(-2.0)})
    EXPECT_NEAR(stiffness_lasting(duration, test::glass(e), mass), limit, 0.01 * limit);
  // A contact that may pull ends with its overlap, after half a period, however slow that is.
  const double zeta = damping_ratio_of_restitution(0.01, true);
  EXPECT_NEAR(stiffness_lasting(duration, test::glass(0.01, true), mass), limit / (1.0 - zeta * zeta), 1e-9 * limit);
}

TEST(ContactParameters, RefusesTheImpossible) {
  ContactParameters contact = test::glass(0.9);
  EXPECT_NO_THROW(check(contact));
  contact.damping = 0.1;
  EXPECT_THROW(check(contact), InputError);
  contact.restitution.reset();
  EXPECT_NO_THROW(check(contact));
  contact.damping.reset();
  EXPECT_THROW(check(contact), InputError);
  EXPECT_THROW(check(test::glass(0.0)), InputError);
  EXPECT_THROW(check(test::glass(1.01)), InputError);
  contact = test::glass(0.9);
  contact.normal_stiffness = 0.0;
  EXPECT_THROW(check(contact), InputError);
}

TEST(ContactParameters, TimeStepIsATwentiethOfTheContactTime) {
  const double mass = 1e-4, longest = std::numbers::pi * std::sqrt(mass / 20000.0) / 20.0;
  EXPECT_NO_THROW(check_time_step(test::glass(1.0), mass, test::glass_radius, 0.999 * longest));
  EXPECT_THROW(check_time_step(test::glass(1.0), mass, test::glass_radius, 1.001 * longest), InputError);
  EXPECT_THROW(check_time_step(test::glass(1.0), mass, test::glass_radius, 0.0), InputError);
}

TEST(Mixing, SpringsInSeriesAndGeometricMeans) {
  ContactParameters a = test::glass(0.9), b = test::glass(0.4);
  b.normal_stiffness = 60000.0;
  b.tangential_stiffness = 0.0;
  b.friction = 0.02;
  const ContactParameters m = mixed(a, b);
  EXPECT_NEAR(m.normal_stiffness, 30000.0, 1e-9);  // 2/(1/20000 + 1/60000)
  EXPECT_EQ(m.tangential_stiffness, 0.0);
  EXPECT_NEAR(*m.restitution, 0.6, 1e-15);
  EXPECT_NEAR(m.friction, 0.1, 1e-15);
  EXPECT_EQ(mixed(a, a).normal_stiffness, a.normal_stiffness);
  EXPECT_EQ(mixed(a, a).friction, a.friction);
  b.attraction = true;
  EXPECT_THROW(mixed(a, b), InputError);
}

TEST(Mixing, ModuliKeepTheirOwners) {
  // Steel on rubber is as stiff as rubber on a rigid body, up to the ratio of the moduli, 5e-5.
  ContactParameters steel = test::glass(0.9), rubber = test::glass(0.9);
  steel.law = rubber.law = Law::hertz_mindlin;
  steel.youngs_modulus = 200e9, steel.poisson_ratio = 0.3;
  rubber.youngs_modulus = 10e6, rubber.poisson_ratio = 0.5;
  const HertzMindlin::Coefficients c = HertzMindlin::between(steel, rubber);
  EXPECT_NEAR(c.normal, 4.0 / 3.0 * 10e6 / 0.75, 1e-4 * 1.8e7);
  EXPECT_NEAR(c.tangential, 8.0 * (10e6 / 3.0) / 1.5, 1e-4 * 1.8e7);
  rubber.damping = 0.1, rubber.restitution.reset();
  EXPECT_THROW(check(rubber), InputError);
}

TEST(Mixing, GrainsOfTwoMaterialsAndAWallPartWithTheirRestitutions) {
  // 0 on 1: sqrt(0.9 0.4) = 0.6; both on the wall: 0.7. Slow impacts at 1400 steps a contact: error of first order.
  GrainParameters p = test::parameters(test::glass(0.9), 1.5e-7, 50);
  p.other_materials = {test::glass(0.4)};
  p.wall_contact = test::glass(0.7);
  p.walls = {face_plane(test::cube().box(), 2, false, 0.0)};
  const double apart = 2.0 * test::glass_radius + 1e-6;
  std::vector<GrainSeed> seeds{test::glass_sphere(0, Vec3(0.01, 0.01, 0.02), Vec3(0.1, 0, 0)),
                               test::glass_sphere(1, Vec3(0.01 + apart, 0.01, 0.02)),
                               test::glass_sphere(2, Vec3(0.01, 0.03, 0.02), Vec3(0.1, 0, 0)),
                               test::glass_sphere(3, Vec3(0.01 + apart, 0.03, 0.02)),
                               test::glass_sphere(4, Vec3(0.04, 0.01, test::glass_radius + 1e-6), Vec3(0, 0, -0.1)),
                               test::glass_sphere(5, Vec3(0.04, 0.03, test::glass_radius + 1e-6), Vec3(0, 0, -0.1))};
  for (const int id : {1, 2, 3, 5}) seeds[id].material = 1;
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, seeds);
  for (int n = 0; n < 120; ++n) test::step(grains);
  const auto v = [&](int id, int axis) { return grains.store().velocity[id][axis]; };
  EXPECT_NEAR(v(1, 0) - v(0, 0), 0.06, 3e-4);
  EXPECT_NEAR(v(3, 0) - v(2, 0), 0.04, 3e-4);
  EXPECT_NEAR(v(4, 2), 0.07, 3e-4);
  EXPECT_NEAR(v(5, 2), 0.07, 3e-4);
  seeds[3].material = 2;
  EXPECT_THROW(GrainDynamics(test::cube(), MPI_COMM_SELF, p, seeds), InputError);
}

}  // namespace
}  // namespace thalweg::dem::material_test
