// Which cells are fluid and which are covered by a body, which packs of a row hold any fluid at all, and which cells
// have a body near them.
#pragma once

#include "lbm/near_bodies.hpp"
#include "lbm/populations.hpp"

#include <cstdint>
#include <vector>

namespace thalweg::lbm {

class CellMap {
public:
  static constexpr std::int32_t fluid = -1;  // any other value: the id of the covering body

  // Entries of bodies() that can be read beyond the last cell, by vectors that begin at a cell.
  static constexpr std::size_t read_beyond = 16;

  explicit CellMap(const CellIndexing& indexing)
      : indexing_(indexing),
        body_(indexing.count() + read_beyond, fluid),
        fluid_in_pack_(static_cast<std::size_t>(indexing.packs_per_row()) * indexing.size()[1] * indexing.size()[2]),
        near_bodies_(indexing) {
    const int width = indexing.pack(), nx = indexing.size()[0];
    for (std::size_t p = 0; p < fluid_in_pack_.size(); ++p) {
      const int first = static_cast<int>(p) % indexing.packs_per_row() * width;
      fluid_in_pack_[p] = static_cast<std::uint8_t>(nx - first < width ? nx - first : width);
    }
  }

  const CellIndexing& indexing() const { return indexing_; }
  bool is_fluid(std::ptrdiff_t cell) const { return body_[cell] == fluid; }
  std::int32_t body(std::ptrdiff_t cell) const { return body_[cell]; }
  // Whether a fluid cell, which must be owned, has no fluid beside it.
  bool is_enclosed(std::ptrdiff_t cell) const {
    for (int i = 1; i < D3Q19::directions; ++i)
      if (is_fluid(cell + indexing_.offset(i))) return false;
    return is_fluid(cell);
  }
  const std::int32_t* bodies() const { return body_.data(); }

  // Gives a cell (local coordinates; owned or ghost) to a body, or back to the fluid.
  void assign(int x, int y, int z, std::int32_t body) {
    std::int32_t& now = body_[indexing_.index(x, y, z)];
    const bool changes = (now == fluid) != (body == fluid);
    now = body;
    if (!changes) return;
    if (indexing_.owned(x, y, z)) {
      std::uint8_t& count = fluid_in_pack_[pack_of(x, y, z)];
      count = static_cast<std::uint8_t>(count + (body == fluid ? 1 : -1));
    }
    near_bodies_.cell_changes(x, y, z, body == fluid ? -1 : 1);
  }

  // A body claims a cell that is not in memory but no more than near_body_layers beyond the block, or gives it up: such
  // cells count for near_bodies() alone, whatever body has them. Each claim ends by being given up once.
  void claim_beyond(const Index3& cell) { near_bodies_.claims_change(cell[0], cell[1], cell[2], 1); }
  void give_up_beyond(const Index3& cell) { near_bodies_.claims_change(cell[0], cell[1], cell[2], -1); }

  // Number of fluid cells in each pack of an owned row.
  const std::uint8_t* fluid_in_packs(int y, int z) const { return fluid_in_pack_.data() + pack_of(0, y, z); }
  // For each pack of an owned row a bit for each cell, 1 where a covered cell is near (near_body_radius_squared).
  const std::uint16_t* near_bodies(int y, int z) const { return near_bodies_.in_packs(y, z); }
  // Whether any of the bits of a row is 1.
  bool any_near_bodies(int y, int z) const { return near_bodies_.any_in_row(y, z); }

private:
  std::size_t pack_of(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * indexing_.size()[1] + y) * indexing_.packs_per_row() + x / indexing_.pack();
  }

  CellIndexing indexing_;
  std::vector<std::int32_t> body_;
  std::vector<std::uint8_t> fluid_in_pack_;
  NearBodies near_bodies_;
};

}  // namespace thalweg::lbm
