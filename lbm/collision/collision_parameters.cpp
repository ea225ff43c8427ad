#include "lbm/collision/collision_parameters.hpp"

namespace thalweg::lbm {

std::vector<NamedChoice<CollisionModel>> choices_of(CollisionModel) {
  return {{CollisionModel::bgk, "bgk", "one relaxation time"},
          {CollisionModel::trt, "trt", "two relaxation times; walls stay in place at any viscosity"},
          {CollisionModel::trt_at_bodies, "trt_at_bodies", "trt in calm cells near grains and solids, bgk elsewhere"}};
}

}  // namespace thalweg::lbm
