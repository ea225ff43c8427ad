// A sphere at a place: a member of a clump, an obstacle, a grain without a name.
#pragma once

#include "core/base/types.hpp"

namespace thalweg::dem {

struct PlacedSphere {
  Vec3 position;  // m
  double radius;  // m
};

}  // namespace thalweg::dem
