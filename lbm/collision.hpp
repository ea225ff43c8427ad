// One cell's collision in two steps, each a pure function of 19 values: its moments and relaxation rate first, then the
// relaxation, one function for each model. Number is a plain number or a SIMD pack. Lattice units; populations are
// deviations f_i - w_i, i' is the opposite of i.
//
//   d = sum f_i,  rho = 1 + d,  m = sum c_i f_i,  u = (m + F/2)/rho,
//   f_i^eq = w_i {d + rho [3 c_i.u + 9/2 (c_i.u)^2 - 3/2 u.u]},  S_i = w_i [3 (c_i - u).F + 9 (c_i.u)(c_i.F)]
//   tau = [tau_0 + sqrt(tau_0^2 + 18 sqrt(2) C_s^2 Q/rho)]/2,  Q = sqrt(Pi_ab Pi_ab),               (Hou et al. 1994)
//   Pi_ab = sum c_ia c_ib (f_i - f_i^eq) + (u_a F_b + u_b F_a)/2,   S_ab = -3/(2 rho tau) Pi_ab.
// The force term in Pi makes S exact to the order of the Chapman-Enskog expansion; C_s is in cell sizes. Written out,
//   Pi_ab = sum c_ia c_ib f_i - d/3 delta_ab - (m_a m_b - F_a F_b/4)/rho.
//
// With omega = 1/tau:
//   bgk          f_i^c = f_i - omega (f_i - f_i^eq) + (1 - omega/2) S_i                               (Guo et al. 2002)
//   trt          the same for the even part (f_i + f_i')/2; the odd part (f_i - f_i')/2 relaxes with omega', where
//                (1/omega - 1/2)(1/omega' - 1/2) = magic parameter                           (Ginzburg et al. 2008)
//   trt_at_bodies  trt in cells with a body beside them (CellMap::beside_bodies), bgk elsewhere: walls and pores are
//                right, and the odd parts of the open fluid do not stay for hundreds of steps
//   regularised  bgk after f_i - f_i^eq has been replaced by its projection on Hermite polynomials up to second order,
//                w_i [-3/2 c_i.F + 9/2 (c_ia c_ib - delta_ab/3) sum_j c_ja c_jb (f_j - f_j^eq)]
//                (Latt and Chopard 2006; the first-order term is the half force, without which momentum would be lost)
//
// With a bulk relaxation time tau_b the trace of the second moment relaxes with omega_b = 1/tau_b in place of omega, in
// all three (d'Humieres et al. 2002 relax it as a moment of its own). The collisions above leave (1 - omega) tr Pi +
// u.F of it, so that the difference, force term included, is
//   f_i^c += 3/2 w_i (c_i.c_i - 1) K,  K = (omega - omega_b) tr Pi:   -K/2 at rest, 0 on axes, K/24 on diagonals,
// which carries neither mass nor momentum. The fluid then has the bulk viscosity zeta = 2/9 (tau_b - 1/2), and the
// subgrid model takes for Q the norm of the traceless part of Pi, since a slowly decaying trace is no sign of shear.
#pragma once

#include "lbm/collision_parameters.hpp"
#include "lbm/d3q19.hpp"
#include "lbm/pack_constant.hpp"

#include <cmath>
#include <type_traits>

namespace thalweg::lbm {

// A symmetric tensor.
template <typename Number>
struct Symmetric {
  Number xx, yy, zz, xy, xz, yz;

  [[gnu::always_inline]] Number trace() const { return xx + yy + zz; }
  [[gnu::always_inline]] Symmetric traceless() const {
    const Number third = pack_constant<Number>(1.0 / 3.0) * trace();
    return {xx - third, yy - third, zz - third, xy, xz, yz};
  }
  // The sum of the squares of all nine components.
  [[gnu::always_inline]] Number squared() const {
    return (xx * xx + yy * yy + zz * zz) + pack_constant<Number>(2) * (xy * xy + xz * xz + yz * yz);
  }
};

// What the relaxation needs to know of a cell, and a wall model may want.
template <typename Number>
struct CellMoments {
  Number deviation;   // d
  Number mx, my, mz;  // m, without the half force
  Number inverse_rho;
  Number omega;          // 1/tau
  Symmetric<Number> pi;  // Pi; shear rate of a component: 2 |S_ab| = 3 |Pi_ab| omega/rho
  Number bulk;           // K/24; set and used with a bulk relaxation time of its own
};

// The numbers a collision needs in every cell, ready in packs.
template <typename Number>
struct CollisionConstants {
  Number tau0, tau0_squared, eddies;  // eddies = 18 sqrt(2) C_s^2
  Number omega0, magic;               // 1/tau_0;  2 magic parameter - 1/2
  Number omega_bulk;                  // 1/tau_b, where it is of its own
  Number force[3], half_force[3];
  Symmetric<Number> quarter;  // F_a F_b/4
  Number cross[3], odd[3];    // 9 w F and 3 w F with the diagonal weight w

