// Sums whose result does not depend on the order of the terms.
//
// A floating-point number is turned into a 64-bit integer multiple of 2^-bits; integer addition is associative, so a sum
// over links, threads or ranks has the same bits whatever the order. The rounding of one term is at most 2^-(bits+1).
#pragma once

#include "core/types.hpp"

#include <cmath>
#include <cstdint>

namespace thalweg {

template <int fraction_bits>
struct FixedPoint {
  static constexpr double scale = static_cast<double>(std::int64_t{1} << fraction_bits);
  static constexpr double largest = 9.2e18 / scale;   // sums beyond this overflow

  static std::int64_t from(double value) { return std::llrint(value * scale); }
  static double to_double(std::int64_t sum) { return static_cast<double>(sum) / scale; }
};

// Populations, momenta and forces in lattice units: resolution 1e-15, range +-8000.
using LatticeFixed = FixedPoint<50>;

// A vector of fixed-point sums.
struct FixedVec3 {
  std::int64_t x = 0, y = 0, z = 0;

  void add(double ax, double ay, double az) {
    x += LatticeFixed::from(ax);
    y += LatticeFixed::from(ay);
    z += LatticeFixed::from(az);
  }
  FixedVec3& operator+=(const FixedVec3& other) {
    x += other.x;
    y += other.y;
    z += other.z;
    return *this;
  }
  Vec3 to_vec3() const {
    return {LatticeFixed::to_double(x), LatticeFixed::to_double(y), LatticeFixed::to_double(z)};
  }
};

}  // namespace thalweg
