// Warnings of how a run is planned: its start, its length and its output.
#pragma once

#include "driver/warnings/consistent_remedy.hpp"

#include <vector>

namespace thalweg::driver {

std::vector<WarningRule> plan_rules();

}  // namespace thalweg::driver
