// The lattice fluid of a case, as coupling wants it: the same alone and with grains.
#pragma once

#include "coupling/keys/fluid_parameters.hpp"
#include "driver/case/case.hpp"

namespace thalweg::driver {

// Units, collision, faces, driving force or mean velocity, rule of the links, initial state.
coupling::FluidParameters fluid_parameters(const Case& c);

}  // namespace thalweg::driver
