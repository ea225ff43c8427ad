// What does not forbid a run but deserves a second look.
#pragma once

#include "driver/case.hpp"

#include <string>
#include <vector>

namespace thalweg::driver {

// Whole sentences.
std::vector<std::string> warnings(const Case& c);

// Of how the run is planned, its start and its length, for `thalweg check`.
std::vector<std::string> warnings_of_plan(const Case& c);

}  // namespace thalweg::driver
