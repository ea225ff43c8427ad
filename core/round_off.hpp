// Numbers that are the same but for the last digits of how they were computed or printed.
#pragma once

#include <cmath>

namespace thalweg {

// Within 1e-9 of b.
inline bool same_but_for_rounding(double a, double b) { return std::abs(a - b) <= 1e-9 * b; }

}  // namespace thalweg
