// Warnings of solids that do nothing, or close the channel.
#pragma once

#include "driver/warnings/consistent_remedy.hpp"

#include <string>
#include <vector>

namespace thalweg::driver {

Warnings large_solids(const Case& c);   // a file in millimetres
Warnings absent_solids(const Case& c);  // outside the box, unless they move into it

// Sentences: solids that block the channel, cover all of the bed, lie between the centres of cells or within another.
// The lattice is searched cell by cell, so that this is no rule, which is tried with every change.
std::vector<std::string> solids_in_the_lattice(const Case& c);

}  // namespace thalweg::driver
