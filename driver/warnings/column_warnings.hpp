// Warnings of columns of two continua.
#pragma once

#include "driver/warnings/consistent_remedy.hpp"

#include <vector>

namespace thalweg::driver {

std::vector<WarningRule> column_rules();

}  // namespace thalweg::driver
