// Largest stable velocity of a collision model without subgrid model: the map of docs/stability.md.
#pragma once

#include "driver/case/case.hpp"

namespace thalweg::driver {

// The largest lattice velocity (cells a step) of the map that stayed stable at this distance of the relaxation time
// from 1/2, looked up at the nearest smaller one of the map; 0 if none did. A subgrid model keeps the fluid steady
// beyond it.
double stable_lattice_velocity(lbm::CollisionModel collision, double excess);

}  // namespace thalweg::driver
