// Warnings: settings that are valid but questionable.
#pragma once

#include "driver/warnings/remedy.hpp"

#include <string>
#include <vector>

namespace thalweg::driver {

// Whole sentences, those first that spoil most: numbers in other units, what drives the flow, what breaks down, what is
// not resolved, and at last how the run is planned.
std::vector<std::string> warnings(const Case& c);

// The changes that the first of the warnings with a consistent remedy asks for; empty: none has one.
Remedy first_remedy(const Case& c);

}  // namespace thalweg::driver
