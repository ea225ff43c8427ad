// The D3Q19 lattice: velocities c_i, weights w_i, and which direction is whose opposite or mirror image.
//
// Direction 0 is rest; a direction and its opposite stand side by side (1,2), (3,4), ... so that kernels can treat them
// as a pair. Speed of sound c_s^2 = 1/3 in lattice units (Qian, d'Humieres and Lallemand 1992).
#pragma once

#include "core/base/types.hpp"

#include <utility>

namespace thalweg::lbm {

struct D3Q19 {
  static constexpr int directions = 19;

  static constexpr int c[19][3] = {{0, 0, 0},                                                              // rest
                                   {1, 0, 0}, {-1, 0, 0},  {0, 1, 0},  {0, -1, 0}, {0, 0, 1}, {0, 0, -1},  // axes
                                   {1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {-1, 1, 0},   // diagonals in x-y
                                   {1, 0, 1}, {-1, 0, -1}, {1, 0, -1}, {-1, 0, 1},   // diagonals in x-z
                                   {0, 1, 1}, {0, -1, -1}, {0, 1, -1}, {0, -1, 1}};  // diagonals in y-z

  static constexpr double rest_weight = 1.0 / 3.0, axis_weight = 1.0 / 18.0, diagonal_weight = 1.0 / 36.0;

  static constexpr double weight(int i) { return i == 0 ? rest_weight : i <= 6 ? axis_weight : diagonal_weight; }
  static constexpr int opposite(int i) { return i == 0 ? 0 : ((i - 1) ^ 1) + 1; }
  static constexpr int length_squared(int i) { return i == 0 ? 0 : i <= 6 ? 1 : 2; }

  // The direction with the given velocity; -1 if the lattice has none.
  static constexpr int index_of(int cx, int cy, int cz) {
    for (int i = 0; i < directions; ++i)
      if (c[i][0] == cx && c[i][1] == cy && c[i][2] == cz) return i;
    return -1;
  }

  // Direction i with its component along `axis` reversed (specular reflection at a wall normal to that axis).
  static constexpr int mirror(int i, int axis) {
    return index_of(axis == 0 ? -c[i][0] : c[i][0], axis == 1 ? -c[i][1] : c[i][1], axis == 2 ? -c[i][2] : c[i][2]);
  }
};

// Calls visit.operator()<i>() for every direction: a loop the compiler cannot leave rolled up, or it would keep the
// populations in memory instead of in registers.
template <typename Visit, int... i>
[[gnu::always_inline]] inline void unrolled(std::integer_sequence<int, i...>, Visit visit) {
  (visit.template operator()<i>(), ...);
}
template <typename Visit>
[[gnu::always_inline]] inline void for_each_direction(Visit visit) {
  unrolled(std::make_integer_sequence<int, D3Q19::directions>(), visit);
}

}  // namespace thalweg::lbm
