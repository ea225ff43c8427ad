// Cut lattice links: where a body's surface crosses the line from a fluid cell to its solid neighbour.
//
// A link is two words, xy and tag, which name the cells it joins. Its crossing with the surface is computed from the
// body's radius and present centre when the link is applied (link_crossings.hpp), or stored beside it (solids of any
// shape). So a link changes only when a cell changes hands, however its body moves. Links are kept tile by tile
// (lbm::RowTiles, by the fluid cell) and, within a tile, body by body in memory order: the links of one body in one
// tile are a chunk. The lattice knows bodies as rigid motions, and nothing of grains.
#pragma once

#include "core/base/types.hpp"
#include "core/sums/fixed_point.hpp"
#include "lbm/lattice/cell_map.hpp"
#include "lbm/lattice/d3q19.hpp"

#include <array>
#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::bodies {

// The fluid cell x_f of a link in its plane: owned local coordinates x and y.
struct LinkXY {
  static constexpr int y_shift = 16;
  static constexpr std::uint32_t x_mask = 0xffff;
  static constexpr int largest = 0xffff;

  static constexpr std::uint32_t of(int x, int y) {
    return static_cast<std::uint32_t>(x) | static_cast<std::uint32_t>(y) << y_shift;
  }
};

// The rest of it in one word.
struct LinkTag {
  static constexpr std::uint32_t direction_mask = 31;  // i, from the fluid cell into the body
  static constexpr std::uint32_t enclosed = 32;        // flag: x_f is one of EnclosedCells
  static constexpr int narrow_shift = 12;              // 1: narrow, a body covers x_f - c_i
  static constexpr int body_shift = 13;                // the body that covers x_f - c_i
  // Number of bodies that a tag can distinguish.
  static constexpr std::int32_t bodies = 1 << (32 - body_shift);
  // c_i + 1 of an axis, so that vector code needs no table.
  static constexpr int velocity_shift(int axis) { return 6 + 2 * axis; }
  // c_i of an axis: of one tag or of a pack of them.
  template <typename Tag>
  [[gnu::always_inline]] static constexpr Tag velocity(const Tag& tag, int axis) {
    return (tag >> velocity_shift(axis) & 3) - 1;
  }

  static constexpr bool is_narrow(std::uint32_t tag) { return (tag >> narrow_shift & 1u) != 0; }
  static constexpr std::uint32_t upstream_body(std::uint32_t tag) { return tag >> body_shift; }  // of a narrow link

  // upstream_body: which covers x_f - c_i; -1: none.
  static constexpr std::uint32_t of(int direction, std::int32_t upstream_body, bool is_enclosed = false) {
    std::uint32_t tag = static_cast<std::uint32_t>(direction);
    if (is_enclosed) tag |= enclosed;
    if (upstream_body >= 0) tag |= 1u << narrow_shift | static_cast<std::uint32_t>(upstream_body) << body_shift;
    for (int a = 0; a < 3; ++a) tag |= static_cast<std::uint32_t>(lbm::D3Q19::c[direction][a] + 1) << velocity_shift(a);
    return tag;
  }
};

// Links that vector code takes at a time: whole vectors on any machine. A chunk is filled up to a multiple of this with
// copies of its last link, which compute and write what that link does, and count nowhere.
inline constexpr int links_at_a_time = 16;
template <std::integral Count>
constexpr Count padded(Count links) {
  return static_cast<Count>((links + links_at_a_time - 1) / links_at_a_time * links_at_a_time);
}

struct Link {
  std::uint32_t xy = 0, tag = 0;
};

// Crossing of a link with a surface that has no formula.
struct LinkCrossing {
  float distance = 0.0f;  // delta in [0, 1]: fraction of the link from x_f to the surface
  float arm[3] = {};      // the crossing from the body's centre, cells
};

// Links side by side, one array a word; crossings are empty until a body stores them.
struct LinkStream {
  std::vector<std::uint32_t> xy, tag;
  std::vector<LinkCrossing> crossing;

  void resize(std::size_t size);
  void fill_up(std::size_t end, std::size_t copies);  // copies the last link before `end`, from there on

  // Prefetches these links. Not inlined, because the compiler would drop it as having no effect.
  [[gnu::noinline]] void prefetch(std::size_t first, std::size_t count) const;
};

