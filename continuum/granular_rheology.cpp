#include "continuum/granular_rheology.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::continuum {

double viscous_number(const Mixture& mixture, double shear_rate, double pressure) {
  return mixture.viscosity * shear_rate / pressure;
}

double inertial_number(const Mixture& mixture, double shear_rate, double pressure) {
  return shear_rate * mixture.diameter * std::sqrt(mixture.grain_density / pressure);
}

double mixed_number(double viscous_number, double inertial_number) {
  return std::sqrt(2.0 * viscous_number + inertial_number * inertial_number);
}

double friction(const Rheology& rheology, double fraction, double mixed, double viscous) {
  if (!(mixed > 0.0)) return rheology.static_friction;
  return rheology.static_friction +
         (rheology.limit_friction - rheology.static_friction) / (1.0 + rheology.friction_scale / mixed) +
         2.5 * fraction * viscous * (1.0 / (rheology.dilation * mixed) + 1.0);
}

double flow_pressure(const Rheology& rheology, const Mixture& mixture, double fraction, double shear_rate) {
  const double gap = std::max(rheology.densest_fraction - fraction, rheology.smallest_gap);
  const double shear = shear_rate * mixture.diameter;
  const double ratio = rheology.dilation * fraction / gap;
  return ratio * ratio * (2.0 * mixture.viscosity * shear_rate + mixture.grain_density * shear * shear);
}

double elastic_pressure(const Rheology& rheology, double fraction) {
  return rheology.elastic_modulus * std::max(0.0, fraction - rheology.densest_fraction);
}

double granular_stress(const Rheology& rheology, const Mixture& mixture, double fraction, double pressure,
                       double shear_rate) {
  constexpr double no_pressure = 1e-100;  // of eta g, below which numbers divided by it would overflow
  const double rate = std::abs(shear_rate);
  if (!(pressure > no_pressure * mixture.viscosity * rate) || rate == 0.0) return 0.0;
  const double viscous = viscous_number(mixture, rate, pressure);
  const double mixed = mixed_number(viscous, inertial_number(mixture, rate, pressure));
  return friction(rheology, fraction, mixed, viscous) * pressure * shear_rate /
         std::hypot(rate, rheology.creeping_rate);
}

}  // namespace thalweg::continuum
