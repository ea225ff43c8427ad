// What loads do to the grains of a case: how deep they overlap, and whether a bed slides as a whole. Estimates for
// `thalweg check`.
#pragma once

#include "driver/case.hpp"

namespace thalweg::driver {

// Overlaps of the softest contact between two grains of a population, over their diameter; 0 without grains.
struct Overlaps {
  double under_weight;  // at the base of the settled bed: each grain carries the weight above its own d^2
  double in_impact;     // of two free grains at `speed`
  double speed;         // m/s, of a fall: through the fluid, or dry from the top of the box onto the bed
};
Overlaps expected_overlaps(const Case& c);

// Shear stress over normal stress between the grains at the base of a settled bed, where gravity along x drives water
// and grains: with the pores full of water and H of it above,
//   [rho_f H + (rho_f + phi (rho_s - rho_f)) h] g_x / [phi (rho_s - rho_f) h g_z],
// and dry g_x/g_z. 0 where nothing drives the bed, where side walls carry it, and for less than two layers.
double stress_ratio_at_base(const Case& c);

// The ratio that spheres of this friction coefficient hold at most: 0.105 to 0.405, simulations of slow shear by
// Chialvo, Sun and Sundaresan (2012), table I, linear between its entries.
double bulk_friction(double friction);

}  // namespace thalweg::driver
