// Contacts that are too soft, or too hard for grains to rebound in water, and what stiffness and step suit both.
#pragma once

#include "driver/warnings/remedy.hpp"

namespace thalweg::driver {

// Warns of overlaps above 1 % of a diameter under the weight of the bed or 5 % in an impact.
Warnings overlap_warnings(const Case& c);

// Warns of weak_rebound(). The sentence begins with "too weak", for a line of `thalweg check`.
Warnings rebound_warnings(const Case& c);

// Changes that make all contacts of the case stiffer by a factor, rounded, and keep the ratios of stiffnesses and the
// dry restitution: of the duration, normal_stiffness or youngs_modulus, tangential_stiffness and damping, wherever they
// are given.
Remedy stiffness_changes(const Case& c, double factor, int digits, Rounding rounding);

}  // namespace thalweg::driver
