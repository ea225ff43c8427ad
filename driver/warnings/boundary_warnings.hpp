// Warnings of faces of the box that are probably not meant as they are, in a fluid.
#pragma once

#include "driver/warnings/consistent_remedy.hpp"

#include <string>

namespace thalweg::driver {

// "domain.boundaries.x_low", or "domain.boundaries.x" where both faces are alike.
std::string face_key(const DomainCase& domain, std::size_t face);

Warnings swapped_floor(const Case& c);  // a floor without friction under a lid with it
Warnings inlets(const Case& c);         // that suck, bring nothing in, or fill a box without an outlet
Warnings outlets(const Case& c);        // through which nothing leaves
// whose pressure compresses the fluid, or is that of the air above it
Warnings outlet_pressures(const Case& c);
Warnings recycling(const Case& c);       // by a plane too near to a face
Warnings beds_at_inlets(const Case& c);  // held, where the fluid is not recycled

}  // namespace thalweg::driver
