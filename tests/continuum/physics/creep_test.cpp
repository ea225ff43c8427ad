// Creep below the surface of a bed: an exact solution, order two, and the lengths of the paper's beds.
#include "continuum/granular_fluidity.hpp"
#include "core/base/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::continuum::creep_test {
namespace {

const Mixture glass_in_water{1000.0, 1e-3, 2550.0, 5e-3};
const Rheology paper;
constexpr double amplitude = 0.43;
const double local = local_rate_coefficient(paper);

// Where g'' = 0 the fluidity follows from the stress ratio alone: the inertial number g mu d sqrt(rho_s/p) then has
// that friction.
TEST(Creep, ObeysTheFlowRuleWhereItIsEven) {
  const double pressure = 80.0, mu = 0.5;
  const double growth =
      (paper.limit_friction - paper.static_friction) * (mu - paper.static_friction) / (paper.limit_friction - mu);
  const double fluidity = growth / (local * std::sqrt(2550.0 / pressure) * 5e-3 * mu);
  const double inertial = inertial_number(glass_in_water, fluidity * mu, pressure);
  EXPECT_NEAR(friction(paper, 0.0, inertial, 0.0), mu, 1e-12);
}

// With mu constant and so little fluidity that its square does not count, g = g_0 sinh(z/xi)/sinh(L/xi).
double error_at_half(int points) {
  const double height = 8.0 * 5e-3, mu = 0.2;
  BedStress stress;
  stress.spacing = height / (points - 1);
  stress.pressure.assign(static_cast<std::size_t>(points), 100.0);
  stress.shear_stress.assign(static_cast<std::size_t>(points), 100.0 * mu);
  const double xi = amplitude * 5e-3 * std::sqrt((0.70 - mu) / ((0.70 - 0.37) * (0.37 - mu)));
  const Creep creep = creep_of(paper, glass_in_water, amplitude, local, stress, 1e-9);
  return creep.fluidity[static_cast<std::size_t>(points / 2)] /
             (1e-9 * std::sinh(0.5 * height / xi) / std::sinh(height / xi)) -
         1.0;
}

TEST(Creep, ConstantStressRatioOfSecondOrder) {
  EXPECT_NEAR(error_at_half(801), 0.0, 1e-4);
  EXPECT_NEAR(error_at_half(101) / error_at_half(201), 4.0, 0.1);
}

// Lengths of an independent solution by finite differences, to 2 %: e-folds 0.98, 0.96 and 0.95 diameters and decades
// of 2.26, 2.22 and 2.19, from 7 to 2 diameters deep, at slope 0.016. The paper says "about 2.5", of a decade.
TEST(Creep, LengthsOfThePapersBeds) {
  const double d = 5e-3, angle = std::atan(0.016), gravity = 9.8;
  const double shields[] = {0.0471, 0.085, 0.1408}, e_fold[] = {0.98, 0.96, 0.95}, decade[] = {2.26, 2.22, 2.19};
  for (int n = 0; n < 3; ++n) {
    const BedStress stress = resting_bed(paper, glass_in_water, gravity * std::sin(angle), gravity * std::cos(angle),
                                         shields[n] * 1550.0 * gravity * d, 10.0 * d, 2.0 * d, 801);
    const Creep creep = creep_of(paper, glass_in_water, amplitude, local, stress, 1e-2);
    const double length = decay_length(creep, stress.spacing, 300) / d;
    EXPECT_NEAR(length, e_fold[n], 0.02 * e_fold[n]);
    EXPECT_NEAR(length * std::numbers::ln10, decade[n], 0.02 * decade[n]);
  }
}

// Where much of the bed is between mu_1 and mu_2, Newton's method ends at fluidities below zero, which are no solution.
TEST(Creep, RefusesANegativeFluidity) {
  const double d = 5e-3, angle = std::atan(0.18), gravity = 9.8;
  const BedStress stress = resting_bed(paper, glass_in_water, gravity * std::sin(angle), gravity * std::cos(angle),
                                       0.1 * 1550.0 * gravity * d, 10.0 * d, 2.0 * d, 801);
  EXPECT_THROW(creep_of(paper, glass_in_water, amplitude, local, stress, 1e-2), InputError);
}

TEST(Creep, StressRatiosOfABedAtRest) {
  // At 2 d: 0.62 * 1550 * 9.8 * 0.01 = 94.178 Pa; tau_b + (0.62 * 2550 + 0.38 * 1000) 9.8 * 0.016 * 0.01 = 6.45575
  // + 3.0748 Pa
  const BedStress stress = resting_bed(paper, glass_in_water, 9.8 * 0.016, 9.8, 6.45575, 0.05, 0.01, 5);
  EXPECT_NEAR(stress.pressure.back(), 94.178, 1e-9);
  EXPECT_NEAR(stress.shear_stress.back(), 6.45575 + 3.0748480, 1e-6);
  EXPECT_NEAR(stress.pressure.front(), 470.89, 1e-9);
}

TEST(Creep, NoSteadyStateBeyondTheLimitFriction) {
  BedStress stress;
  stress.spacing = 1e-3;
  stress.pressure.assign(10, 10.0);
  stress.shear_stress.assign(10, 7.5);
  EXPECT_THROW(creep_of(paper, glass_in_water, amplitude, local, stress, 1.0), InputError);
}

}  // namespace
}  // namespace thalweg::continuum::creep_test
