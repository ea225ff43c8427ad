// The stress that contacts put on each grain,
//   s_ab = (1/V) sum_c F_a r_b
// with F the force on the grain, r the arm from its centre and V its volume (Love 1927; Weber 1966); positive in
// tension, so a grain that is pressed has negative s_aa. It is symmetric up to the torque on the grain.
#pragma once

#include "core/state/snapshot.hpp"

#include <vector>

namespace thalweg {

// sum_c F_a r_b (N m; rows a, columns b) of every grain of the view, in its order; for a member of a clump, of its own
// contacts, with arms from the clump's centre. Zero without contacts.
std::vector<Mat3> contact_moments(const Snapshot& snapshot);

// Moments of the lubrication forces, likewise.
std::vector<Mat3> lubrication_moments(const Snapshot& snapshot);

// The stress (Pa) of every grain of the view; a clump's members all have that of the clump.
std::vector<Mat3> contact_stresses(const Snapshot& snapshot);

}  // namespace thalweg