  [[gnu::always_inline]] explicit CollisionConstants(const CollisionParameters& p) {
    constexpr auto constant = pack_constant<Number>;
    constexpr double w = D3Q19::diagonal_weight;
    const double(&f)[3] = p.force;
    tau0 = constant(p.relaxation_time);
    tau0_squared = constant(p.relaxation_time * p.relaxation_time);
    eddies = constant(25.455844122715711 * p.smagorinsky_constant * p.smagorinsky_constant);
    omega0 = constant(1.0 / p.relaxation_time);
    magic = constant(2.0 * p.magic_parameter - 0.5);
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

// `with_eddies` false: omega = 1/tau_0 whatever the smagorinsky_constant. `with_bulk` false: the trace relaxes as the
// rest of Pi, whatever the bulk_relaxation_time.
template <bool with_eddies, bool with_bulk = false, typename Number>
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

  if constexpr (with_eddies) {
    Number squared;
    if constexpr (with_bulk)
      squared = m.pi.traceless().squared();
    else
      squared = m.pi.squared();
    const Number eddies = constants.eddies * m.inverse_rho;
    m.omega = constant(2) / (constants.tau0 + sqrt(constants.tau0_squared + eddies * sqrt(squared)));
  } else {
    m.omega = constants.omega0;
  }
  if constexpr (with_bulk) m.bulk = constant(1.0 / 24.0) * ((m.omega - constants.omega_bulk) * m.pi.trace());
  return m;
}

namespace detail {

// Calls pair.operator()<i>() with the first direction of each of the nine pairs of opposites.
template <typename Pair>
[[gnu::always_inline]] inline void for_each_pair(Pair pair) {
  pair.template operator()<1>();
  pair.template operator()<3>();
  pair.template operator()<5>();
  pair.template operator()<7>();
  pair.template operator()<9>();
  pair.template operator()<11>();
  pair.template operator()<13>();
  pair.template operator()<15>();
  pair.template operator()<17>();
}

// c_i . v for a direction known at compile time, without multiplications.
template <int i, typename Number>
[[gnu::always_inline]] inline Number along(const Number& x, const Number& y, const Number& z) {
  constexpr int cx = D3Q19::c[i][0], cy = D3Q19::c[i][1], cz = D3Q19::c[i][2];
  static_assert(cx > 0 || (cx == 0 && (cy > 0 || (cy == 0 && cz > 0))), "the first direction of a pair");
  if constexpr (cx == 1 && cy == 0 && cz == 0)
    return x;
  else if constexpr (cx == 0 && cy == 1 && cz == 0)
    return y;
  else if constexpr (cx == 0 && cy == 0)
    return z;
  else if constexpr (cx == 1 && cz == 0)
    return cy > 0 ? x + y : x - y;
  else if constexpr (cx == 1)
    return cz > 0 ? x + z : x - z;
  else
    return cz > 0 ? y + z : y - z;
}

// Equilibrium and force of a cell by pairs, each times its rate, both in units of the diagonal weight:
//   even part: even_rate f^eq + even_force S,   odd part: odd_rate f^eq + odd_force S.
template <bool with_bulk, typename Number>
struct Target {
  Number ux, uy, uz;
  Number common;                     // even part, the same for all directions
  Number at_rest, diagonal;          // the same at rest and on diagonals, where a bulk rate tells them apart
  Number quadratic;                  // times (c.u)^2
  Number cross_x, cross_y, cross_z;  // times (c.u), along c
  Number odd_x, odd_y, odd_z;        // along c

