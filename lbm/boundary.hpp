// What stands at each of the six faces of the domain.
#pragma once

#include "core/types.hpp"

#include <array>

namespace thalweg::lbm {

enum class FaceType {
  periodic,
  no_slip,           // half-link bounce-back: the wall is half a cell beyond the last cell centre
  free_slip,         // half-link specular reflection: no tangential stress, mass conserving
  law_of_the_wall    // Navier slip whose slip velocity follows the local friction velocity (see walls.hpp)
};

struct FaceCondition {
  FaceType type = FaceType::periodic;
  double slip_coefficient = 8.36;   // law_of_the_wall: slip velocity in units of the friction velocity
};

// Faces in the order x low, x high, y low, y high, z low, z high.
using FaceConditions = std::array<FaceCondition, 6>;

constexpr int face_of(int axis, bool high) { return 2 * axis + (high ? 1 : 0); }

}  // namespace thalweg::lbm
