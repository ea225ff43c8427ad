// A series of random numbers with a known memory.
#pragma once

#include "core/base/counter_random.hpp"

#include <cmath>
#include <numbers>

namespace thalweg::analysis {

// x' = a x + e with normal e of variance 1; the first x has the variance of all others.
class MadeUpChain {
public:
  MadeUpChain(double a, std::uint64_t seed) : a_(a), seed_(seed) { x_ = normal() / std::sqrt(1.0 - a * a); }
  double next() {
    const double x = x_;
    x_ = a_ * x_ + normal();
    return x;
  }

private:
  double normal() {  // Box and Muller
    const double u = uniform_random(seed_, drawn_, 0), v = uniform_random(seed_, drawn_, 1);
    ++drawn_;
    return std::sqrt(-2.0 * std::log(1.0 - u)) * std::cos(2.0 * std::numbers::pi * v);
  }

  double a_, x_ = 0.0;
  std::uint64_t seed_, drawn_ = 0;
};

}  // namespace thalweg::analysis
