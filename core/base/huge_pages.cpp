#include "core/base/huge_pages.hpp"

#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace thalweg {

void FreeMemory::operator()(void* memory) const { std::free(memory); }

void* allocate_huge_pages(std::size_t bytes) {
  constexpr std::size_t huge_page = std::size_t{2} << 20;
  void* memory = std::aligned_alloc(huge_page, (bytes + huge_page - 1) / huge_page * huge_page);
  if (!memory) throw std::bad_alloc();
#if defined(__linux__)
  madvise(memory, bytes, MADV_HUGEPAGE);  // only a hint: its failure changes nothing
#endif
  return memory;
}

}  // namespace thalweg
