// Warnings: settings that are valid but questionable.
#pragma once

#include "driver/case/case.hpp"

#include <string>
#include <vector>

namespace thalweg::driver {

// Whole sentences.
std::vector<std::string> warnings(const Case& c);

// Warnings about the start and the length of the run, for `thalweg check`.
std::vector<std::string> warnings_of_plan(const Case& c);

// Remarks on grains that rebound too weakly in the fluid, for a line of `thalweg check`.
std::vector<std::string> remarks_on_rebound(const Case& c);

}  // namespace thalweg::driver