// A rigid body as the links see it; lattice units, global coordinates (cell centres at integer + 1/2).
struct LinkBody {
  double radius = 0.0;  // of a sphere; 0: a solid of any shape, whose links store their crossings
  Vec3 centre = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();

  // Mass returned per link, w_i (returned + returned_slope.c_i), added to the populations that come back to replace
  // what the fluid lost at this body.
  double returned = 0.0;
  Vec3 returned_slope = Vec3::Zero();

  // Sums over this rank's links in the present step.
  FixedVec3 force, torque;
  bool turns = true;          // false: the torque is not needed and not summed
  bool is_obstacle = false;   // of BodyOptions
  std::int64_t mass = 0;      // LatticeFixed: given to the fluid, sum f_i' - f_i^c and what the caller adds
  std::int64_t pressure = 0;  // LatticeFixed: sum w_i (rho - rho_rest)(x_f), rho_rest that of the fluid at rest

  // Call it at the beginning of every step: sums over many steps leave their range (core/sums/sum_range.hpp).
  void clear_sums() {
    force = torque = {};
    mass = pressure = 0;
  }
};

// Sums over a body's links that do not depend on the flow: integers, in 36ths, so that they can be updated exactly.
struct LinkSums {
  static constexpr int size = 10;
  std::array<std::int64_t, size> sums{};  // w_i;  w_i c_i: x, y, z;  w_i c_ia c_ib: xx, yy, zz, xy, xz, yz

  // Sums over links[i] links of each direction i.
  static LinkSums of(const std::array<int, lbm::D3Q19::directions>& links);
  LinkSums& operator+=(const LinkSums& other);
  LinkSums& operator-=(const LinkSums& other);

  double weight() const { return static_cast<double>(sums[0]) / 36.0; }
  Vec3 normal() const {
    return Vec3(static_cast<double>(sums[1]), static_cast<double>(sums[2]), static_cast<double>(sums[3])) / 36.0;
  }
  Mat3 second() const;
};

class LinkTable {
public:
  struct Chunk {
    std::int32_t body = -1;                            // slot of the body; -1: the chunk is free
    std::uint32_t first = 0, count = 0, capacity = 0;  // capacity: with room for the copies
    std::uint32_t narrow = 0;                          // as many links at the front have a body at x_f - c_i
    LinkSums sums;
  };
  // A chunk as the pass over the links reads it; padded(count) links are present.
  struct LinkRange {
    std::int32_t body;
    std::uint32_t first, count, narrow;
  };
  struct Tile {
    LinkStream links;
    std::vector<Chunk> chunks;
    std::vector<std::uint32_t> free_chunks;
    std::vector<std::uint32_t> order;  // of the chunks in use, by their first cell
    std::vector<LinkRange> ranges;     // the same chunks; see ranges_in_order()
    bool in_order = true, ranges_current = true;
    std::size_t live = 0, filled = 0;  // links in use; the same with their copies
    std::size_t end = 0;               // first entry of the stream that no chunk has
  };

  explicit LinkTable(int tiles) : tiles_(tiles) {}

  const std::vector<Tile>& tiles() const { return tiles_; }

  // The chunks of a tile in memory order of the cells, so that neighbouring grains share what they load.
  const std::vector<LinkRange>& ranges_in_order(int tile) const;
  std::size_t count() const;                // all links
  const LinkSums& sums_of(int body) const;  // over its links in all tiles; zero for a body without links

  // Replaces the links of a body in a tile; crossings: one a link of a body that stores them, else empty. Bodies
  // are below LinkTag::bodies.
  void replace(int body, int tile, std::span<const Link> links, std::span<const LinkCrossing> crossings = {});
  // Drops the links of a body in all tiles.
  void remove(int body);

private:
  struct TileChunk {
    int tile;
    std::uint32_t chunk;
  };
  std::uint32_t new_chunk(Tile& tile, int body);
  void drop_chunk(Tile& tile, std::uint32_t chunk);
  void put(Tile& tile, Chunk& chunk, std::span<const Link> links, std::span<const LinkCrossing> crossings);
  static void compact(Tile& tile);

  mutable std::vector<Tile> tiles_;                // sorted on demand
  std::vector<std::vector<TileChunk>> chunks_of_;  // of each body
  std::vector<LinkSums> sums_;                     // of each body
};

}  // namespace thalweg::bodies
