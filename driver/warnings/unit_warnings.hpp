// Warnings of numbers that look like numbers in another unit: millimetres, g/cm^3, degrees.
#pragma once

#include "driver/warnings/consistent_remedy.hpp"

#include <vector>

namespace thalweg::driver {

inline constexpr double lightest_solid = 30.0;  // kg/m^3; foams are heavier, and 2.65 g/cm^3 is less
inline constexpr double densest_gas = 20.0;     // kg/m^3
inline constexpr double thinnest_gas = 5e-6;    // m^2/s; the viscosity of air is 1.5e-5, that of water 1e-6
inline constexpr double steepest_bed = 1.0;     // a tangent; no bed lies at 45 degrees

std::vector<WarningRule> unit_rules();

// True if the grains or the cells are so large that all lengths are probably in millimetres.
bool has_other_lengths(const Case& c);

}  // namespace thalweg::driver
