// Links without a fluid cell: where another grain or a wall of the box hides a patch of a grain's surface from the
// fluid.
//
// A lattice line enters a cell of grain p from a cell x_f that grain q covers, or that is beyond a wall. No population
// runs there, but a fluid between the two would press. The exchange counts populations less their weight
// (link_pass.hpp), so that the reference pressure needs no such links. What is left:
//   full gravity        the hydrostatic density above the reference, rho_g - 1 on the surface: momentum
//                       2 w_i (rho_g - 1) c_i, without which a grain that touches others or the floor would lose part
//                       of its buoyancy;
//   near_contact paper  a link with equilibrium populations at x_f and x_ff, of density rho_g and with q's rigid motion
//                       there (Zhang et al. 2022), between grains only.
// There is no surface between members of one clump, and so no such link. Both use the rule of Bouzidi and the momentum
// exchange chosen. Lattice units.
#pragma once

#include "core/decomposition.hpp"
#include "core/shape.hpp"
#include "coupling/cell_claims.hpp"
#include "coupling/hydrostatic.hpp"
#include "coupling/lattice_vectors.hpp"
#include "coupling/local_cells.hpp"
#include "lbm/link_pass.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace thalweg::coupling {

struct HiddenLinkOptions {
  bool moving = false;  // near_contact paper
  Hydrostatic rest;
};

class HiddenLinks {
public:
  HiddenLinks(const Decomposition& decomposition, const Block& block, const lbm::CellMap& cells,
              const HiddenLinkOptions& options, lbm::MomentumExchange exchange);

  bool wanted() const { return options_.moving || !options_.rest.none(); }

  // Finds anew the hidden links around cells that changed hands since the last call; does nothing where none are wanted
  // them. A link belongs to the rank that owns its solid cell.
  void update(const CellClaims& map);

  // Adds the momentum of all hidden links to their bodies, and sum F_a x_b to moments, where given. shapes: by slot.
  template <Shape S>
  void apply(std::span<const S> shapes, std::vector<lbm::LinkBody>& bodies, std::vector<FixedTensor>* moments) const;

  std::size_t count() const;

private:
  struct Link {
    int direction;       // into the grain
    std::int32_t other;  // slot of the grain that covers x_f; CellMap::fluid: a wall
    Vec3 from;           // x_f, global
  };

  void mark(std::int32_t slot);
  void mark_around(const Index3& local);
  void rebuild(int slot, const std::vector<MappedGrain>& grains);
  void find_at_cell(int slot, const Index3& local, const std::vector<MappedGrain>& grains);
  Vec3 momentum_of(const Link& link, const Vec3& from, double distance, const lbm::LinkBody& body,
                   const std::vector<lbm::LinkBody>& bodies) const;
  // from: x_f from the body's centre.
  void add(const Link& link, const Vec3& from, double distance, std::size_t slot, std::vector<lbm::LinkBody>& bodies,
           std::vector<FixedTensor>* moments) const;

  const Decomposition& decomposition_;
  Block block_;
  LocalCells local_cells_;
  const lbm::CellMap& cells_;
  HiddenLinkOptions options_;
  bool galilean_;
  PeriodicBox box_;                       // cells
  std::vector<std::vector<Link>> links_;  // by slot
  std::vector<int> stale_;                // slots to look at anew
  std::vector<char> is_stale_;            // by slot
  std::vector<LocalCell> places_[3];      // scratch
};

// Where grains overlap, x_f can be inside this one, too. A line that just misses the surface, because the cells are
// those of a place a little apart, meets it where it is nearest to the centre.
template <Shape S>
void HiddenLinks::apply(std::span<const S> shapes, std::vector<lbm::LinkBody>& bodies,
                        std::vector<FixedTensor>* moments) const {
  for (std::size_t slot = 0; slot < links_.size(); ++slot)
    for (const Link& link : links_[slot]) {
      const Vec3 c = velocity_of(link.direction), from = box_.difference(link.from, bodies[slot].centre);
      double met = 0.0;
      if (!is_inside(shapes[slot], from)) met = shapes[slot].crossing(from, c).value_or(-c.dot(from) / c.squaredNorm());
      add(link, from, std::clamp(met, 0.0, 1.0), slot, bodies, moments);
    }
}

}  // namespace thalweg::coupling
