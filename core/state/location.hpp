// A place in the box where something was found.
#pragma once

#include "core/base/types.hpp"

#include <vector>

namespace thalweg {

struct Location {
  Vec3 position = Vec3::Zero();  // m
  std::vector<GlobalId> grains;  // the grain, or the two in contact; none: the place is the centre of a fluid cell
};

}  // namespace thalweg
