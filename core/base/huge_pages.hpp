// Large arrays in huge pages of memory.
#pragma once

#include <algorithm>
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

// An array of `count` equal values. Walking through distant parts of it at once needs few entries of the TLB, and
// filling it takes one fault every 2 MiB instead of one every 4 KiB. Where the system has no huge pages, it is like any
// other array. Throws std::bad_alloc.
template <typename T>
HugePages<T> in_huge_pages(std::size_t count, const T& value) {
  static_assert(std::is_trivial_v<T>);
  HugePages<T> array(static_cast<T*>(allocate_huge_pages(count * sizeof(T))));
  std::fill_n(array.get(), count, value);
  return array;
}

}  // namespace thalweg
