// The loops over the cells of a block, in memory order.
#pragma once

#include "core/parallel/decomposition.hpp"
#include "lbm/lattice/cell_map.hpp"

namespace thalweg::lbm {

// Calls visit(index in memory, local coordinates) for every cell of a block in local coordinates.
template <typename Visit>
void for_each_cell(const CellIndexing& indexing, const Block& part, Visit visit) {
  for (int z = part.lower[2]; z < part.upper[2]; ++z)
    for (int y = part.lower[1]; y < part.upper[1]; ++y)
      for (int x = part.lower[0]; x < part.upper[0]; ++x) visit(indexing.index(x, y, z), Index3{x, y, z});
}

// Visits every owned cell.
template <typename Visit>
void for_each_cell(const CellIndexing& indexing, Visit visit) {
  for_each_cell(indexing, Block{{0, 0, 0}, indexing.size()}, visit);
}

// Visits every owned cell that no body covers.
template <typename Visit>
void for_each_fluid_cell(const CellMap& cells, Visit visit) {
  for_each_cell(cells.indexing(), [&](std::ptrdiff_t cell, const Index3& at) {
    if (cells.is_fluid(cell)) visit(cell, at);
  });
}

// The cells of a region (global coordinates) that a rank owns, in its local coordinates.
inline Block local_block(const Block& owned, const Block& region) {
  Block part = intersection(owned, region);
  for (int a = 0; a < 3; ++a) {
    part.lower[a] -= owned.lower[a];
    part.upper[a] -= owned.lower[a];
  }
  return part;
}

// Index of an owned cell in arrays without ghosts and padding.
inline std::size_t index_in_block(const CellIndexing& indexing, const Index3& at) {
  const Index3& n = indexing.size();
  return (static_cast<std::size_t>(at[2]) * n[1] + at[1]) * n[0] + at[0];
}

}  // namespace thalweg::lbm
