// Sums whose result does not depend on the order of the terms.
//
// A floating-point number is turned into a 64-bit integer multiple of 2^-bits; integer addition is associative, so a
// sum over links, threads or ranks has the same bits whatever the order. The rounding of one term is at most
// 2^-(bits+1). Terms and sums that are too large set a flag (sum_range.hpp).
#pragma once

#include "core/base/types.hpp"
#include "core/sums/sum_range.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace thalweg {

template <int fraction_bits>
struct FixedPoint {
  static constexpr int bits = fraction_bits;
  static constexpr double scale = static_cast<double>(std::int64_t{1} << fraction_bits);
  static constexpr double largest_term = 0x1p51 / scale;
  static constexpr double largest_sum = 0x1p63 / scale;  // of 64 bits
  static constexpr double rounding_shift = 0x3p51 / scale;

  // Rounds to the nearest multiple, ties to even. |value| * scale must be below 2^51: with rounding_shift added, the
  // last bit of the double is worth one multiple, so that its low bits are the integer. Larger values and NaN count as
  // zero and set the flag.
  static std::int64_t from(double value) {
    if (!(std::abs(value) < largest_term)) [[unlikely]] {
      SumRange::leave();
      return 0;
    }
    return std::bit_cast<std::int64_t>(value + rounding_shift) - std::bit_cast<std::int64_t>(rounding_shift);
  }
  static double to_double(std::int64_t sum) { return static_cast<double>(sum) / scale; }
};

// Momenta and forces of links in lattice units: resolution 6e-14, terms below 128, sums below 5e5.
using LatticeFixed = FixedPoint<44>;

// A vector of fixed-point sums.
struct FixedVec3 {
  std::int64_t x = 0, y = 0, z = 0;

  static FixedVec3 from(const Vec3& v) {
    return {LatticeFixed::from(v.x()), LatticeFixed::from(v.y()), LatticeFixed::from(v.z())};
  }
  FixedVec3& operator+=(const FixedVec3& other) {
    x = exact_sum(x, other.x);
    y = exact_sum(y, other.y);
    z = exact_sum(z, other.z);
    return *this;
  }
  Vec3 to_vec3() const { return {LatticeFixed::to_double(x), LatticeFixed::to_double(y), LatticeFixed::to_double(z)}; }
};

// A tensor of fixed-point sums, row by row.
struct FixedTensor {
  std::array<std::int64_t, 9> sums{};

  void add(int entry, std::int64_t term) {
    std::int64_t& sum = sums[static_cast<std::size_t>(entry)];
    sum = exact_sum(sum, term);
  }
  void add(int row, const FixedVec3& terms) {
    add(3 * row, terms.x);
    add(3 * row + 1, terms.y);
    add(3 * row + 2, terms.z);
  }
  // Adds a_i b_j.
  void add(const Vec3& a, const Vec3& b) {
    for (int k = 0; k < 9; ++k) add(k, LatticeFixed::from(a[k / 3] * b[k % 3]));
  }
  Mat3 to_mat3() const {
    Mat3 m;
    for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = LatticeFixed::to_double(sums[static_cast<std::size_t>(k)]);
    return m;
  }
};

}  // namespace thalweg
