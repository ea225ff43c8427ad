// The stiffness of linear contacts where a case does not give it as a number, and the sub-steps that follow.
//
//   t_c = 4 (d/dx) dt        of grains in a fluid, by default; d: the diameter, or the shortest axis of a clump. It is
//                            longer than sound takes around a grain, pi/2 sqrt(3) d/dx steps, so that the water that
//                            moves with it takes part in its rebound
//   k_n = m* ((pi/t_c)^2 + (gamma/(2 m*))^2)                  and at least what keeps overlaps small; k_t = 2/7 k_n
//
// m*: of two of the lightest grains that are free and have no stiffness of their own. With 2/7 a grain that sticks
// swings across the contact as fast as along its normal.
#pragma once

#include "driver/case/case.hpp"

namespace thalweg::driver {

inline constexpr double fluid_steps_per_cell = 4.0;  // of a diameter, in a contact of default duration

// Default contact duration in fluid steps, shorter if overlaps require it. The case must have free grains in a fluid.
double default_contact_steps(const Case& c);

// True if the contact duration is the default: grains in a fluid, and neither a duration nor a stiffness given.
bool has_default_duration(const Case& c);

// True if the stiffness follows from a duration, given or default.
bool goes_by_duration(const Case& c);

// s: half a period of the shortest linear contact of two free grains whose stiffness is that of the section contact,
// with its dashpot: the duration that gives its stiffness.
double contact_duration(const Case& c);

// Takes over the stiffnesses that a case gives and notes what it omits, for fill_in_contacts() to derive.
void take_over_contacts(Case& c);

// Derives the omitted stiffnesses again, after a change of other keys.
void fill_in_contacts(Case& c);

// The case with its stiffnesses as numbers, as if it had given them.
Case with_stiffnesses(Case c);

}  // namespace thalweg::driver
