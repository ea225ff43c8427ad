// Names of the axes.
#pragma once

namespace thalweg::driver {

inline constexpr const char* axis_name[3] = {"x", "y", "z"};

}  // namespace thalweg::driver
