// Which cells are fluid and which are covered by a body, which packs of a row hold any fluid at all, and which cells
// have a body beside them.
#pragma once

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
        covered_beside_(indexing.count()),
        fluid_in_pack_(static_cast<std::size_t>(indexing.packs_per_row()) * indexing.size()[1] * indexing.size()[2]),
        beside_bodies_(fluid_in_pack_.size()) {
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
    tell_neighbours(x, y, z, body == fluid ? -1 : 1);
  }

  // Number of fluid cells in each pack of an owned row.
  const std::uint8_t* fluid_in_packs(int y, int z) const { return fluid_in_pack_.data() + pack_of(0, y, z); }
  // For each pack of an owned row a bit for each cell, 1 where one of its 18 neighbours is covered.
  const std::uint16_t* beside_bodies(int y, int z) const { return beside_bodies_.data() + pack_of(0, y, z); }

private:
  // A cell has become covered (1) or fluid (-1).
  void tell_neighbours(int x, int y, int z, int change) {
    for (int i = 1; i < D3Q19::directions; ++i) {
      const int nx = x + D3Q19::c[i][0], ny = y + D3Q19::c[i][1], nz = z + D3Q19::c[i][2];
      if (!indexing_.owned(nx, ny, nz)) continue;
      std::uint8_t& count = covered_beside_[static_cast<std::size_t>(indexing_.index(nx, ny, nz))];
      count = static_cast<std::uint8_t>(count + change);
      const auto bit = static_cast<std::uint16_t>(1u << nx % indexing_.pack());
      std::uint16_t& pack = beside_bodies_[pack_of(nx, ny, nz)];
      pack = static_cast<std::uint16_t>(count > 0 ? pack | bit : pack & ~bit);
    }
  }

  std::size_t pack_of(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * indexing_.size()[1] + y) * indexing_.packs_per_row() + x / indexing_.pack();
  }

  CellIndexing indexing_;
  std::vector<std::int32_t> body_;
  std::vector<std::uint8_t> covered_beside_;  // of the 18 neighbours of an owned cell, those that are covered
  std::vector<std::uint8_t> fluid_in_pack_;
  std::vector<std::uint16_t> beside_bodies_;
};

}  // namespace thalweg::lbm