  [[gnu::always_inline]] Target(const CellMoments<Number>& m, const CollisionConstants<Number>& constants,
                                const Number& even_rate, const Number& odd_rate) {
    constexpr auto constant = pack_constant<Number>;
    constexpr double w = D3Q19::diagonal_weight;
    const auto& force = constants.force;
    const Number even_force = constant(1) - constant(0.5) * even_rate,
                 odd_force = constant(1) - constant(0.5) * odd_rate;
    const Number jx = m.mx + constants.half_force[0], jy = m.my + constants.half_force[1],
                 jz = m.mz + constants.half_force[2];
    ux = jx * m.inverse_rho;
    uy = jy * m.inverse_rho;
    uz = jz * m.inverse_rho;
    const Number u_dot_f = ux * force[0] + uy * force[1] + uz * force[2];
    const Number twice_energy = jx * ux + jy * uy + jz * uz;
    common = even_rate * (constant(w) * m.deviation - constant(1.5 * w) * twice_energy) -
             (constant(3.0 * w) * even_force) * u_dot_f;
    if constexpr (with_bulk) {
      at_rest = common - m.bulk;
      diagonal = common + m.bulk;
    }
    quadratic = (constant(4.5 * w) * even_rate) * (constant(1) + m.deviation);
    cross_x = constants.cross[0] * even_force;
    cross_y = constants.cross[1] * even_force;
    cross_z = constants.cross[2] * even_force;
    const Number rate = constant(3.0 * w) * odd_rate;
    odd_x = rate * jx + constants.odd[0] * odd_force;
    odd_y = rate * jy + constants.odd[1] * odd_force;
    odd_z = rate * jz + constants.odd[2] * odd_force;
  }

