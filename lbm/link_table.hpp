// Cut lattice links: where a body's surface crosses the line from a fluid cell to its solid neighbour.
//
// Links are streams of packed words, kept tile by tile (RowTiles, by the fluid cell) and, within a tile, body by body
// in memory order. The links of one body in one tile are a chunk; a body that moves rewrites its own chunks and nobody
// else's. The lattice knows bodies as rigid motions only, not their shapes.
#pragma once

#include "core/fixed_point.hpp"
#include "core/types.hpp"
#include "lbm/d3q19.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::lbm {

// A link as whoever finds it hands it over.
struct Link {
  std::uint32_t cell = 0;           // index of the fluid cell x_f (CellIndexing)
  int direction = 0;                // i, pointing into the body
  std::int32_t upstream_body = -1;  // the body that covers x_f - c_i; -1: it is no solid cell
  float distance = 0.0f;            // delta in [0, 1]: fraction of the link from x_f to the surface
  Vec3 arm = Vec3::Zero();          // where the link meets the surface, from the body's centre
};

// What a step needs of a link besides its cell, distance and arm, in one word.
struct LinkTag {
  static constexpr std::uint32_t direction_mask = 31;  // i
  static constexpr std::uint32_t near = 32;            // distance < 1/2
  static constexpr std::uint32_t slot_mask = 63;       // both
  static constexpr int covered_shift = 12;             // 1: near, and a body covers x_f - c_i
  static constexpr int body_shift = 13;                // that body
  static constexpr std::int32_t bodies = 1 << (32 - body_shift);
  // c_i + 1 of an axis, so that vector code needs no table.
  static constexpr int velocity_shift(int axis) { return 6 + 2 * axis; }

  static constexpr std::uint32_t of(int direction, bool near_half, std::int32_t upstream_body) {
    std::uint32_t tag = static_cast<std::uint32_t>(direction);
    if (near_half) tag |= near;
    if (near_half && upstream_body >= 0)
      tag |= 1u << covered_shift | static_cast<std::uint32_t>(upstream_body) << body_shift;
    for (int a = 0; a < 3; ++a) tag |= static_cast<std::uint32_t>(D3Q19::c[direction][a] + 1) << velocity_shift(a);
    return tag;
  }
};

// Links side by side, one array a word.
struct LinkStream {
  std::vector<std::uint32_t> cell, tag;
  std::vector<float> distance, arm[3];

  std::size_t size() const { return cell.size(); }
  void resize(std::size_t links);
  void put(std::size_t at, const Link& link);
  void append(const LinkStream& other, std::size_t first, std::size_t count);
  // Asks the memory for these links. To the compiler this does nothing, so it must not look inside from the caller.
  [[gnu::noipa]] void ask_for(std::size_t first, std::size_t count) const;
};

// A rigid body as the links see it; lattice units, global coordinates (cell centres at integer + 1/2).
struct LinkBody {
  Vec3 centre = Vec3::Zero();  // where its links were built for
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
  FixedVec3 force, torque;  // sums over this rank's links in the present step
};

class LinkTable {
public:
  // Every stream is longer than its links by this much, for vector code to run over the end.
  static constexpr std::size_t slack = 16;

  struct Chunk {
    std::int32_t body = -1;  // slot of the body; -1: the chunk is free
    std::uint32_t first = 0, count = 0, capacity = 0;
  };
  struct Tile {
    LinkStream links;
    std::vector<Chunk> chunks;
    std::vector<std::uint32_t> free_chunks;
    std::vector<std::uint32_t> order;  // of the chunks in use, by their first cell; see chunks_in_order()
    bool in_order = true;
    std::size_t live = 0, end = 0;  // links in use; first entry of the stream that no chunk has
  };

  explicit LinkTable(int tiles) : tiles_(tiles) {}

  const std::vector<Tile>& tiles() const { return tiles_; }

  // The chunks of a tile in memory order of the cells, so that neighbouring grains share what they load.
  const std::vector<std::uint32_t>& chunks_in_order(int tile) const;
  std::size_t count() const;  // all links

  // Replaces all links of a body. Throws InputError if there are more bodies than a tag can tell. links: sorted by
  // tile; tile_of[k] the tile of links[k].
  void replace(int body, std::span<const Link> links, std::span<const int> tile_of);
  void remove(int body) { replace(body, {}, {}); }
  // Asks the memory for a body's links, which are about to be replaced.
  [[gnu::noipa]] void ask_for(int body) const;

private:
  struct Place {
    int tile;
    std::uint32_t chunk;
  };
  void put(Tile& tile, Chunk& chunk, std::span<const Link> links);
  void compact(Tile& tile);

  mutable std::vector<Tile> tiles_;         // their order is made when it is asked for
  std::vector<std::vector<Place>> places_;  // of each body
};

}  // namespace thalweg::lbm
