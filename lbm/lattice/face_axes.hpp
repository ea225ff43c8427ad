// The two axes along a face, in ascending order.
#pragma once

namespace thalweg::lbm {

constexpr int first_axis(int normal) { return normal == 0 ? 1 : 0; }
constexpr int second_axis(int normal) { return normal == 2 ? 1 : 2; }

}  // namespace thalweg::lbm
