// Interpolated bounce-back in one formula for all distances, the central linear interpolation (CLI) of Ginzburg,
// Verhaeghe and d'Humieres (2008), on a moving wall. Lattice units; symbols as in link_pass.hpp.
//   f_i'(x_f, t+1) = f_i^c(x_f) + k [f_i^c(x_ff) - f_i'^c(x_f)] - 12/(1 + 2 delta) w_i rho c_i.u_w,
//   k = (1 - 2 delta)/(1 + 2 delta).
// Exact in a fluid that moves with the wall. In plane flow it sets u + delta u' + 2/3 (tau+ - 1/2)(tau- - 1/2) u'' =
// u_w with derivatives towards the wall, so that with two relaxation times and a fixed magic parameter a steady flow
// does not depend on the viscosity.
//
// Where a body covers x_ff, the link is the end of a gap of one cell between two bodies, whose other end has the same
// rule. The two incoming populations stand for each other's f_i^c(x_ff); for bodies that move together the solution is
// bounce-back, whatever the two distances:
//   f_i'(x_f, t+1) = f_i^c(x_f) - 6 w_i rho c_i.u_w.
// It has the same closure as above, so that the flow still does not depend on the viscosity.
#pragma once

#include "lbm/link_weights.hpp"
#include "lbm/pack_constant.hpp"

namespace thalweg::lbm {

struct CliLink {
  // The second value is f_i^c(x_ff) - f_i'^c(x_f).
  static constexpr bool needs_both = true;

  template <typename Number>
  [[gnu::always_inline]] static LinkWeights<Number> weights(const Number& delta) {
    const Number one = pack_constant<Number>(1), twice = delta + delta, inverse = one / (one + twice);
    return {one, (one - twice) * inverse, pack_constant<Number>(12) * inverse};
  }
};

}  // namespace thalweg::lbm
