// The two phases of a bed under water: plain values. SI units.
#pragma once

#include <algorithm>
#include <cmath>

namespace thalweg::continuum {

struct Mixture {
  double fluid_density = 1000.0;  // rho_f, kg/m^3
  double viscosity = 1e-3;        // eta of the clear fluid, Pa s
  double grain_density = 2550.0;  // rho_s, kg/m^3
  double diameter = 5e-3;         // d, m

  double excess_density() const { return grain_density - fluid_density; }  // kg/m^3

  // m/s a diameter at which grains under the weight of one layer, (rho_s - rho_f) g d, flow fast: the smaller of
  // sqrt(g' d), where their inertia, and g' d^2/nu, where viscosity spreads them (I or I_v about 1); g' = (rho_s/rho_f
  // - 1) g.
  double shear_speed(double gravity) const {
    const double weight = excess_density() * gravity * diameter;  // Pa
    return std::min(std::sqrt(weight / fluid_density), weight * diameter / viscosity);
  }

  bool operator==(const Mixture&) const = default;
};

}  // namespace thalweg::continuum
