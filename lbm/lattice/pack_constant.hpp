// Constants for code that is written once for plain numbers and for SIMD packs.
#pragma once

#include <type_traits>

namespace thalweg::lbm {

// A constant in every lane, rounded once to the storage type.
template <typename Number>
[[gnu::always_inline]] inline Number pack_constant(double value) {
  if constexpr (std::is_arithmetic_v<Number>)
    return static_cast<Number>(value);
  else
    return Number(static_cast<typename Number::value_type>(value));
}

}  // namespace thalweg::lbm
