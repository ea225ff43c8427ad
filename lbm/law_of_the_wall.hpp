// The law of the wall: mean velocity u at a distance y from a smooth wall in a turbulent boundary layer,
//   u+ = y+                      in the viscous sublayer, up to y+ = 10.8 where the two meet,
//   u+ = ln(y+)/0.41 + 5         beyond,          u+ = u/u_tau,  y+ = y u_tau/nu          (Zhang et al. 2022, A4).
// u_tau is the friction velocity; the wall takes the stress rho u_tau^2.
#pragma once

#include <cmath>

namespace thalweg::lbm {

constexpr double karman_constant = 0.41, wall_intercept = 5.0;
constexpr double edge_of_viscous_sublayer = 10.804870814050255;  // where y+ = ln(y+)/0.41 + 5

// u+ at y+ beyond the sublayer.
inline double logarithmic_law(double y_plus) { return std::log(y_plus) / karman_constant + wall_intercept; }

// u_tau where the velocity is `speed` (at least 0) at `distance` (above 0) from the wall, in any consistent units.
//
// Solves y+ u+(y+) = speed distance/nu. Beyond the sublayer u+ is nearly linear in the logarithm of this number, which
// gives a first guess to 2.3 %; two steps of Newton's method make 7e-11 of it.
inline double friction_velocity(double speed, double distance, double viscosity) {
  const double reynolds = speed * distance / viscosity;
  if (reynolds <= edge_of_viscous_sublayer * edge_of_viscous_sublayer) return std::sqrt(viscosity * speed / distance);
  double y_plus = reynolds / (0.33 + 2.2 * std::log(reynolds));
  for (int step = 0; step < 2; ++step) {
    const double u_plus = logarithmic_law(y_plus);
    y_plus -= (y_plus * u_plus - reynolds) / (u_plus + 1.0 / karman_constant);
  }
  return y_plus * viscosity / distance;
}

}  // namespace thalweg::lbm
