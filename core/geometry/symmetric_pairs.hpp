// The order in which symmetric tensors are stored: xx, yy, zz, xy, xz, yz.
#pragma once

namespace thalweg {

// Axes of the two indices of each component.
inline constexpr int symmetric_pairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

}  // namespace thalweg
