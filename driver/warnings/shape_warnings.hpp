// Warnings of clumps that are made from surfaces.
#pragma once

#include "driver/warnings/consistent_remedy.hpp"

namespace thalweg::driver {

Warnings unlike_clumps(const Case& c);

}  // namespace thalweg::driver
