// Two relaxation times: the even part (f_i + f_i')/2, i' the opposite of i, relaxes with omega = 1/tau, the odd part
// (f_i - f_i')/2 with omega', where
//   (1/omega - 1/2)(1/omega' - 1/2) = magic parameter                                         (Ginzburg et al. 2008)
// fixes where walls are, whatever the viscosity.
#pragma once

#include "lbm/collision/collision_target.hpp"

namespace thalweg::lbm {

// omega' of trt: (2 - omega)/(1 + omega (2 magic - 1/2)).
template <typename Number>
[[gnu::always_inline]] inline Number odd_rate_of(const Number& omega, const CollisionConstants<Number>& constants) {
  constexpr auto constant = pack_constant<Number>;
  return (constant(2) - omega) / (constant(1) + constants.odd_rate_offset * omega);
}

// The even part with the cell's omega, the odd part with a rate of its own.
template <bool with_bulk, typename Number>
[[gnu::always_inline]] inline void relax_trt(Number (&f)[19], const CellMoments<Number>& m,
                                             const CollisionConstants<Number>& constants, const Number& odd_rate) {
  constexpr auto constant = pack_constant<Number>;
  const Number keep_even = constant(1) - m.omega, keep_odd = constant(1) - odd_rate;
  const Number same = constant(0.5) * (keep_even + keep_odd), swapped = constant(0.5) * (keep_even - keep_odd);
  const Target<with_bulk, Number> target(m, constants, m.omega, odd_rate);
  f[0] = keep_even * f[0] + target.rest();
  for_each_pair([&]<int i>() __attribute__((always_inline)) {
    const Number even = target.template even<i>(), odd = target.template odd<i>();
    const Number plus = f[i], minus = f[i + 1];
    f[i] = same * plus + (swapped * minus + (even + odd));
    f[i + 1] = same * minus + (swapped * plus + (even - odd));
  });
}

}  // namespace thalweg::lbm
