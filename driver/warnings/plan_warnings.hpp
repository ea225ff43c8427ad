// Warnings of how a run is planned: its start, its length and its output.
#pragma once

#include "driver/warnings/consistent_remedy.hpp"

#include <vector>

namespace thalweg::driver {

// Of a log profile unlike the flow that the case is driven towards, which estimates of speed take for its fastest.
Warnings other_start(const Case& c);

std::vector<WarningRule> plan_rules();

}  // namespace thalweg::driver
