// The normal distribution of mean 0 and deviation 1.
#pragma once

#include <cmath>
#include <numbers>

namespace thalweg::beds {

inline double normal_share_below(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// The x below which this share (0 < share < 1) lies, by bisection between two bounds.
inline double normal_quantile(double share, double lower, double upper) {
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (lower + upper);
    (normal_share_below(middle) < share ? lower : upper) = middle;
  }
  return 0.5 * (lower + upper);
}

}  // namespace thalweg::beds
