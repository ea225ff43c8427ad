// Moments and relaxation rate of a cell before its collision, a pure function of 19 values. Number is a plain number or
// a SIMD pack. Lattice units; populations are deviations f_i - w_i.
//
//   d = sum f_i,  rho = 1 + d,  m = sum c_i f_i,  u = (m + F/2)/rho,
//   f_i^eq = w_i {d + rho [3 c_i.u + 9/2 (c_i.u)^2 - 3/2 u.u]},  S_i = w_i [3 (c_i - u).F + 9 (c_i.u)(c_i.F)]
//   Pi_ab = sum c_ia c_ib (f_i - f_i^eq) + (u_a F_b + u_b F_a)/2,   rate of strain S_ab = -3/(2 rho tau) Pi_ab.
// The force term in Pi makes the rate of strain exact to the order of the Chapman-Enskog expansion. Written out,
//   Pi_ab = sum c_ia c_ib f_i - d/3 delta_ab - (m_a m_b - F_a F_b/4)/rho.
// tau follows from Pi by the subgrid model (subgrid.hpp).
//
// With a bulk relaxation time tau_b the trace of the second moment relaxes with omega_b = 1/tau_b in place of omega, in
// every collision (d'Humieres et al. 2002 relax it as a moment of its own). A collision leaves (1 - omega) tr Pi + u.F
// of it, so that the difference, force term included, is
//   f_i^c += 3/2 w_i (c_i.c_i - 1) K,  K = (omega - omega_b) tr Pi:   -K/2 at rest, 0 on axes, K/24 on diagonals,
// which carries neither mass nor momentum. The fluid then has the bulk viscosity zeta = 2/9 (tau_b - 1/2).
#pragma once

#include "lbm/collision/collision_parameters.hpp"
#include "lbm/lattice/d3q19.hpp"
#include "lbm/lattice/pack_constant.hpp"
#include "lbm/lattice/symmetric.hpp"

#include <cmath>

namespace thalweg::lbm {

// Moments of a cell for the relaxation and for wall models.
template <typename Number>
struct CellMoments {
  Number deviation;   // d
  Number mx, my, mz;  // m, without the half force
  Number inverse_rho;
  Number omega;          // 1/tau
  Symmetric<Number> pi;  // Pi; shear rate of a component: 2 |S_ab| = 3 |Pi_ab| omega/rho
  Number bulk;           // K/24; set and used with a bulk relaxation time of its own
};

// Constants of the collision, in packs.
template <typename Number>
struct CollisionConstants {
  Number tau0, tau0_squared, subgrid_factor;  // subgrid_factor: Subgrid::closure_factor()
  Number omega0, odd_rate_offset;             // 1/tau_0;  2 magic parameter - 1/2
  Number omega_bulk;                          // 1/tau_b, where it is of its own
  Number force[3], half_force[3];
  Symmetric<Number> quarter;  // F_a F_b/4
  Number cross[3], odd[3];    // 9 w F and 3 w F with the diagonal weight w

  [[gnu::always_inline]] explicit CollisionConstants(const CollisionParameters& p) {
    constexpr auto constant = pack_constant<Number>;
    constexpr double w = D3Q19::diagonal_weight;
    const Vec3& f = p.force;
    tau0 = constant(p.relaxation_time);
    tau0_squared = constant(p.relaxation_time * p.relaxation_time);
    subgrid_factor = constant(p.subgrid.closure_factor());
    omega0 = constant(1.0 / p.relaxation_time);
    odd_rate_offset = constant(2.0 * p.magic_parameter - 0.5);
    omega_bulk = constant(p.with_bulk() ? 1.0 / p.bulk_relaxation_time : 0.0);
    for (int a = 0; a < 3; ++a) {
      force[a] = constant(f[a]);
      half_force[a] = constant(0.5 * f[a]);
      cross[a] = constant(9.0 * w * f[a]);
      odd[a] = constant(3.0 * w * f[a]);
    }
    quarter = {constant(0.25 * f[0] * f[0]), constant(0.25 * f[1] * f[1]), constant(0.25 * f[2] * f[2]),
               constant(0.25 * f[0] * f[1]), constant(0.25 * f[0] * f[2]), constant(0.25 * f[1] * f[2])};
  }
};

// `subgrid` is the model of the parameters that the constants are made from. `with_bulk` false: the trace relaxes as
// the rest of Pi, whatever the bulk_relaxation_time.
template <SubgridModel subgrid, bool with_bulk = false, typename Number>
[[gnu::always_inline]] inline CellMoments<Number> moments_of(const Number (&f)[19],
                                                             const CollisionConstants<Number>& constants) {
  using std::sqrt;
  constexpr auto constant = pack_constant<Number>;
  const Number x = f[1] + f[2], y = f[3] + f[4], z = f[5] + f[6];
  const Number xy = f[7] + f[8], xmy = f[9] + f[10], xz = f[11] + f[12], xmz = f[13] + f[14], yz = f[15] + f[16],
               ymz = f[17] + f[18];
  const Number in_xy = xy + xmy, in_xz = xz + xmz, in_yz = yz + ymz;
  const Number xy_along = f[7] - f[8], xmy_along = f[9] - f[10], xz_along = f[11] - f[12], xmz_along = f[13] - f[14],
               yz_along = f[15] - f[16], ymz_along = f[17] - f[18];

  CellMoments<Number> m;
  m.deviation = f[0] + ((x + y) + z) + ((in_xy + in_xz) + in_yz);
  m.mx = (f[1] - f[2]) + (xy_along + xmy_along) + (xz_along + xmz_along);
  m.my = (f[3] - f[4]) + (xy_along - xmy_along) + (yz_along + ymz_along);
  m.mz = (f[5] - f[6]) + (xz_along - xmz_along) + (yz_along - ymz_along);
  m.inverse_rho = constant(1) / (constant(1) + m.deviation);

  const Number vx = m.mx * m.inverse_rho, vy = m.my * m.inverse_rho, vz = m.mz * m.inverse_rho;
  const Symmetric<Number>& quarter = constants.quarter;
  const Number pressure = constant(1.0 / 3.0) * m.deviation;
  m.pi.xx = ((x - pressure) + (in_xy + in_xz)) - (m.mx * vx - quarter.xx * m.inverse_rho);
  m.pi.yy = ((y - pressure) + (in_xy + in_yz)) - (m.my * vy - quarter.yy * m.inverse_rho);
  m.pi.zz = ((z - pressure) + (in_xz + in_yz)) - (m.mz * vz - quarter.zz * m.inverse_rho);
  m.pi.xy = (xy - xmy) - (m.mx * vy - quarter.xy * m.inverse_rho);
  m.pi.xz = (xz - xmz) - (m.mx * vz - quarter.xz * m.inverse_rho);
  m.pi.yz = (yz - ymz) - (m.my * vz - quarter.yz * m.inverse_rho);

  if constexpr (subgrid == SubgridModel::none) {
    m.omega = constants.omega0;
  } else {
    const Number subgrid_factor = constants.subgrid_factor * m.inverse_rho;
    m.omega =
        constant(2) /
        (constants.tau0 + sqrt(constants.tau0_squared + subgrid_factor * subgrid_invariant<subgrid, with_bulk>(m.pi)));
  }
  if constexpr (with_bulk) m.bulk = constant(1.0 / 24.0) * ((m.omega - constants.omega_bulk) * m.pi.trace());
  return m;
}

}  // namespace thalweg::lbm
