// The rows of every plane in blocks so narrow that the populations of three planes of a block stay in the processor's
// second-level cache. A tile is a block of rows in one plane; tiles are numbered in the order of a step, which goes up
// through the planes of one block after the other. What is computed does not depend on the tiles.
#pragma once

#include "core/base/types.hpp"

#include <cstddef>

namespace thalweg::lbm {

class RowTiles {
public:
  // size: owned cells; row_bytes: all populations of one row.
  RowTiles(const Index3& size, std::size_t row_bytes);

  int blocks() const { return blocks_; }
  int planes() const { return planes_; }
  int count() const { return blocks_ * planes_; }
  int tile_of(int y, int z) const { return y / rows_ * planes_ + z; }
  int block_of(int tile) const { return tile / planes_; }
  int plane_of(int tile) const { return tile % planes_; }
  int first_row(int block) const { return block * rows_; }
  int end_row(int block) const { return block + 1 < blocks_ ? (block + 1) * rows_ : all_rows_; }

private:
  int all_rows_, planes_, rows_, blocks_;
};

}  // namespace thalweg::lbm
