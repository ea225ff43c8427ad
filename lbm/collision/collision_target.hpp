// Equilibrium and force of a cell, which its populations relax to.
#pragma once

#include "lbm/collision/cell_moments.hpp"

namespace thalweg::lbm {

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

}  // namespace thalweg::lbm
