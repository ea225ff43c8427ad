// Large arrays in huge pages of memory.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace thalweg {

struct FreeMemory {
  void operator()(void* memory) const;
};

template <typename T>
using HugePages = std::unique_ptr<T[], FreeMemory>;

// Bytes, rounded up to whole huge pages, whose contents are undefined. Throws std::bad_alloc.
void* allocate_huge_pages(std::size_t bytes);

// An array of `count` values, which are undefined until they are set. Walking through distant parts of it at once needs
// few entries of the TLB, and its first use takes one fault every 2 MiB instead of one every 4 KiB. Where the system
// has no huge pages, it is like any other array. Throws std::bad_alloc.
template <typename T>
HugePages<T> allocate_huge_pages_for(std::size_t count) {
  static_assert(std::is_trivial_v<T>);
  return HugePages<T>(static_cast<T*>(allocate_huge_pages(count * sizeof(T))));
}

}  // namespace thalweg
