// The one grain that stands for all of a case wherever a number is made dimensionless: q*, the Shields number, the
// Galileo number, the speed above which a grain counts as moving. It does not depend on the order of the populations.
#pragma once

#include "driver/case/case.hpp"

#include <string>
#include <vector>

namespace thalweg::driver {

struct ReferenceGrain {
  double diameter;  // m
  double density;   // kg/m^3
};

// Median diameter by volume of all free grains (of all grains, if none is free), as for a single population
// (beds::median_by_mass()), unless analysis.reference_diameter gives another; and their mean density. The case must
// have grains.
ReferenceGrain reference_grain(const Case& c);

// Sizes of the grains that it stands for, rising; a clump has the diameter of the sphere (disk) of its volume.
std::vector<beds::SizeCount> represented_sizes(const Case& c);

inline constexpr double largest_boulder = 0.5;  // m; grains of resolved flow that are larger are in millimetres

// Text for reports: "diameter 0.00495 m, density 2550 kg/m^3 (...)".
std::string reference_text(const Case& c);

}  // namespace thalweg::driver
