#include "bodies/map/enclosed_cells.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace thalweg::bodies {

using lbm::D3Q19;

namespace {

Index3 next(const Index3& cell, int direction) {
  const auto& c = D3Q19::c[direction];
  return {cell[0] + c[0], cell[1] + c[1], cell[2] + c[2]};
}

}  // namespace

bool EnclosedCells::is_open(const BodyMap& map, const Index3& cell, int direction) const {
  const Index3 there = next(cell, direction);
  return !cells_.is_beyond_wall(there) && !map.covers(there);
}

// The direction of the only fluid beside a cell.
int EnclosedCells::opening(const BodyMap& map, const Index3& cell) const {
  int found = none;
  for (int i = 1; i < D3Q19::directions; ++i) {
    if (!is_open(map, cell, i)) continue;
    if (found != none) return several;
    found = i;
  }
  return found;
}

std::vector<Index3> EnclosedCells::update(const BodyMap& map) {
  const lbm::CellIndexing& indexing = cells_.indexing();
  for (const CellChange& change : map.changes())
    for (int i = 0; i < D3Q19::directions; ++i) {
      const Index3 cell = next(change.cell, i);
      if (!indexing.owned(cell[0], cell[1], cell[2])) continue;
      const int direction = map.covers(cell) ? several : opening(map, cell);
      if (direction == several)
        pockets_.erase(cell);
      else
        pockets_[cell] = direction;
    }
  std::set<Index3> now;
  for (const auto& [cell, direction] : pockets_)
    if (direction == none || opening(map, next(cell, direction)) == D3Q19::opposite(direction))
      now.insert(now.end(), cell);
  std::vector<Index3> changed;
  std::set_symmetric_difference(cells_now_.begin(), cells_now_.end(), now.begin(), now.end(),
                                std::back_inserter(changed));
  cells_now_ = std::move(now);
  return changed;
}

}  // namespace thalweg::bodies
