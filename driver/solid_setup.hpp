// The solids of a case, as coupling wants them.
#pragma once

#include "coupling/solid_shape.hpp"
#include "driver/case.hpp"

#include <vector>

namespace thalweg::driver {

// In lattice units, in the order of the case. Throws InputError where an STL file cannot be read or is not closed.
std::vector<coupling::SolidShape> solid_shapes(const Case& c);

}  // namespace thalweg::driver
