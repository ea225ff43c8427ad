#include "lbm/collision/collision_model.hpp"

namespace thalweg::lbm {

std::vector<NamedChoice<CollisionModel>> choices_of(CollisionModel) {
  std::vector<NamedChoice<CollisionModel>> choices;
  for (const CollisionModel model : collision_models)
    choices.push_back({model, traits_of(model).name, traits_of(model).meaning});
  return choices;
}

}  // namespace thalweg::lbm
