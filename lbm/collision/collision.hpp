// A cell's collision in two steps: its moments first (cell_moments.hpp), then the relaxation, a file for each model.
#pragma once

#include "lbm/collision/collision_bgk.hpp"
#include "lbm/collision/collision_trt.hpp"
#include "lbm/collision/collision_trt_at_bodies.hpp"

namespace thalweg::lbm {

// Replaces f by its value after the collision; with trt_at_bodies beside a body, in_gap as in calmness_of().
template <CollisionModel model, bool with_bulk, typename Number>
[[gnu::always_inline]] inline void relax(Number (&f)[19], const CellMoments<Number>& m,
                                         const CollisionConstants<Number>& constants,
                                         const Number& in_gap = Number(1)) {
  if constexpr (model == CollisionModel::bgk) {
    relax_bgk<with_bulk>(f, m, constants);
  } else if constexpr (model == CollisionModel::trt) {
    relax_trt<with_bulk>(f, m, constants, odd_rate_of(m.omega, constants));
  } else {
    static_assert(model == CollisionModel::trt_at_bodies);
    relax_trt_at_bodies<with_bulk>(f, m, constants, calmness_of(f, m, constants, in_gap));
  }
}

// Both steps at once; returns the moments before the collision.
template <CollisionModel model, SubgridModel subgrid, bool with_bulk = false, typename Number>
[[gnu::always_inline]] inline CellMoments<Number> collide(Number (&f)[19], const CollisionParameters& parameters,
                                                          const Number& in_gap = Number(1)) {
  const CollisionConstants<Number> constants(parameters);
  const CellMoments<Number> m = moments_of<subgrid, with_bulk>(f, constants);
  relax<model, with_bulk>(f, m, constants, in_gap);
  return m;
}

}  // namespace thalweg::lbm
