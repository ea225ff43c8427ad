// Which collision the fluid has, and its numbers. Lattice units; the equations are in cell_moments.hpp and
// collision_*.hpp.
#pragma once

#include "core/base/types.hpp"
#include "core/keys/named_choice.hpp"
#include "lbm/collision/subgrid.hpp"

#include <vector>

namespace thalweg::lbm {

enum class CollisionModel { bgk, trt, trt_at_bodies };

// Its words in a case file (core/keys/section_visitor.hpp).
std::vector<NamedChoice<CollisionModel>> choices_of(CollisionModel);

// Whether cells without a body near them have one relaxation time.
constexpr bool bgk_in_the_open(CollisionModel model) { return model != CollisionModel::trt; }

// Whether cells with a body near them have two, and so the magic parameter counts.
constexpr bool trt_near_bodies(CollisionModel model) { return model != CollisionModel::bgk; }

// 3/16 puts half-link walls exactly half way between cells. 1/4 is where disturbances of any wave length decay fastest
// (Kuzmin, Ginzburg and Mohamad 2011), which moving grains in turbulent water need more.
constexpr double usual_magic_parameter(CollisionModel model) {
  return model == CollisionModel::trt_at_bodies ? 0.25 : 3.0 / 16.0;
}

struct CollisionParameters {
  CollisionModel model = CollisionModel::bgk;
  double magic_parameter = 3.0 / 16.0;  // of both trt
  double relaxation_time = 1.0;         // tau_0 = 1/2 + 3 nu dt/dx^2
  double bulk_relaxation_time = 0.0;    // tau_b, above 1/2; 0: as the shear's, eddies included
  Subgrid subgrid;
  Vec3 force = Vec3::Zero();  // force density on the fluid

  bool with_bulk() const { return bulk_relaxation_time > 0.0; }

  // omega' of the odd part, without eddies: in trt_at_bodies that of calm cells near a body.
  double odd_rate() const {
    if (model == CollisionModel::bgk) return 1.0 / relaxation_time;
    return 1.0 / (0.5 + magic_parameter / (relaxation_time - 0.5));
  }
};

}  // namespace thalweg::lbm
