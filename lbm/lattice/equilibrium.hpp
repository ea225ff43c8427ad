// Equilibrium populations (Qian, d'Humieres and Lallemand 1992) in deviation form (the whole library stores f_i - w_i):
//   f_i^eq - w_i = w_i { d + rho [ 3 c_i.u + (9/2)(c_i.u)^2 - (3/2) u.u ] },   rho = 1 + d.
#pragma once

#include "core/base/types.hpp"
#include "lbm/lattice/d3q19.hpp"

namespace thalweg::lbm {

// density_deviation = rho - 1, velocity in lattice units.
inline double equilibrium_deviation(int i, double density_deviation, const Vec3& velocity) {
  const double cu = D3Q19::c[i][0] * velocity.x() + D3Q19::c[i][1] * velocity.y() + D3Q19::c[i][2] * velocity.z();
  return D3Q19::weight(i) *
         (density_deviation + (1.0 + density_deviation) * (3.0 * cu + 4.5 * cu * cu - 1.5 * velocity.squaredNorm()));
}

}  // namespace thalweg::lbm
