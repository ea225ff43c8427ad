// Every closure against values worked out by hand from the equations of Zhang et al. (2022).
#include "continuum/drag.hpp"
#include "continuum/granular_rheology.hpp"
#include "continuum/turbulence.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::continuum::closures_test {
namespace {

const Mixture glass_in_water{1000.0, 1e-3, 2550.0, 5e-3};
const Rheology paper;

// phi of eq. 21.
double flowing_fraction(double mixed) { return paper.densest_fraction / (1.0 + paper.dilation * mixed); }

// At 10 1/s and 2.55 Pa: I_v = 0.01/2.55, I = 10 * 5e-3 sqrt(1000), I_m = sqrt(2 I_v + I^2).
TEST(GranularRheology, NumbersAndFriction) {
  const double viscous = viscous_number(glass_in_water, 10.0, 2.55);
  EXPECT_NEAR(viscous, 3.9215686e-3, 1e-10);
  const double inertial = inertial_number(glass_in_water, 10.0, 2.55);
  EXPECT_NEAR(inertial, 1.5811388, 1e-7);
  const double mixed = mixed_number(viscous, inertial);
  EXPECT_NEAR(mixed, 1.5836172, 1e-7);  // sqrt(0.0078431 + 2.5)
  // 0.37 + 0.33/(1 + 5/1.5836172) + 2.5 * 0.3 * 0.0039216 (1/(0.7071068 * 1.5836172) + 1)
  EXPECT_NEAR(friction(paper, 0.3, mixed, viscous), 0.37 + 0.0793779 + 0.0029411765 * 1.8930201, 1e-6);
  EXPECT_NEAR(flowing_fraction(mixed), 0.62 / 2.1197865, 1e-7);
}

TEST(GranularRheology, AtRestFrictionIsStatic) { EXPECT_DOUBLE_EQ(friction(paper, 0.6, 0.0, 0.0), 0.37); }

// The pressure is the one at which eq. 21 gives back the solid fraction.
TEST(GranularRheology, FlowPressureInvertsTheFlowingFraction) {
  for (const double fraction : {0.05, 0.3, 0.6})
    for (const double rate : {0.1, 10.0, 100.0}) {
      const double p = flow_pressure(paper, glass_in_water, fraction, rate);
      const double mixed =
          mixed_number(viscous_number(glass_in_water, rate, p), inertial_number(glass_in_water, rate, p));
      EXPECT_NEAR(flowing_fraction(mixed), fraction, 1e-12);
    }
}

TEST(GranularRheology, ElasticPressureOnlyBeyondTheDensest) {
  EXPECT_EQ(elastic_pressure(paper, 0.62), 0.0);
  EXPECT_NEAR(elastic_pressure(paper, 0.621), 200.0, 1e-9);  // 2e5 Pa * 0.001
}

TEST(GranularRheology, StressActsAlongTheShearAndVanishesWithIt) {
  EXPECT_EQ(granular_stress(paper, glass_in_water, 0.6, 100.0, 0.0), 0.0);
  const double p = 2.55, stress = granular_stress(paper, glass_in_water, 0.3, p, 10.0);
  EXPECT_NEAR(stress, (0.37 + 0.0793779 + 0.0029411765 * 1.8930201) * p, 1e-5);  // creeping_rate: 2e-8 less
  EXPECT_DOUBLE_EQ(granular_stress(paper, glass_in_water, 0.3, p, -10.0), -stress);
}

// l_m: 3 * 5 mm * 0.62^3 = 3.57492 mm in clear water; at 0.5 0.026 mm, less than the floor of 1 mm.
TEST(Turbulence, MixingLengthAndItsFloor) {
  Turbulence turbulence;
  EXPECT_NEAR(mixing_length(turbulence, 5e-3, 0.62, 0.0), 3.57492e-3, 1e-9);
  EXPECT_NEAR(mixing_length(turbulence, 5e-3, 0.62, 0.5), 1e-3, 1e-15);
  turbulence.smallest_mixing_length = 0.0;
  EXPECT_NEAR(mixing_length(turbulence, 5e-3, 0.62, 0.5), 2.592e-5, 1e-15);
}

TEST(Turbulence, EddyViscosityAndDrift) {
  Turbulence turbulence;
  // (1 - 0.5) 1000 (1e-3)^2 20
  EXPECT_NEAR(eddy_viscosity(turbulence, glass_in_water, 0.62, 0.5, -20.0), 0.01, 1e-15);
  EXPECT_NEAR(drift_diffusivity(turbulence, glass_in_water, 0.01), 0.01 / 300.0, 1e-15);
  turbulence.strain_norm = StrainNorm::frobenius;
  EXPECT_NEAR(eddy_viscosity(turbulence, glass_in_water, 0.62, 0.5, 20.0), 0.01 / std::sqrt(2.0), 1e-15);
}

TEST(Drag, OfASingleSphere) {
  EXPECT_NEAR(single_sphere_drag(100.0), 1.0 + 0.15 * 23.6592, 1e-5);   // 100^0.687 = 23.6592
  EXPECT_NEAR(single_sphere_drag(2400.0), 44.0, 1e-12);                 // 0.44/24 * 2400
  EXPECT_NEAR(schiller_drag(0.5, 2400.0), 352.0, 1e-10);                // times 8
  EXPECT_NEAR(drag_reynolds(glass_in_water, 0.5, -0.2), 500.0, 1e-10);  // 0.5 * 0.2 * 5e-3/1e-6
}

TEST(Drag, OfManyGrains) {
  // In Stokes flow at phi = 0.25: 10/4/0.5625 + 0.5625 (1 + 0.75).
  EXPECT_NEAR(beetstra_drag(0.25, 0.0, DragCrowding::power), 4.4444444 + 0.984375, 1e-6);
  // At Re = 100: 100^-0.343 = 0.2060630, 100^-1 = 0.01, 10^0.75 = 5.6234133, 10^3 0.25 = 250.
  const double top = 1.0 / 0.75 + 0.5625 + 8.4 * 0.2060630, factor = 41.3 / (24.0 * 0.5625);
  EXPECT_NEAR(beetstra_drag(0.25, 100.0, DragCrowding::power), 5.4288194 + factor * top / 1.056234133, 1e-5);
  EXPECT_NEAR(beetstra_drag(0.25, 100.0, DragCrowding::printed), 5.4288194 + factor * top / 3.5, 1e-5);
  const double f2 = beetstra_drag(0.25, 100.0, DragCrowding::power);
  EXPECT_DOUBLE_EQ(drag_function({DragFunction::mobile, DragCrowding::power}, 0.25, 100.0), f2 / 0.75);
  EXPECT_DOUBLE_EQ(drag_function({DragFunction::beetstra, DragCrowding::power}, 0.25, 100.0), f2);
}

// 18 * 1e-3 * F/(5e-3)^2 = 720 F, with F -> 1 without grains at rest.
TEST(Drag, RateOfStokesFlow) { EXPECT_NEAR(drag_rate({}, glass_in_water, 0.0, 0.0), 720.0, 1e-9); }

}  // namespace
}  // namespace thalweg::continuum::closures_test
