// A 128-bit integer sum of 64-bit integers: what fixed-point sums (fixed_point.hpp) grow into over a long run.
#pragma once

#include "core/sums/sum_range.hpp"

#include <cmath>
#include <cstdint>

namespace thalweg {

struct WideSum {
  std::int64_t high = 0;  // value = high 2^64 + low, with low read as unsigned
  std::int64_t low = 0;

  // value in multiples of 2^-fraction_bits, rounded to the nearest. 2^126 multiples and more, and NaN, count as zero
  // and set the flag of sum_range.hpp.
  static WideSum from(double value, int fraction_bits) {
    const double multiples = std::nearbyint(std::ldexp(std::abs(value), fraction_bits));
    if (!(multiples < 0x1p126)) {
      SumRange::leave();
      return {};
    }
    const double upper = std::floor(multiples * 0x1p-64);
    const WideSum sum{static_cast<std::int64_t>(upper),
                      static_cast<std::int64_t>(static_cast<std::uint64_t>(multiples - upper * 0x1p64))};
    return value < 0.0 ? sum.negated() : sum;
  }

  WideSum negated() const {
    WideSum sum{~high, ~low};
    sum.add(1);
    return sum;
  }

  void add(std::int64_t value) { add(WideSum{value < 0 ? -1 : 0, value}); }
  void add(const WideSum& other) {
    const auto sum = static_cast<std::uint64_t>(low) + static_cast<std::uint64_t>(other.low);
    high += other.high + (sum < static_cast<std::uint64_t>(other.low) ? 1 : 0);
    low = static_cast<std::int64_t>(sum);
  }

  // Times 2^-fraction_bits, rounded to a double.
  double to_double(int fraction_bits) const {
    // The two halves of a number near zero would cancel and lose its digits: turned positive first.
    if (high < 0) return -negated().to_double(fraction_bits);
    return std::ldexp(static_cast<double>(high), 64 - fraction_bits) +
           std::ldexp(static_cast<double>(static_cast<std::uint64_t>(low)), -fraction_bits);
  }

  // Sum in 64 bits; sets the flag of sum_range.hpp if it does not fit.
  std::int64_t narrowed() const {
    if (high != (low < 0 ? -1 : 0)) SumRange::leave();
    return low;
  }

  bool operator==(const WideSum&) const = default;
};

}  // namespace thalweg
