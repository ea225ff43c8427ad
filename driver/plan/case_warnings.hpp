// What does not forbid a run but deserves a second look.
#pragma once

#include "driver/case/case.hpp"

#include <string>
#include <vector>

namespace thalweg::driver {

// Whole sentences.
std::vector<std::string> warnings(const Case& c);

// Of how the run is planned, its start and its length, for `thalweg check`.
std::vector<std::string> warnings_of_plan(const Case& c);

// Where grains rebound too weakly in the fluid: that, for a line of `thalweg check`; else nothing.
std::vector<std::string> remarks_on_rebound(const Case& c);

}  // namespace thalweg::driver
