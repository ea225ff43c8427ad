// A sphere as the map of the cells knows it.
#pragma once

#include "core/base/types.hpp"

namespace thalweg::bodies {

struct MappedBody {
  static constexpr GlobalId nobody = -1;
  bool is_free() const { return id == nobody; }  // the slot: no body has it

  GlobalId id = nobody;
  GlobalId clump = -1;         // the clump it is a member of; -1: none
  double radius = 0.0;         // cells
  Vec3 centre = Vec3::Zero();  // for which its cells stand; lattice units, global
};

}  // namespace thalweg::bodies
