#include "driver/estimate/laminar_channel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::driver {

LaminarChannel laminar_channel(double acceleration, double half_height, double half_width, double viscosity) {
  constexpr double pi = std::numbers::pi;
  constexpr int terms = 50;  // the last is below 1e-10 of the first
  const double a = std::min(half_height, half_width), b = std::max(half_height, half_width);
  double largest = 0.0, mean = 0.0, sign = 1.0;
  for (int n = 1; n < 2 * terms; n += 2, sign = -sign) {
    const double argument = 0.5 * n * pi * b / a, cube = static_cast<double>(n) * n * n;
    largest += sign / (cube * std::cosh(argument));
    mean += std::tanh(argument) / (cube * n * n);
  }
  const double plates = acceleration * a * a / viscosity;
  return {plates / 2.0 * (1.0 - 32.0 / std::pow(pi, 3) * largest),
          plates / 3.0 * (1.0 - 192.0 * a / (std::pow(pi, 5) * b) * mean),
          1.2 / (viscosity * (1.0 / (a * a) + 1.0 / (b * b)))};
}

}  // namespace thalweg::driver
