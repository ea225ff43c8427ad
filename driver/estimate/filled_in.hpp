// Keys that a case may leave open because they follow from its others: the start of the flow, the step of the fluid,
// the stiffness of contacts and the sub-steps of the grains, in this order.
#pragma once

#include "driver/case/case.hpp"

namespace thalweg::driver {

// cells/step, up to which results are accurate: a Mach number of 0.17, whose square is the error of compressibility.
inline constexpr double accurate_lattice_velocity = 0.1;

// 1, of the fluid by its weight, from top to bottom, or by the pressure of an outlet
inline constexpr double largest_compression = 0.05;

// tau - 1/2, up to which trt near bodies keeps drag and walls with bouzidi links.
inline constexpr double accurate_excess_near_bodies = 0.15;

// Notes what a case leaves open, and fills that in. Needs the populations and surfaces of a case that check_box()
// accepts.
void complete(Case& c);

// Fills in again what was left open: after a change of other keys.
void fill_in(Case& c);

// s, the longest step in which the flow covers accurate_lattice_velocity, walls and grains keep their accuracy (tau -
// 1/2 of at most accurate_excess_near_bodies, or 0.029 without trt near bodies), and the weight of the fluid under
// gravity.mode: full, or the pressure of an outlet, compresses it by at most largest_compression; two digits, rounded
// down. It does not depend on the time at which the run ends.
double suitable_time_step(const Case& c);

}  // namespace thalweg::driver
