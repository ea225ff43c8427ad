// Warnings of numbers that look like numbers in another unit: millimetres, g/cm^3, degrees.
#pragma once

#include "driver/plan/consistent_remedy.hpp"

#include <vector>

namespace thalweg::driver {

std::vector<WarningRule> unit_rules();

}  // namespace thalweg::driver
