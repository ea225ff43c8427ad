// Which owned cells have a covered cell near them: one whose centre is within a radius of a few cells of theirs.
//
// A count per cell, of the covered cells in the ball around it, follows every cell that is covered or uncovered. The
// ball reaches beyond the block, so bodies must be known in more layers around it than the populations' one ghost cell.
#pragma once

#include "lbm/populations.hpp"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace thalweg::lbm {

// Largest component of the vectors between cells whose squared length is not above this.
constexpr int layers_within(int radius_squared) {
  int layers = 0;
  while ((layers + 1) * (layers + 1) <= radius_squared) ++layers;
  return layers;
}

constexpr int near_body_radius_squared = 9;  // cells^2; 2: a cell's 18 neighbours
// Layers around a block in which covered cells are near to owned ones.
constexpr int near_body_layers = layers_within(near_body_radius_squared);
static_assert(near_body_layers >= 1 && near_body_layers <= 3);

class NearBodies {
public:
  // No cell is covered yet. radius_squared: cells^2, below 16.
  explicit NearBodies(const CellIndexing& indexing, int radius_squared = near_body_radius_squared);

  // A cell has become covered (1) or fluid (-1). Local coordinates: owned, or as far beyond as the radius reaches.
  void cell_changes(int x, int y, int z, int change);

  // The same where nobody keeps who covers a cell: it is covered while more bodies have claimed it (1) than given up
  // their claim (-1).
  void claims_change(int x, int y, int z, int change);

  // For each pack of an owned row a bit for each cell, 1 where a covered cell is near (a covered cell is near itself).
  const std::uint16_t* in_packs(int y, int z) const { return bits_.data() + row_of(y, z) * indexing_.packs_per_row(); }
  bool any_in_row(int y, int z) const { return cells_in_row_[row_of(y, z)] > 0; }

private:
  static constexpr std::size_t cells_at_once = 8;  // as many as are counted as one vector

  struct Run {  // cells of the ball in one row, relative to its centre: from -half_width to half_width
    int y, z, half_width;
    std::array<std::uint8_t, cells_at_once> one;  // for each of them, else 0
  };

  void turn_bits(const Run& run, int x, int y, int z, const std::uint8_t* counts, int change);

  std::size_t row_of(int y, int z) const { return static_cast<std::size_t>(z) * indexing_.size()[1] + y; }
  std::int64_t place_of(int x, int y, int z) const;

  CellIndexing indexing_;
  int layers_;
  std::vector<Run> runs_;
  // Of rows with enough room at their ends for the runs of any cell that may change.
  std::size_t row_stride_;
  std::vector<std::uint8_t> counts_;
  std::vector<std::uint16_t> bits_;
  std::vector<std::int32_t> cells_in_row_;                 // whose bit is 1
  std::unordered_map<std::int64_t, std::int32_t> claims_;  // by place_of()
};

}  // namespace thalweg::lbm
