// Speeds in the pores of beds that a flow has to pass: at least that in the narrowest section between spheres of the
// same solid fraction phi on a cubic lattice, 1 - pi/4 (6 phi/pi)^(2/3) of the whole.
#pragma once

#include "driver/case/case.hpp"

namespace thalweg::driver {

// m/s, of a mean velocity through held grains that fill the box; 0 without.
double pore_speed_of_mean_velocity(const Case& c);

// m/s, of the water from inlets: through held grains that fill the box, and from bottom or top through a bed. That of
// the inlet where it meets no bed; 0 without inlets.
double pore_speed_of_inlets(const Case& c);

}  // namespace thalweg::driver
