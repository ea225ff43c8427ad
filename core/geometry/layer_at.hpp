// The layer of cells at a place along an axis.
#pragma once

#include <cmath>

namespace thalweg {

// Number, from 0; a place on the face between two layers belongs to the upper one, in spite of rounding. place,
// spacing: in one unit of length.
inline int layer_at(double place, double spacing) {
  constexpr double rounding = 1e-9;  // cells
  return static_cast<int>(std::floor(place / spacing + rounding));
}

}  // namespace thalweg
