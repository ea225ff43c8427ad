// The one grain that stands for all of a case wherever a number is made dimensionless: q*, the Shields number, the
// Galileo number, the speed above which a grain counts as moving. It does not depend on the order of the populations.
#pragma once

#include "driver/case/case.hpp"

#include <string>

namespace thalweg::driver {

struct ReferenceGrain {
  double diameter;  // m
  double density;   // kg/m^3
};

// Of all grains that are free to move, taken together (of all, where none is): the diameter that half of their volume
// is finer than, as for a single population (beds::median_by_mass()), unless analysis.reference_diameter gives
// another; and their mass over their volume. The case must have grains.
ReferenceGrain reference_grain(const Case& c);

// The same in words: "diameter 0.00495 m, density 2550 kg/m^3 (...)".
std::string reference_text(const Case& c);

}  // namespace thalweg::driver
