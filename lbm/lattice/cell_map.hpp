// Map of the cells: fluid or covered by a body, beside bodies, in gaps, and the number of fluid cells in each pack of a
// row.
#pragma once

#include "core/base/check.hpp"
#include "lbm/lattice/populations.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace thalweg::lbm {

// Positions of walls in local coordinates: cells below `lower` and from `upper` on are behind one. No walls by default.
struct WallPositions {
  Index3 lower{none_below, none_below, none_below}, upper{none_above, none_above, none_above};
  static constexpr int none_below = std::numeric_limits<int>::min() / 2;
  static constexpr int none_above = std::numeric_limits<int>::max() / 2;
};

class CellMap {
public:
  static constexpr std::int32_t fluid = -1;  // any other value: the id of the covering body

  // Entries of bodies() that can be read beyond the last cell, by vectors that begin at a cell.
  static constexpr std::size_t read_beyond = 16;

  explicit CellMap(const CellIndexing& indexing, const WallPositions& walls = {})
      : indexing_(indexing),
        walls_(walls),
        body_(indexing.count() + read_beyond, fluid),
        fluid_in_pack_(static_cast<std::size_t>(indexing.packs_per_row()) * indexing.size()[1] * indexing.size()[2]),
        beside_bodies_(fluid_in_pack_.size()),
        in_gaps_(fluid_in_pack_.size()) {
    CHECK(indexing.pack() <= 16);  // a bit for each cell in the masks of packs
    const int width = indexing.pack(), nx = indexing.size()[0];
    for (std::size_t p = 0; p < fluid_in_pack_.size(); ++p) {
      const int first = static_cast<int>(p) % indexing.packs_per_row() * width;
      fluid_in_pack_[p] = static_cast<std::uint8_t>(nx - first < width ? nx - first : width);
    }
  }

  const CellIndexing& indexing() const { return indexing_; }
  bool is_fluid(std::ptrdiff_t cell) const { return body_[cell] == fluid; }
  std::int32_t body(std::ptrdiff_t cell) const { return body_[cell]; }
  const std::int32_t* bodies() const { return body_.data(); }
  // True if a cell, in memory or not, is beyond a wall.
  bool is_beyond_wall(const Index3& cell) const {
    for (int a = 0; a < 3; ++a)
      if (cell[a] < walls_.lower[a] || cell[a] >= walls_.upper[a]) return true;
    return false;
  }

  // Gives a cell (local coordinates; owned or ghost) to a body, or back to the fluid.
  void assign(int x, int y, int z, std::int32_t body) {
    CHECK(indexing_.in_memory({x, y, z}));
    std::int32_t& now = body_[indexing_.index(x, y, z)];
    const bool changes = (now == fluid) != (body == fluid);
    now = body;
    if (!changes) return;
    if (indexing_.owned(x, y, z)) {
      std::uint8_t& count = fluid_in_pack_[pack_of(x, y, z)];
      count = static_cast<std::uint8_t>(count + (body == fluid ? 1 : -1));
    }
    for (int i = 1; i < D3Q19::directions; ++i)
      update_neighbourhood({x + D3Q19::c[i][0], y + D3Q19::c[i][1], z + D3Q19::c[i][2]});
  }

  // Number of fluid cells in each pack of an owned row.
  const std::uint8_t* fluid_in_packs(int y, int z) const { return fluid_in_pack_.data() + pack_of(0, y, z); }
  // Bits of the cells in each pack of an owned row: 1 where one of the 18 neighbours is covered.
  const std::uint16_t* beside_bodies(int y, int z) const { return beside_bodies_.data() + pack_of(0, y, z); }

  // Bits likewise: 1 where a cell is in a gap: two neighbours that are opposite are covered, or one is and a wall is
  // within three cells on the other side. (Bodies are known from cell to cell, walls however far they are.)
  const std::uint16_t* in_gaps(int y, int z) const { return in_gaps_.data() + pack_of(0, y, z); }

  // The same bits of an owned cell.
  bool is_beside_bodies(const Index3& cell) const { return bit(beside_bodies_, cell); }
  bool is_in_gap(const Index3& cell) const { return bit(in_gaps_, cell); }

private:
  static constexpr int widest_gap_at_wall = 3;  // cells

  // True if a wall is at most this many steps of direction i away.
  bool meets_wall(const Index3& cell, int i, int steps) const {
    return is_beyond_wall(
        {cell[0] + steps * D3Q19::c[i][0], cell[1] + steps * D3Q19::c[i][1], cell[2] + steps * D3Q19::c[i][2]});
  }

  // Brings the bits of a cell up to date, if it is owned.
  void update_neighbourhood(const Index3& at) {
    if (!indexing_.owned(at[0], at[1], at[2])) return;
    const std::ptrdiff_t cell = indexing_.index(at[0], at[1], at[2]);
    const auto covered = [&](int i) { return !is_fluid(cell + indexing_.offset(i)); };
    bool beside = false, gap = false;
    for (int i = 1; i < D3Q19::directions; ++i) {
      if (!covered(i)) continue;
      const int back = D3Q19::opposite(i);
      beside = true;
      gap = gap || covered(back) || meets_wall(at, back, widest_gap_at_wall);
    }
    set_bit(beside_bodies_, at, beside);
    set_bit(in_gaps_, at, gap);
  }

  void set_bit(std::vector<std::uint16_t>& packs, const Index3& at, bool on) {
    std::uint16_t& bits = packs[pack_of(at[0], at[1], at[2])];
    const auto bit = static_cast<std::uint16_t>(1u << at[0] % indexing_.pack());
    bits = static_cast<std::uint16_t>(on ? bits | bit : bits & ~bit);
  }

  bool bit(const std::vector<std::uint16_t>& packs, const Index3& at) const {
    return (packs[pack_of(at[0], at[1], at[2])] >> at[0] % indexing_.pack() & 1) != 0;
  }

  std::size_t pack_of(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * indexing_.size()[1] + y) * indexing_.packs_per_row() + x / indexing_.pack();
  }

  CellIndexing indexing_;
  WallPositions walls_;
  std::vector<std::int32_t> body_;
  std::vector<std::uint8_t> fluid_in_pack_;
  std::vector<std::uint16_t> beside_bodies_, in_gaps_;
};

}  // namespace thalweg::lbm
