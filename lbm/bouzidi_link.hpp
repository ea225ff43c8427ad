// Interpolated bounce-back, linear, in two branches (Bouzidi, Firdaouss and Lallemand 2001), on a moving wall. Lattice
// units; symbols as in bouzidi.hpp.
//   delta < 1/2:  f_i'(x_f, t+1) = 2 delta f_i^c(x_f) + (1 - 2 delta) f_i^c(x_ff)               - 6 w_i rho c_i.u_w
//   else:         f_i'(x_f, t+1) = f_i^c(x_f)/(2 delta) + [1 - 1/(2 delta)] f_i'^c(x_f)  - (3/delta) w_i rho c_i.u_w
// Both are exact in a fluid that moves with the wall, and equal at delta = 1/2.
#pragma once

#include "lbm/link_weights.hpp"

namespace thalweg::lbm {

struct BouzidiLink {
  // The second value is f_i^c(x_ff) below a half, f_i'^c(x_f) from there on.
  static constexpr bool needs_both = false;

  template <typename Real>
  [[gnu::always_inline]] static LinkWeights<Real> weights(Real delta) {
    const Real share = delta < Real(0.5) ? Real(2) * delta : Real(0.5) / delta;
    return {share, Real(1) - share, delta < Real(0.5) ? Real(6) : Real(6) * share};
  }
};

}  // namespace thalweg::lbm
