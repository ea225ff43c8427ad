// Prefetches the populations of a tile into the second-level cache, a share at a time, between other work.
#pragma once

#include "lbm/lattice/populations.hpp"
#include "lbm/lattice/row_tiles.hpp"

#include <array>
#include <cstddef>

namespace thalweg::bodies {

template <typename Real>
class TilePrefetch {
public:
  // Valid for one step, within which the arrangement does not change. Both arguments must outlive it.
  TilePrefetch(const lbm::Populations<Real>& populations, const lbm::RowTiles& tiles)
      : indexing_(populations.indexing()), tiles_(tiles), sent_(populations.sent()) {}

  void begin(int tile) {
    const int block = tiles_.block_of(tile);
    first_row_ = tiles_.first_row(block);
    plane_ = tiles_.plane_of(tile);
    lines_ = lines_per_row() * (tiles_.end_row(block) - first_row_);
    asked_ = 0;
  }
  void begin_nothing() { lines_ = asked_ = 0; }

  // Prefetches on, up to this share of the tile, in [0, 1].
  void advance(double share) {
    const int end = static_cast<int>(share * lines_);
    for (; asked_ < end; ++asked_) {
      const int row = first_row_ + asked_ / lines_per_row(), x = asked_ % lines_per_row() * cells_per_line;
      const std::ptrdiff_t cell = indexing_.index(x, row, plane_);
      constexpr int to_read = 0, second_level = 2;
      for (const Real* slots : sent_) __builtin_prefetch(slots + cell, to_read, second_level);
    }
  }

private:
  static constexpr int cells_per_line = 64 / sizeof(Real);
  // One line more, because a row may begin anywhere in a line.
  int lines_per_row() const { return indexing_.size()[0] / cells_per_line + 1; }

  const lbm::CellIndexing& indexing_;
  const lbm::RowTiles& tiles_;
  std::array<const Real*, lbm::D3Q19::directions> sent_;  // lbm::Populations::sent()
  int first_row_ = 0, plane_ = 0, lines_ = 0, asked_ = 0;
};

}  // namespace thalweg::bodies
