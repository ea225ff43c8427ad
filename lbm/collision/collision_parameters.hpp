// Parameters of the collision. Lattice units; the equations are in cell_moments.hpp and collision_*.hpp.
#pragma once

#include "core/base/types.hpp"
#include "lbm/collision/collision_model.hpp"
#include "lbm/collision/subgrid.hpp"

namespace thalweg::lbm {

struct CollisionParameters {
  CollisionModel model = CollisionModel::bgk;
  double magic_parameter = 3.0 / 16.0;  // of both trt
  double relaxation_time = 1.0;         // tau_0 = 1/2 + 3 nu dt/dx^2
  double bulk_relaxation_time = 0.0;    // tau_b, above 1/2; 0: as the shear's, eddies included
  Subgrid subgrid;
  Vec3 force = Vec3::Zero();  // force density on the fluid

  bool with_bulk() const { return bulk_relaxation_time > 0.0; }

  // Relaxation rate omega' of the odd part, without eddies; with trt_at_bodies, in calm cells near a body.
  double odd_rate() const {
    if (!traits_of(model).is_trt_near_bodies) return 1.0 / relaxation_time;
    return 1.0 / (0.5 + magic_parameter / (relaxation_time - 0.5));
  }
};

}  // namespace thalweg::lbm
