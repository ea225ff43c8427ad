// Cut lattice links: where a body's surface crosses the line from a fluid cell to its solid neighbour.
//
// Links are a stream of 16-byte records, kept plane by plane (z of the fluid cell) and, within a plane, body by body in
// memory order. The links of one body in one plane are a chunk; a body that moves rewrites its own chunks and nobody
// else's. The lattice knows bodies as rigid motions only, not their shapes.
#pragma once

#include "core/fixed_point.hpp"
#include "core/types.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::lbm {

struct Link {
  std::uint32_t cell;           // index of the fluid cell x_f (CellIndexing)
  std::int16_t offset[3];       // x_f minus the body's origin cell
  std::uint8_t direction;       // i, pointing into the body
  std::uint8_t upstream_solid;  // 1 if x_f - c_i is covered by a body
  float distance;               // delta in [0, 1]: fraction of the link from x_f to the surface
};
static_assert(sizeof(Link) == 16);

// A rigid body as the links see it; lattice units, global coordinates (cell centres at integer + 1/2).
struct LinkBody {
  Vec3 centre = Vec3::Zero();  // where its links were built for
  Index3 origin{0, 0, 0};      // cell the link offsets count from, near the centre, not wrapped
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
  FixedVec3 force, torque;  // sums over this rank's links in the present step
};

class LinkTable {
public:
  struct Chunk {
    std::int32_t body = -1;  // slot of the body; -1: the chunk is free
    std::uint32_t first = 0, count = 0, capacity = 0;
  };
  struct Plane {
    std::vector<Link> links;
    std::vector<Chunk> chunks;
    std::vector<std::uint32_t> free_chunks;
    std::vector<std::uint32_t> order;  // of the chunks in use, by their first cell; see chunks_in_order()
    bool in_order = true;
    std::size_t live = 0;  // links in use
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
