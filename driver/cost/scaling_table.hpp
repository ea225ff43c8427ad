// Table of `thalweg check --ranks`: predicted cost on other numbers of ranks.
#pragma once

#include "driver/cost/performance_model.hpp"

#include <string>
#include <vector>

namespace thalweg::driver {

// One text a line: what was measured, and one row for each number of ranks, of the rank that all others wait for.
// Throws InputError where a rank would get too few cells, or the case cannot be shared among ranks.
std::vector<std::string> scaling_table(const Case& c, const std::vector<int>& ranks, const CoreSpeed& speed,
                                       const Network& network);

}  // namespace thalweg::driver
