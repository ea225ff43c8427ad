// The collision operators and their properties, all in one place; the equations are in collision_bgk.hpp and so on. A
// new one is an enumerator, its cases here, for which the compiler asks, and a branch of relax() in collision.hpp
// (tests/lbm/extension adds one).
#pragma once

#include "core/keys/named_choice.hpp"

#include <array>
#include <vector>

namespace thalweg::lbm {

enum class CollisionModel { bgk, trt, trt_at_bodies };
inline constexpr std::array collision_models{CollisionModel::bgk, CollisionModel::trt, CollisionModel::trt_at_bodies};

// Distances of the relaxation time from 1/2 in the map of docs/stability.md.
inline constexpr std::array stability_excesses{5e-2, 3e-2, 2e-2, 1e-2, 3e-3, 1e-3};

struct CollisionTraits {
  const char *name, *meaning;    // its word in a case file
  bool is_bgk_in_bulk;           // one relaxation time in cells that have no body beside them
  bool is_trt_near_bodies;       // two in cells that have one; the magic parameter counts
  double usual_magic_parameter;  // 3/16 puts half-link walls half way between cells; 1/4 lets disturbances of any wave
                                 // length decay fastest (Kuzmin, Ginzburg and Mohamad 2011), which moving grains in
                                 // turbulent water need more
  // Largest lattice velocity that is stable without a subgrid model, by stability_excesses; 0: none.
  std::array<double, stability_excesses.size()> stable_velocity;
};

constexpr CollisionTraits traits_of(CollisionModel model) {
  constexpr std::array bulk_bgk{0.15, 0.15, 0.15, 0.15, 0.05, 0.02}, bulk_trt{0.15, 0.15, 0.15, 0.10, 0.02, 0.0};
  switch (model) {
    case CollisionModel::bgk:
      return {"bgk", "one relaxation time", true, false, 3.0 / 16.0, bulk_bgk};
    case CollisionModel::trt:
      return {"trt", "two relaxation times; walls stay in place at any viscosity", false, true, 3.0 / 16.0, bulk_trt};
    case CollisionModel::trt_at_bodies:
      return {"trt_at_bodies", "trt in calm cells near grains and solids, bgk elsewhere", true, true, 0.25, bulk_bgk};
  }
  __builtin_unreachable();
}

// The words in a case file (core/keys/section_visitor.hpp).
std::vector<NamedChoice<CollisionModel>> choices_of(CollisionModel);

// Calls visit.operator()<model>() with the model as a constant.
template <typename Visit>
decltype(auto) with_constant(CollisionModel model, Visit visit) {
  switch (model) {
    case CollisionModel::bgk:
      return visit.template operator()<CollisionModel::bgk>();
    case CollisionModel::trt:
      return visit.template operator()<CollisionModel::trt>();
    case CollisionModel::trt_at_bodies:
      return visit.template operator()<CollisionModel::trt_at_bodies>();
  }
  __builtin_unreachable();
}

}  // namespace thalweg::lbm
