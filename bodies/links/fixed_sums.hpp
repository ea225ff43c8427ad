// Exact sums of many numbers at a time: as integers of the resolution of LatticeFixed, in vectors of the machine's
// width.
#pragma once

#include "core/sums/fixed_point.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <experimental/simd>

namespace thalweg::bodies {

// Sums of LatticeFixed::from over packs, several at a time: the bit patterns of value + shift are added as integers,
// which may wrap around, and the shifts taken off at the end. A term within its range leaves sign and exponent of the
// shift as they are; any other shows in what they differ by.
template <int count>
class FixedSums {
public:
  using Wide = std::experimental::native_simd<double>;
  static constexpr int width = static_cast<int>(Wide::size());

  [[gnu::always_inline]] void add(const std::array<Wide, count>& terms) {
    for (int s = 0; s < count; ++s) {
      const Bits bits = (Bits) static_cast<Doubles>(terms[s] + LatticeFixed::rounding_shift);
      bits_[s] += bits;
      differences_[s] |= bits ^ shift;
    }
    terms_ += width;
  }
  // Sum of at most most_terms terms; one out of range sets the flag of core/sums/sum_range.hpp.
  std::int64_t operator[](int sum) const {
    std::uint64_t total = 0, differences = 0;
    for (int lane = 0; lane < width; ++lane) {
      total += bits_[sum][lane];
      differences |= differences_[sum][lane];
    }
    if ((differences & sign_and_exponent) != 0) [[unlikely]]
      SumRange::leave();
    return static_cast<std::int64_t>(total - terms_ * shift);
  }
  static constexpr int most_terms = static_cast<int>(LatticeFixed::largest_sum / LatticeFixed::largest_term);

private:
  using Doubles [[gnu::vector_size(sizeof(double) * Wide::size())]] = double;
  using Bits [[gnu::vector_size(sizeof(double) * Wide::size())]] = std::uint64_t;
  static constexpr std::uint64_t shift = std::bit_cast<std::uint64_t>(LatticeFixed::rounding_shift);
  static constexpr std::uint64_t sign_and_exponent = 0xfff0000000000000;
  Bits bits_[count] = {}, differences_[count] = {};
  std::uint64_t terms_ = 0;
};

}  // namespace thalweg::bodies
