// Limits as messages print them: with few digits, and so that what is printed still keeps the limit.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace thalweg::driver {

// The number with so many digits nearest to `limit` plus so much of a unit of its last digit.
inline std::string shifted_text(double limit, int digits, double shift) {
  const double last_digit = std::pow(10.0, std::floor(std::log10(limit)) + 1.0 - digits);
  return fmt::format("{:.{}g}", limit + shift * last_digit, digits);
}

// The largest number with so many digits that is not above `limit`, at least 0.
inline std::string at_most_text(double limit, int digits) {
  const std::string nearest = fmt::format("{:.{}g}", limit, digits);
  return std::stod(nearest) <= limit ? nearest : shifted_text(limit, digits, -0.5);
}

// The smallest that is not below it.
inline std::string at_least_text(double limit, int digits) {
  const std::string nearest = fmt::format("{:.{}g}", limit, digits);
  return std::stod(nearest) >= limit ? nearest : shifted_text(limit, digits, 0.5);
}

}  // namespace thalweg::driver
