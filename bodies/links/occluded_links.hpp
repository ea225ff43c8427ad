// Links without a fluid cell, where another grain, a solid or a wall of the box occludes a patch of a grain's surface.
//
// A lattice line enters a cell of grain p from a cell x_f that grain or solid q covers, or that is beyond a wall. No
// population runs there, but a fluid between the two would press. The exchange counts populations less their weight
// (interpolated_bounce_back.hpp), so that the reference pressure needs no such links. What is left under full gravity
// is the hydrostatic density above the reference, rho_g - 1 on the surface: momentum 2 w_i (rho_g - 1) c_i, without
// which a grain that touches others or the floor would lose part of its buoyancy. A solid or a wall gets the opposite.
// There is no surface between members of one clump, and so no such link. Lattice units.
#pragma once

#include "bodies/map/body_map.hpp"
#include "bodies/map/hydrostatic.hpp"
#include "bodies/map/lattice_vectors.hpp"
#include "bodies/map/link_table.hpp"
#include "bodies/map/local_cells.hpp"
#include "core/geometry/sphere.hpp"
#include "core/parallel/decomposition.hpp"
#include "lbm/lattice/cell_map.hpp"

#include <array>
#include <vector>

namespace thalweg::bodies {

class OccludedLinks {
public:
  OccludedLinks(const Decomposition& decomposition, const Block& block, const lbm::CellMap& cells,
                const Hydrostatic& rest);

  // Finds anew the hidden links around cells that changed hands since the last call; does nothing where the density at
  // rest is the same everywhere. A link belongs to the rank that owns its solid cell.
  void update(const BodyMap& map);

  // Adds the momentum of all hidden links to their grains, its opposite to the solids they come from, the first of the
  // bodies, and sum F_a x_b of the grains to moments, where given.
  void apply(int solids, std::vector<LinkBody>& bodies, std::vector<FixedTensor>* moments) const;

  // The opposite of the momentum of the hidden links that come from beyond a wall, by face (0 .. 5).
  std::array<FixedVec3, 6> wall_forces(const std::vector<LinkBody>& bodies) const;

  std::size_t count() const;

private:
  struct Link {
    int direction;      // into the grain
    Vec3 from;          // x_f, global
    std::int32_t body;  // slot of what covers x_f; CellMap::fluid beyond a wall
  };

  void mark(std::int32_t slot);
  void mark_around(const Index3& local);
  void rebuild(int slot, const std::vector<MappedBody>& grains);
  void find_at_cell(int slot, const Index3& local, const std::vector<MappedBody>& grains);
  // What a link gives to its body, and where, from the centre.
  struct Momentum {
    Vec3 value, arm;
  };
  Momentum momentum_of(const Link& link, const LinkBody& body) const;
  int face_before(const Link& link) const;  // the wall that a link comes from; -1: it comes from another body

  const Decomposition& decomposition_;
  Block block_;
  LocalCells local_cells_;
  const lbm::CellMap& cells_;
  Hydrostatic rest_;
  PeriodicBox box_;                        // cells
  std::vector<std::vector<Link>> links_;   // by slot
  std::vector<int> stale_;                 // slots to look at anew
  std::vector<char> is_stale_;             // by slot
  std::vector<LocalCell> cells_along_[3];  // scratch
};

}  // namespace thalweg::bodies
