// What a rule of interpolated bounce-back says about a link:
//   f_i'(x_f, t+1) = incident f_i^c(x_f) + second (the rule's second value) - wall w_i rho c_i.u_w.
#pragma once

namespace thalweg::lbm {

template <typename Real>
struct LinkWeights {
  Real incident, second, wall;
};

}  // namespace thalweg::lbm
