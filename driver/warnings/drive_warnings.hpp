// Warnings of gravity that nothing holds, so that all it drives gets faster for ever, and of gravity that drives
// nothing, or the wrong way.
#pragma once

#include "driver/case/case.hpp"

#include <string>
#include <vector>

namespace thalweg::driver {

// A sentence each, with a remedy.
std::vector<std::string> drive_warnings(const Case& c);

}  // namespace thalweg::driver
