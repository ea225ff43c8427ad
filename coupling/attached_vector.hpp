// Vectors in the columns attached to a grain (dem/grain_store.hpp), by their first column.
#pragma once

#include "core/types.hpp"

#include <span>

namespace thalweg::coupling {

inline Vec3 vector_at(std::span<const double> columns, int first) {
  return {columns[first], columns[first + 1], columns[first + 2]};
}

inline void set_vector(std::span<double> columns, int first, const Vec3& value) {
  for (int a = 0; a < 3; ++a) columns[first + a] = value[a];
}

}  // namespace thalweg::coupling
