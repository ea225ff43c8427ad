// Flow rule of the grains (Zhang et al. 2022, section 3.1.1, after Baumgarten and Kamrin 2019):
//
//   I_v = eta g/p,   I = g d sqrt(rho_s/p),   I_m = sqrt(2 I_v + I^2)
//   mu  = mu_1 + (mu_2 - mu_1)/(1 + b/I_m) + 5/2 phi I_v/(a I_m) + 5/2 phi I_v      eq. 20
//   phi = phi_m/(1 + a I_m)                                                         eq. 21
//
// with the shear rate g and the pressure p of the grains. Solved for the pressure, eq. 21 is
//   p = a^2 phi^2 (2 eta g + rho_s d^2 g^2)/(phi_m - phi)^2.
// Grains denser than phi_m touch at rest: they carry an elastic pressure, which stands for their contacts and is not
// part of the paper.
#pragma once

#include "continuum/mixture.hpp"

namespace thalweg::continuum {

struct Rheology {
  double static_friction = 0.37;          // mu_1
  double limit_friction = 0.70;           // mu_2
  double densest_fraction = 0.62;         // phi_m
  double friction_scale = 5.0;            // b
  double dilation = 0.70710678118654752;  // a = sqrt(2)/2
  double elastic_modulus = 2e5;           // Pa, of grains denser than phi_m; here and below of glass of 5 mm in water
  double smallest_gap = 2e-3;             // phi_m - phi is no smaller in the flow's pressure
  double creeping_rate = 2e-3;            // 1/s, below which friction falls to zero with the shear rate
  bool operator==(const Rheology&) const = default;
};

// Pressures (Pa) must be above zero, shear rates (1/s) not negative.
double viscous_number(const Mixture& mixture, double shear_rate, double pressure);         // I_v
double inertial_number(const Mixture& mixture, double shear_rate, double pressure);        // I
double mixed_number(double viscous_number, double inertial_number);                        // I_m
double friction(const Rheology& rheology, double fraction, double mixed, double viscous);  // mu, of grains that flow

double flow_pressure(const Rheology& rheology, const Mixture& mixture, double fraction, double shear_rate);  // Pa
double elastic_pressure(const Rheology& rheology, double fraction);                                          // Pa

// Shear stress (Pa): mu p in the direction of the shear rate (1/s, either sign); where that is small, mu_1 p g/sqrt(g^2
// + creeping_rate^2).
double granular_stress(const Rheology& rheology, const Mixture& mixture, double fraction, double pressure,
                       double shear_rate);

}  // namespace thalweg::continuum
