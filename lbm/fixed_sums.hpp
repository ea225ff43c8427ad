// Exact sums of many numbers at a time: as integers of the resolution of LatticeFixed, in vectors of the machine's
// width.
#pragma once

#include "core/fixed_point.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <experimental/simd>

namespace thalweg::lbm {

// Sums of LatticeFixed::from over packs, several at a time: the bit patterns of value * scale + shift are added as
// integers, which may wrap around, and the shifts taken off at the end.
template <int count>
class FixedSums {
public:
  using Wide = std::experimental::native_simd<double>;
  static constexpr int width = static_cast<int>(Wide::size());

  [[gnu::always_inline]] void add(const std::array<Wide, count>& terms) {
    for (int s = 0; s < count; ++s)
      bits_[s] += (Bits) static_cast<Doubles>(terms[s] * LatticeFixed::scale + LatticeFixed::rounding_shift);
    terms_ += width;
  }
  std::int64_t operator[](int sum) const {
    std::uint64_t total = 0;
    for (int lane = 0; lane < width; ++lane) total += bits_[sum][lane];
    return static_cast<std::int64_t>(total - terms_ * std::bit_cast<std::uint64_t>(LatticeFixed::rounding_shift));
  }

private:
  using Doubles [[gnu::vector_size(sizeof(double) * Wide::size())]] = double;
  using Bits [[gnu::vector_size(sizeof(double) * Wide::size())]] = std::uint64_t;
  Bits bits_[count] = {};
  std::uint64_t terms_ = 0;
};

}  // namespace thalweg::lbm
