// What a rule of interpolated bounce-back says about a link:
//   f_i'(x_f, t+1) = incident f_i^c(x_f) + second (the rule's second value) - wall w_i rho c_i.u_w.
#pragma once

namespace thalweg::lbm {

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

}  // namespace thalweg::lbm
