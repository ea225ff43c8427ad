// Names of the axes, and how near to whole a number of cells has to be.
#pragma once

namespace thalweg::driver {

inline constexpr const char* axis_name[3] = {"x", "y", "z"};
// Decimal numbers such as 0.12 / 0.0005 are whole up to a few units in the last place.
inline constexpr double whole_number_tolerance = 1e-6;

}  // namespace thalweg::driver
