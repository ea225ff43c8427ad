// The bgk collision: one relaxation time, omega = 1/tau.
//   f_i^c = f_i - omega (f_i - f_i^eq) + (1 - omega/2) S_i                                          (Guo et al. 2002)
#pragma once

#include "lbm/collision/collision_target.hpp"

namespace thalweg::lbm {

// Replaces f by its value after the collision. `with_bulk` as in moments_of.
template <bool with_bulk, typename Number>
[[gnu::always_inline]] inline void relax_bgk(Number (&f)[19], const CellMoments<Number>& m,
                                             const CollisionConstants<Number>& constants) {
  const Number keep = pack_constant<Number>(1) - m.omega;
  const Target<with_bulk, Number> target(m, constants, m.omega, m.omega);
  f[0] = keep * f[0] + target.rest();
  for_each_pair([&]<int i>() __attribute__((always_inline)) {
    const Number even = target.template even<i>(), odd = target.template odd<i>();
    f[i] = keep * f[i] + (even + odd);
    f[i + 1] = keep * f[i + 1] + (even - odd);
  });
}

}  // namespace thalweg::lbm
