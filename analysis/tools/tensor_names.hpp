// Names of the components of vectors and tensors in profiles.
#pragma once

#include <string>
#include <vector>

namespace thalweg::analysis {

inline const std::vector<std::string> vector_names{"x", "y", "z"};
inline const std::vector<std::string> symmetric_names{"xx", "yy", "zz", "xy", "xz", "yz"};
inline const std::vector<std::string> tensor_names{"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};

}  // namespace thalweg::analysis
