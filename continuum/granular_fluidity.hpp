// Creep of the grains below the surface of a bed: nonlocal granular fluidity (Kamrin and Koval 2012; Zhang et al. 2022,
// eq. 29) in steady state, over the depth of the bed:
//
//   A^2 d^2 g'' = (mu_2 - mu_1)(mu_1 - mu)/(mu_2 - mu) g + b' sqrt(rho_s d^2/p) mu g^2,   dU_s/dz = g mu
//
// with the fluidity g given at the upper end and zero at the lower one, where U_s is zero, and mu the ratio of shear
// stress and pressure of the grains. Central differences on equal intervals, second order; Newton's method.
#pragma once

#include "continuum/granular_rheology.hpp"

#include <vector>

namespace thalweg::continuum {

// Stress of the grains at equal intervals, from the lower end up.
struct BedStress {
  double spacing = 0.0;                                                                    // m
  std::vector<double> pressure;                                                            // p, Pa, above zero
  std::vector<double> shear_stress;                                                        // Pa
  double ratio(std::size_t point) const { return shear_stress[point] / pressure[point]; }  // mu
};

struct Creep {
  std::vector<double> fluidity;        // g, 1/s
  std::vector<double> grain_velocity;  // U_s, m/s
};

// b' with which an even flow, g'' = 0, obeys the friction of eq. 20 without viscosity: (mu_2 - mu_1)/b. The paper
// prints one b in both.
double local_rate_coefficient(const Rheology& rheology);

// rate_coefficient: b'. surface_fluidity: 1/s, at the upper end. Throws InputError where mu is not below mu_2, where
// the fluidity found is negative somewhere, or there are fewer than three points, RunError where Newton's method fails.
Creep creep_of(const Rheology& rheology, const Mixture& mixture, double nonlocal_amplitude, double rate_coefficient,
               const BedStress& stress, double surface_fluidity);

// The depth in which U_s falls by a factor e, m: from the straight line of least squares through ln U_s at the points
// from `first` to the last one.
double decay_length(const Creep& creep, double spacing, std::size_t first);

// Stress in a bed at rest under a flow: p = phi_m (rho_s - rho_f) g_z depth, tau = tau_b + (phi_m rho_s + (1 - phi_m)
// rho_f) g_x depth, at `points` depths from `lower` up to `upper` (m). gravity: m/s^2; bed_stress: tau_b, Pa.
BedStress resting_bed(const Rheology& rheology, const Mixture& mixture, double gravity_x, double gravity_z,
                      double bed_stress, double lower, double upper, int points);

}  // namespace thalweg::continuum
