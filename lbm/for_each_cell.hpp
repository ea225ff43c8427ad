// The loops over the cells of a block, in memory order.
#pragma once

#include "lbm/cell_map.hpp"

namespace thalweg::lbm {

// Calls visit(index in memory, local coordinates) for every owned cell.
template <typename Visit>
void for_each_cell(const CellIndexing& indexing, Visit visit) {
  const Index3& n = indexing.size();
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) visit(indexing.index(x, y, z), Index3{x, y, z});
}

// For those that no body covers.
template <typename Visit>
void for_each_fluid_cell(const CellMap& cells, Visit visit) {
  for_each_cell(cells.indexing(), [&](std::ptrdiff_t cell, const Index3& at) {
    if (cells.is_fluid(cell)) visit(cell, at);
  });
}

// Where an owned cell stands in arrays without ghosts and padding.
inline std::size_t place_in_block(const CellIndexing& indexing, const Index3& at) {
  const Index3& n = indexing.size();
  return (static_cast<std::size_t>(at[2]) * n[1] + at[1]) * n[0] + at[0];
}

}  // namespace thalweg::lbm