  template <int i>
  [[gnu::always_inline]] Number even() const {
    const Number cu = along<i>(ux, uy, uz);
    const Number half = common_of<i>() + cu * (quadratic * cu + along<i>(cross_x, cross_y, cross_z));
    return D3Q19::length_squared(i) == 1 ? half + half : half;
  }
  template <int i>
  [[gnu::always_inline]] Number odd() const {
    const Number half = along<i>(odd_x, odd_y, odd_z);
    return D3Q19::length_squared(i) == 1 ? half + half : half;
  }
  [[gnu::always_inline]] Number rest() const {
    return pack_constant<Number>(D3Q19::rest_weight / D3Q19::diagonal_weight) * common_of<0>();
  }

private:
  template <int i>
  [[gnu::always_inline]] const Number& common_of() const {
    if constexpr (with_bulk && i == 0)
      return at_rest;
    else if constexpr (with_bulk && D3Q19::length_squared(i) == 2)
      return diagonal;
    else
      return common;
  }
};

}  // namespace detail

// Replaces f by its value after the collision. `with_bulk` as in moments_of.
template <bool with_bulk, typename Number>
[[gnu::always_inline]] inline void relax_bgk(Number (&f)[19], const CellMoments<Number>& m,
                                             const CollisionConstants<Number>& constants) {
  const Number keep = pack_constant<Number>(1) - m.omega;
  const detail::Target<with_bulk, Number> target(m, constants, m.omega, m.omega);
  f[0] = keep * f[0] + target.rest();
  detail::for_each_pair([&]<int i>() __attribute__((always_inline)) {
    const Number even = target.template even<i>(), odd = target.template odd<i>();
    f[i] = keep * f[i] + (even + odd);
    f[i + 1] = keep * f[i + 1] + (even - odd);
  });
}

// omega' of trt: (2 - omega)/(1 + omega (2 magic - 1/2)).
template <typename Number>
[[gnu::always_inline]] inline Number odd_rate_of(const Number& omega, const CollisionConstants<Number>& constants) {
  constexpr auto constant = pack_constant<Number>;
  return (constant(2) - omega) / (constant(1) + constants.magic * omega);
}

// The even part with the cell's omega, the odd part with a rate of its own.
template <bool with_bulk, typename Number>
[[gnu::always_inline]] inline void relax_trt(Number (&f)[19], const CellMoments<Number>& m,
                                             const CollisionConstants<Number>& constants, const Number& odd_rate) {
  constexpr auto constant = pack_constant<Number>;
  const Number keep_even = constant(1) - m.omega, keep_odd = constant(1) - odd_rate;
  const Number same = constant(0.5) * (keep_even + keep_odd), swapped = constant(0.5) * (keep_even - keep_odd);
  const detail::Target<with_bulk, Number> target(m, constants, m.omega, odd_rate);
  f[0] = keep_even * f[0] + target.rest();
  detail::for_each_pair([&]<int i>() __attribute__((always_inline)) {
    const Number even = target.template even<i>(), odd = target.template odd<i>();
    const Number plus = f[i], minus = f[i + 1];
    f[i] = same * plus + (swapped * minus + (even + odd));
    f[i + 1] = same * minus + (swapped * plus + (even - odd));
  });
}

// With n = m + F, the momentum after the collision: f^c_i = w_i {d + 3 c_i.n + 9/2 (c_ia c_ib - delta_ab/3) P_ab},
//   P_ab = rho u_a u_b + (1 - omega) sum c_a c_b (f - f^eq) + (1 - omega/2)(u_a F_b + F_a u_b)
//        = (1 - omega) Pi_ab + (n_a n_b - F_a F_b/4)/rho,   and K/3 more on its diagonal.
template <bool with_bulk, typename Number>
[[gnu::always_inline]] inline void relax_regularised(Number (&f)[19], const CellMoments<Number>& m,
                                                     const CollisionConstants<Number>& constants) {
  constexpr auto constant = pack_constant<Number>;
  constexpr double w = D3Q19::diagonal_weight;
  const Number weight = constant(4.5 * w) * m.inverse_rho, keep = constant(4.5 * w) * (constant(1) - m.omega);
  const Number nx = m.mx + constants.force[0], ny = m.my + constants.force[1], nz = m.mz + constants.force[2];
  const Number hx = nx * weight, hy = ny * weight, hz = nz * weight;
  const Symmetric<Number>& quarter = constants.quarter;
  // 9/2 w P, the off-diagonals twice as both of a pair count.
  Number pxx = keep * m.pi.xx + (nx * hx - quarter.xx * weight), pyy = keep * m.pi.yy + (ny * hy - quarter.yy * weight),
         pzz = keep * m.pi.zz + (nz * hz - quarter.zz * weight);
  if constexpr (with_bulk) {
    pxx += m.bulk;
    pyy += m.bulk;
    pzz += m.bulk;
  }
  const Number twice = keep + keep;
  const auto doubled = [](const Number& a) { return a + a; };
  const Number pxy = twice * m.pi.xy + doubled(nx * hy - quarter.xy * weight),
               pxz = twice * m.pi.xz + doubled(nx * hz - quarter.xz * weight),
               pyz = twice * m.pi.yz + doubled(ny * hz - quarter.yz * weight);
  const Number common = constant(w) * m.deviation - constant(1.0 / 3.0) * (pxx + pyy + pzz);
  const Number ox = constant(3.0 * w) * nx, oy = constant(3.0 * w) * ny, oz = constant(3.0 * w) * nz;

  f[0] = constant(D3Q19::rest_weight / w) * common;
  detail::for_each_pair([&]<int i>() __attribute__((always_inline)) {
    constexpr int cx = D3Q19::c[i][0], cy = D3Q19::c[i][1], cz = D3Q19::c[i][2];
    Number even = common, odd = detail::along<i>(ox, oy, oz);
    if constexpr (cx != 0) even += pxx;
    if constexpr (cy != 0) even += pyy;
    if constexpr (cz != 0) even += pzz;
    if constexpr (cx * cy != 0) even = cx * cy > 0 ? even + pxy : even - pxy;
    if constexpr (cx * cz != 0) even = cx * cz > 0 ? even + pxz : even - pxz;
    if constexpr (cy * cz != 0) even = cy * cz > 0 ? even + pyz : even - pyz;
    if constexpr (D3Q19::length_squared(i) == 1) {
      even += even;
      odd += odd;
    }
    f[i] = even + odd;
    f[i + 1] = even - odd;
  });
}

// With trt_at_bodies, the relaxation beside a body.
template <CollisionModel model, bool with_bulk, typename Number>
[[gnu::always_inline]] inline void relax(Number (&f)[19], const CellMoments<Number>& m,
                                         const CollisionConstants<Number>& constants) {
  if constexpr (model == CollisionModel::bgk)
    relax_bgk<with_bulk>(f, m, constants);
  else if constexpr (model == CollisionModel::regularised)
    relax_regularised<with_bulk>(f, m, constants);
  else
    relax_trt<with_bulk>(f, m, constants, odd_rate_of(m.omega, constants));
}

// Both steps at once; returns the moments before the collision.
template <CollisionModel model, bool with_eddies, bool with_bulk = false, typename Number>
[[gnu::always_inline]] inline CellMoments<Number> collide(Number (&f)[19], const CollisionParameters& parameters) {
  const CollisionConstants<Number> constants(parameters);
  const CellMoments<Number> m = moments_of<with_eddies, with_bulk>(f, constants);
  relax<model, with_bulk>(f, m, constants);
  return m;
}

}  // namespace thalweg::lbm
