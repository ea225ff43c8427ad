// Domain walls: fill, before a sweep, the populations that would have streamed in from beyond a wall.
//
// With o the direction that enters the fluid, o' its opposite, m its mirror image at the wall, t the tangential part of
// c_o, all populations post-collision, and r the fraction that bounces back (the rest reflects specularly):
//   f_o(x, t+1) = r(x) f_o'(x, t) + [1 - r(x - t)] f_m(x - t, t)
// r = 1 is no-slip, r = 0 free slip. Taking 1 - r at the source cell conserves mass. If the source cell is solid, or in
// an edge between two walls, the population bounces back whole.
//
// Law of the wall (Zhang et al. 2022, appendix A): u_slip = A u_tau with u_tau^2 = [(C_s dx)^2 g + nu] g, g the shear rate
// in the cell at the wall; for the wall half a cell beyond the cell centre this slip length means, exactly in Couette flow,
//   r = 3 u_tau / (3 u_tau + A)      (lattice units).
// A = 8.36 follows from the recipe of that paper: the tangent of u+ = ln(y+)/0.41 + 5 at y+ = 10.8, taken to the wall.
#pragma once

#include "core/archive.hpp"
#include "core/decomposition.hpp"
#include "lbm/boundary.hpp"
#include "lbm/cell_map.hpp"
#include "lbm/collision.hpp"
#include "lbm/populations.hpp"
#include "lbm/sweep.hpp"

#include <string>
#include <vector>

namespace thalweg::lbm {

// One value for every cell at a face, with a ring of ghosts. The axes (u, v) are the two others in ascending order.
template <typename Real>
struct FaceField {
  int nu = 0, nv = 0;
  std::vector<Real> values;

  void resize(int u, int v, Real value) {
    nu = u;
    nv = v;
    values.assign(static_cast<std::size_t>(u + 2) * (v + 2), value);
  }
  Real& at(int u, int v) { return values[static_cast<std::size_t>(v + 1) * (nu + 2) + (u + 1)]; }
  Real* row(int v) { return &at(0, v); }
};

template <typename Real>
class Walls {
public:
  Walls(const Decomposition& decomposition, int rank, const CellIndexing& indexing, const FaceConditions& faces,
        const CollisionParameters& parameters);

  // True if this rank's block has a wall at that face.
  bool present(int axis, bool high) const { return present_[face_of(axis, high)]; }

  // Fills the incoming populations of all cells at walls, owned and tangential to ghosts as needed. The halo must be up
  // to date.
  void apply(Populations<Real>& populations, const CellMap& cells) const;

  // True if the shear rates of a row are wanted after the sweep.
  bool wants_shear(int y, int z) const;
  // Takes the shear rates of a row, just swept, and updates the bounced fraction of the wall cells in it (solid cells have
  // no shear rate; theirs goes back to the start value).
  void take_shear(int y, int z, const RowShear<Real>& shear, const CellMap& cells);

  // Bounced fraction r at a law-of-the-wall face, for the halo exchange; empty elsewhere.
  FaceField<Real>& bounced(int face) { return bounced_[face]; }

  void save(ArchiveWriter& archive, const Decomposition& decomposition, const Block& block) const;
  void load(ArchiveReader& archive, const Decomposition& decomposition, const Block& block);

private:
  void apply_face(Populations<Real>& populations, const CellMap& cells, int face) const;
  void apply_direction(Populations<Real>& populations, const CellMap& cells, int face, int direction) const;
  void take_cell(int face, int x, int y, int z, double shear_rate, const CellMap& cells);

  CellIndexing indexing_;
  FaceConditions faces_;
  double viscosity_, eddy_coefficient_;   // nu and C_s^2, lattice units
  std::array<bool, 6> present_{};
  mutable std::array<FaceField<Real>, 6> bounced_;
};

}  // namespace thalweg::lbm
