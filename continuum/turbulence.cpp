#include "continuum/turbulence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::continuum {

std::vector<NamedChoice<StrainNorm>> choices_of(StrainNorm) {
  return {{StrainNorm::shear_rate, "shear_rate", "sqrt(2 D:D), which is |dU/dz|"},
          {StrainNorm::frobenius, "frobenius", "sqrt(D:D), smaller by sqrt(2)"}};
}

double mixing_length(const Turbulence& turbulence, double diameter, double densest, double fraction) {
  const double gap = std::max(0.0, densest - fraction);
  return diameter * std::max(turbulence.mixing_length_factor * gap * gap * gap, turbulence.smallest_mixing_length);
}

double strain_norm(StrainNorm norm, double rate) {
  return norm == StrainNorm::shear_rate ? std::abs(rate) : std::abs(rate) / std::numbers::sqrt2;
}

double eddy_viscosity(const Turbulence& turbulence, const Mixture& mixture, double densest, double fraction,
                      double rate) {
  const double length = mixing_length(turbulence, mixture.diameter, densest, fraction);
  return (1.0 - fraction) * mixture.fluid_density * length * length * strain_norm(turbulence.strain_norm, rate);
}

double drift_diffusivity(const Turbulence& turbulence, const Mixture& mixture, double eddy_viscosity) {
  return eddy_viscosity / (mixture.fluid_density * turbulence.schmidt_number);
}

}  // namespace thalweg::continuum
