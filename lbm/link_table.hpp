// Cut lattice links: where a body's surface crosses the line from a fluid cell to its solid neighbour.
//
// Links are streams of packed words, kept plane by plane (z of the fluid cell) and, within a plane, body by body in
// memory order. The links of one body in one plane are a chunk; a body that moves rewrites its own chunks and nobody
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
  std::uint32_t cell = 0;       // index of the fluid cell x_f (CellIndexing)
  int direction = 0;            // i, pointing into the body
  bool upstream_solid = false;  // x_f - c_i is covered by a body
  float distance = 0.0f;        // delta in [0, 1]: fraction of the link from x_f to the surface
  Vec3 arm = Vec3::Zero();      // where the link meets the surface, from the body's centre
};

// What a step needs of a link besides its cell, distance and arm, in one word.
struct LinkTag {
  static constexpr std::uint32_t direction_mask = 31;          // i
  static constexpr std::uint32_t near = 32;                    // distance < 1/2
  static constexpr std::uint32_t slot_mask = 63;               // both
  static constexpr std::uint32_t covered_upstream = 1u << 12;  // near, and x_f - c_i is covered by a body
  // c_i + 1 of an axis, so that vector code needs no table.
  static constexpr int velocity_shift(int axis) { return 6 + 2 * axis; }

  static constexpr std::uint32_t of(int direction, bool near_half, bool upstream_solid) {
    std::uint32_t tag = static_cast<std::uint32_t>(direction);
    if (near_half) tag |= near;
    if (near_half && upstream_solid) tag |= covered_upstream;
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
  struct Plane {
    LinkStream links;
    std::vector<Chunk> chunks;
    std::vector<std::uint32_t> free_chunks;
    std::vector<std::uint32_t> order;  // of the chunks in use, by their first cell; see chunks_in_order()
    bool in_order = true;
    std::size_t live = 0, end = 0;  // links in use; first entry of the stream that no chunk has
  };

  explicit LinkTable(int planes) : planes_(planes) {}

  const std::vector<Plane>& planes() const { return planes_; }

  // The chunks of a plane in memory order of the cells, so that neighbouring grains share what they load.
  const std::vector<std::uint32_t>& chunks_in_order(int plane) const;
  std::size_t count() const;  // all links

  // Replaces all links of a body. links: sorted by plane; plane_of[k] the plane of links[k].
  void replace(int body, std::span<const Link> links, std::span<const int> plane_of);
  void remove(int body) { replace(body, {}, {}); }

private:
  struct Place {
    int plane;
    std::uint32_t chunk;
  };
  void put(Plane& plane, Chunk& chunk, std::span<const Link> links);
  void compact(Plane& plane);

  mutable std::vector<Plane> planes_;       // their order is made when it is asked for
  std::vector<std::vector<Place>> places_;  // of each body
};

}  // namespace thalweg::lbm
