// Two relaxation times beside bodies (CellMap::beside_bodies) as long as a cell is calm, one elsewhere. With n the odd
// non-equilibrium of a cell beside a body, of which trt keeps nearly all in water,
//   n^2 = sum over the nine pairs of [(f_i - f_i')/2 - (f_i^eq - f_i'^eq)/2]^2,
//   a = lambda^4/(n^4 + lambda^4), in gaps (CellMap::in_gaps) lambda_g^2/(n^2 + lambda_g^2),
// both the odd rate and the relaxation of the trace go from trt's to those of the open fluid:
//   omega' = omega + a (omega'_trt - omega),   the bulk term of cell_moments.hpp times 1 - a.
// So water flows through pores and past grains as with trt, and where the odd parts would grow until the run breaks
// down, single cells between moving grains above all, they fall back to bgk, which is stable there. A trace that
// relaxes on its own would have the magic parameter (tau_b - 1/2)(1/omega' - 1/2), hundreds in water, and stop a tenth
// of the flow through a bed; far from bodies it damps sound.
//
// Where a body meets open water, trt makes a fast stream lose too much at it, the less so the smaller lambda is, down
// to where seepage suffers. In gaps the water that one body squeezes out before another must get away, fast as it is,
// which with bgk it does not: there trt gives way later and more slowly, to the point where single cells break down.
#pragma once

#include "lbm/collision/collision_trt.hpp"

namespace thalweg::lbm {

// lambda, in lattice units of the populations: benchmarks/validation/seepage says what it trades.
constexpr double quiet = 0.002, quiet_in_gaps = 0.01;

// a in cells beside bodies, before the collision. in_gap: 1 in gaps, else 0.
template <typename Number>
[[gnu::always_inline]] inline Number calmness_of(const Number (&f)[19], const CellMoments<Number>& m,
                                                 const CollisionConstants<Number>& constants, const Number& in_gap) {
  constexpr auto constant = pack_constant<Number>;
  constexpr double open = quiet * quiet * quiet * quiet, gap = quiet_in_gaps * quiet_in_gaps;
  const Number jx = m.mx + constants.half_force[0], jy = m.my + constants.half_force[1],
               jz = m.mz + constants.half_force[2];
  Number noise = constant(0);
  for_each_pair([&]<int i>() __attribute__((always_inline)) {
    const Number odd = constant(0.5) * (f[i] - f[i + 1]) - constant(3.0 * D3Q19::weight(i)) * along<i>(jx, jy, jz);
    noise += odd * odd;
  });
  const Number limit = constant(open) + constant(gap * gap - open) * in_gap;
  const Number other = noise + (constant(gap) - noise) * in_gap;  // the other factor of the noise
  return limit / (noise * other + limit);
}

// `calmness`: a; 0 in the open, which leaves bgk.
template <bool with_bulk, typename Number>
[[gnu::always_inline]] inline void relax_trt_at_bodies(Number (&f)[19], CellMoments<Number> m,
                                                       const CollisionConstants<Number>& constants,
                                                       const Number& calmness) {
  if constexpr (with_bulk) m.bulk *= pack_constant<Number>(1) - calmness;
  relax_trt<with_bulk>(f, m, constants, m.omega + calmness * (odd_rate_of(m.omega, constants) - m.omega));
}

}  // namespace thalweg::lbm
