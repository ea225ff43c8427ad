// Names of the components of vectors and tensors in profiles.
#pragma once

#include <string>
#include <vector>

namespace thalweg::analysis {

inline const std::vector<std::string> vector_names{"x", "y", "z"};
inline const std::vector<std::string> symmetric_names{"xx", "yy", "zz", "xy", "xz", "yz"};
inline const std::vector<std::string> tensor_names{"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
inline constexpr int symmetric_pairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

}  // namespace thalweg::analysis
