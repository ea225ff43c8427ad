// Rules of interpolated bounce-back on a moving wall: what comes back over a link is
//   f_i'(x_f, t+1) = incident f_i^c(x_f) + second (the rule's second value) - wall w_i rho c_i.u_w.
// Lattice units; symbols as in interpolated_bounce_back.hpp. Either rule is exact in a fluid that moves with the wall.
#pragma once

#include "lbm/lattice/pack_constant.hpp"

namespace thalweg::bodies {

// a where the mask is set, else b: of plain numbers and of SIMD packs.
template <typename Number>
[[gnu::always_inline]] inline Number chosen(bool mask, const Number& a, const Number& b) {
  return mask ? a : b;
}
template <typename Number>
[[gnu::always_inline]] inline Number chosen(const typename Number::mask_type& mask, const Number& a, const Number& b) {
  Number result = b;
  where(mask, result) = a;
  return result;
}

template <typename Number>
struct LinkWeights {
  Number incident, second, wall;
};

// Linear, in two branches (Bouzidi, Firdaouss and Lallemand 2001):
//   delta < 1/2:  f_i'(x_f, t+1) = 2 delta f_i^c(x_f) + (1 - 2 delta) f_i^c(x_ff)               - 6 w_i rho c_i.u_w
//   else:         f_i'(x_f, t+1) = f_i^c(x_f)/(2 delta) + [1 - 1/(2 delta)] f_i'^c(x_f)  - (3/delta) w_i rho c_i.u_w
// Both are equal at delta = 1/2.
struct BouzidiLink {
  // The second value is f_i^c(x_ff) below a half, f_i'^c(x_f) from there on.
  static constexpr bool needs_both = false;

  template <typename Number>
  [[gnu::always_inline]] static LinkWeights<Number> weights(const Number& delta) {
    const Number one = lbm::pack_constant<Number>(1), six = lbm::pack_constant<Number>(6),
                 half = lbm::pack_constant<Number>(0.5);
    const auto near_wall = delta < half;
    const Number share = chosen<Number>(near_wall, delta + delta, half / delta);
    return {share, one - share, chosen<Number>(near_wall, six, six * share)};
  }
};

// One formula for all distances, the central linear interpolation (CLI) of Ginzburg, Verhaeghe and d'Humieres (2008):
//   f_i'(x_f, t+1) = f_i^c(x_f) + k [f_i^c(x_ff) - f_i'^c(x_f)] - 12/(1 + 2 delta) w_i rho c_i.u_w,
//   k = (1 - 2 delta)/(1 + 2 delta).
// In plane flow it sets u + delta u' + 2/3 (tau+ - 1/2)(tau- - 1/2) u'' =
// u_w with derivatives towards the wall, so that with two relaxation times and a fixed magic parameter a steady flow
// does not depend on the viscosity.
//
// Where a body covers x_ff, the link is the end of a gap of one cell between two bodies, whose other end has the same
// rule. The two incoming populations stand for each other's f_i^c(x_ff); for bodies that move together the solution is
// bounce-back, whatever the two distances:
//   f_i'(x_f, t+1) = f_i^c(x_f) - 6 w_i rho c_i.u_w.
// It has the same closure as above, so that the flow still does not depend on the viscosity.
struct CliLink {
  // The second value is f_i^c(x_ff) - f_i'^c(x_f).
  static constexpr bool needs_both = true;

  template <typename Number>
  [[gnu::always_inline]] static LinkWeights<Number> weights(const Number& delta) {
    const Number one = lbm::pack_constant<Number>(1), twice = delta + delta, inverse = one / (one + twice);
    return {one, (one - twice) * inverse, lbm::pack_constant<Number>(12) * inverse};
  }
};

}  // namespace thalweg::bodies
