// Numbers that are the same but for the last digits of how they were computed or printed.
#pragma once

#include <algorithm>
#include <cmath>

namespace thalweg {

// Equal, or within 1e-9 of each other.
inline bool same_but_for_rounding(double a, double b) {
  return a == b || std::abs(a - b) <= 1e-9 * std::min(std::abs(a), std::abs(b));
}

}  // namespace thalweg
