// The two phases of a bed under water: plain values. SI units.
#pragma once

namespace thalweg::continuum {

struct Mixture {
  double fluid_density = 1000.0;  // rho_f, kg/m^3
  double viscosity = 1e-3;        // eta of the clear fluid, Pa s
  double grain_density = 2550.0;  // rho_s, kg/m^3
  double diameter = 5e-3;         // d, m

  double excess_density() const { return grain_density - fluid_density; }  // kg/m^3
  bool operator==(const Mixture&) const = default;
};

}  // namespace thalweg::continuum
