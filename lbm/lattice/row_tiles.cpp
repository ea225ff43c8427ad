#include "lbm/lattice/row_tiles.hpp"

#include <unistd.h>

#include <algorithm>

namespace thalweg::lbm {

namespace {

// Bytes of the second-level cache; one mebibyte where the system does not say.
std::size_t second_level_cache() {
  long bytes = 0;
#ifdef _SC_LEVEL2_CACHE_SIZE
  bytes = sysconf(_SC_LEVEL2_CACHE_SIZE);
#endif
  return bytes > 0 ? static_cast<std::size_t>(bytes) : std::size_t{1} << 20;
}

}  // namespace

RowTiles::RowTiles(const Index3& size, std::size_t row_bytes) : all_rows_(size[1]), planes_(size[2]) {
  // Three planes of the block and the row on either side of it, in two thirds of the cache.
  const std::size_t fitting = second_level_cache() * 2 / 3 / (3 * std::max<std::size_t>(row_bytes, 1));
  rows_ = std::clamp(static_cast<int>(std::min<std::size_t>(fitting, 1u << 20)) - 2, 4, std::max(4, all_rows_));
  blocks_ = std::max(1, (all_rows_ + rows_ - 1) / rows_);
}

}  // namespace thalweg::lbm
