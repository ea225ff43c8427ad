// Turbulent stress of the fluid and drift of the grains (Zhang et al. 2022, section 3.1.2):
//
//   eta_t = (1 - phi) rho_f l_m^2 |D|                     eq. 22
//   l_m   = max(3 d (phi_m - phi)^3, 0.2 d)               eq. 23 (Berzi and Fraccarollo 2015; Ni and Capart 2018)
//   u_d   = -eta_t/(rho_f Sigma_s phi) grad phi           eq. 24 (Simonin 1989)
//
// The norm |D| of the rate of strain is not stated; in simple shear sqrt(2 D:D) is the shear rate, as the mixing length
// asks for, and sqrt(D:D) is smaller by sqrt(2).
#pragma once

#include "continuum/mixture.hpp"
#include "core/keys/named_choice.hpp"

#include <vector>

namespace thalweg::continuum {

enum class StrainNorm { shear_rate, frobenius };
std::vector<NamedChoice<StrainNorm>> choices_of(StrainNorm);

struct Turbulence {
  double mixing_length_factor = 3.0;
  double smallest_mixing_length = 0.2;  // diameters; 0: none
  double schmidt_number = 0.3;          // Sigma_s
  StrainNorm strain_norm = StrainNorm::shear_rate;
  bool operator==(const Turbulence&) const = default;
};

// l_m, m. diameter: m; densest: phi_m; fraction: phi.
double mixing_length(const Turbulence& turbulence, double diameter, double densest, double fraction);

// |D| of simple shear; rate: dU/dz of either sign, 1/s.
double strain_norm(StrainNorm norm, double rate);

// eta_t, Pa s; arguments as above.
double eddy_viscosity(const Turbulence& turbulence, const Mixture& mixture, double densest, double fraction,
                      double rate);

// eta_t/(rho_f Sigma_s), m^2/s: with it, phi u_d = -diffusivity grad phi.
double drift_diffusivity(const Turbulence& turbulence, const Mixture& mixture, double eddy_viscosity);

}  // namespace thalweg::continuum
