// Prefetching of an object into the cache.
#pragma once

#include <cstddef>

namespace thalweg {

template <typename Object>
inline void prefetch(const Object& object) {
  constexpr std::size_t line = 64;  // bytes
  for (std::size_t byte = 0; byte < sizeof(Object); byte += line)
    __builtin_prefetch(reinterpret_cast<const char*>(&object) + byte);
}

}  // namespace thalweg
