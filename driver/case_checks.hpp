// Whether a case that is complete can be run at all: what follows from several keys together.
#pragma once

#include "driver/case.hpp"
#include "io/yaml_document.hpp"

namespace thalweg::driver {

inline constexpr const char* axis_name[3] = {"x", "y", "z"};
// Decimal numbers such as 0.12 / 0.0005 are whole up to a few units in the last place.
inline constexpr double whole_number_tolerance = 1e-6;

// Throws InputError at the first thing that cannot be, with the place of the key to change in the document.
void check_case(const Case& c, const io::YamlDocument& document);

}  // namespace thalweg::driver
