// Interpolated bounce-back, linear, in two branches (Bouzidi, Firdaouss and Lallemand 2001), on a moving wall. Lattice
// units; symbols as in link_pass.hpp.
//   delta < 1/2:  f_i'(x_f, t+1) = 2 delta f_i^c(x_f) + (1 - 2 delta) f_i^c(x_ff)               - 6 w_i rho c_i.u_w
//   else:         f_i'(x_f, t+1) = f_i^c(x_f)/(2 delta) + [1 - 1/(2 delta)] f_i'^c(x_f)  - (3/delta) w_i rho c_i.u_w
// Both are exact in a fluid that moves with the wall, and equal at delta = 1/2.
#pragma once

#include "lbm/link_weights.hpp"
#include "lbm/pack_constant.hpp"

namespace thalweg::lbm {

struct BouzidiLink {
  // The second value is f_i^c(x_ff) below a half, f_i'^c(x_f) from there on.
  static constexpr bool needs_both = false;

  template <typename Number>
  [[gnu::always_inline]] static LinkWeights<Number> weights(const Number& delta) {
    const Number one = pack_constant<Number>(1), six = pack_constant<Number>(6), half = pack_constant<Number>(0.5);
    const auto near_wall = delta < half;
    const Number share = chosen<Number>(near_wall, delta + delta, half / delta);
    return {share, one - share, chosen<Number>(near_wall, six, six * share)};
  }
};

}  // namespace thalweg::lbm
