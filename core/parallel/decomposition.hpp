// Decomposition of the box among ranks: a Cartesian grid of blocks of cells, one block a rank, shared by lattice and
// grains.
//
// Cell (i, j, k) covers [i, i+1) x [j, j+1) x [k, k+1) times the spacing; its centre, where the populations live, is at
// (i+1/2, j+1/2, k+1/2) times the spacing. Walls stand on the outer faces of the box (half a link from the last
// centre).
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace thalweg {

// A box of cells: lower inclusive, upper exclusive, in global cell coordinates.
struct Block {
  Index3 lower{0, 0, 0};
  Index3 upper{0, 0, 0};

  Index3 size() const { return {upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]}; }
  bool contains(const Index3& cell) const {
    for (int a = 0; a < 3; ++a)
      if (cell[a] < lower[a] || cell[a] >= upper[a]) return false;
    return true;
  }
  // Number of cells; zero where upper is not above lower on some axis.
  std::int64_t volume() const {
    std::int64_t cells = 1;
    for (const int n : size()) cells *= n > 0 ? n : 0;
    return cells;
  }
  // Index of a cell of the block in arrays over the block: x fastest, z slowest.
  std::int64_t location_of(const Index3& cell) const {
    const Index3 n = size();
    const std::int64_t row = static_cast<std::int64_t>(cell[2] - lower[2]) * n[1] + (cell[1] - lower[1]);
    return row * n[0] + (cell[0] - lower[0]);
  }
  bool operator==(const Block& other) const = default;
};

// The cells that both blocks hold; of volume zero where there are none.
Block intersection(Block a, const Block& b);

class Decomposition {
public:
  static constexpr int min_cells_per_rank = 4;
  static constexpr Index3 fewest{min_cells_per_rank, min_cells_per_rank, min_cells_per_rank};

  // cells: global number of cells; spacing: m (or 1 for lattice units); layout: ranks along x, y, z; least: cells that
  // a rank needs along each axis that is cut, at least min_cells_per_rank. Throws InputError where one would get fewer.
  Decomposition(const Index3& cells, double spacing, const std::array<bool, 3>& periodic, const Index3& layout,
                const Index3& least = fewest);

  // The layout for `ranks` ranks with the smallest surface between blocks, where cuts in z count 32-fold (a bed is
  // alike everywhere in plan, so columns balance) and cuts in x fourfold. Throws InputError if none fits.
  static Index3 best_layout(const Index3& cells, int ranks, const Index3& least = fewest);

  // Decomposition with the same layout whose cuts share weights as evenly as whole cells allow: weights[a][k] >= 0 of
  // the cells with coordinate k along axis a. No rank gets fewer cells than it needs along an axis that is cut.
  Decomposition balanced(const std::array<std::vector<std::int64_t>, 3>& weights) const;
  bool operator==(const Decomposition& other) const = default;

  const Index3& cells() const { return cells_; }
  double spacing() const { return spacing_; }
  const std::array<bool, 3>& periodic() const { return periodic_; }
  const Index3& layout() const { return layout_; }
  int ranks() const { return layout_[0] * layout_[1] * layout_[2]; }
  PeriodicBox box() const;       // in metres
  PeriodicBox cell_box() const;  // in cells

  Index3 coordinates_of(int rank) const;         // position of a rank in the layout
  int rank_at(const Index3& coordinates) const;  // -1 beyond a non-periodic face; wraps on periodic axes
  Block block_of(int rank) const;

  // The rank whose block holds a position (m). Positions outside the box on a non-periodic axis belong to the nearest
  // block; on a periodic axis they must have been wrapped.
  int owner_of(const Vec3& position) const;

  // True if the closed box of a rank, widened by `distance` (m) on every side, holds the position or a periodic image;
  // at a wall the outermost blocks extend without end.
  bool reaches(int rank, const Vec3& position, double distance) const;

  // All ranks that reach the position, the owner among them, in ascending order.
  std::vector<int> ranks_reached(const Vec3& position, double distance) const;

private:
  bool slab_reaches(int axis, int slab, double coordinate, double distance) const;

  Index3 cells_;
  double spacing_;
  std::array<bool, 3> periodic_;
  Index3 layout_, least_;
  std::array<std::vector<int>, 3> cuts_;  // first cell of each slab, and one past the last
};

}  // namespace thalweg
