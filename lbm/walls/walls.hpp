// Domain walls: fill, before a sweep, the populations that would have streamed in from beyond a wall.
//
// With o the direction that enters the fluid, o' its opposite, m its mirror image at the wall, t the tangential part of
// c_o, f^c post-collision populations, and r the fraction that bounces back (the rest reflects specularly):
//   walls              f_o(x, t+1) = r(x) f_o'^c(x, t) + [1 - r(x - t)] f_m^c(x - t, t)
//                      r = 1: no slip, r = 0: free slip. Taking 1 - r at the source cell conserves mass.
//   law of the wall    f_o(x, t+1) = f_m^c(x - t, t) - (t.T)(x)/2,   T the stress of wall_stress.hpp, mean of two steps
//                      The two populations along an axis take just T out of the cell, and no mass, whatever collision
//                      and subgrid model make of the flow.
//   moving, inlet      f_o(x, t+1) = f_o'^c(x, t) + 6 w_o rho(x, t) c_o.U                               (Ladd 1994)
//   recycling inlet    recycled_inflow.hpp, in edges too
//   outlet             f_o(x, t+1) = f_o^eq(rho_w, u),   u of the cell, rho_w of outlet_density.hpp
//                      What enters has no part out of equilibrium: at small viscosities a rule that keeps or reverses
//                      that part (anti-bounce-back, extrapolation) amplifies it, and breaks down as eddies leave.
//                      Fluid that enters, on the whole or in an eddy, does so along the normal with the speed w of
//                      outlet_density.hpp, u = w n, and at rho_w - 3 w^2/2, the pressure at which it was at rest. With
//                      the velocity of the cell it would feed on itself.
//
// Slip length s and bounced fraction, exact in Couette flow for tau - 1/2 = 3 nu and nu with the eddies' share in
// shear, g being the shear rate in the cell at the wall (Zhang et al. 2022, appendix A, A2):
//   r = 1/[1 + s/(tau - 1/2)].
// Slip law of the wall (the same, A3 to A5): slip velocity A u_tau with u_tau^2 = nu g, hence s = A nu/u_tau and
//   r = 3 u_tau/(3 u_tau + A).
//
// Next to a body: a population whose source cell is solid bounces back whole. A population that comes out of the edge
// between two faces belongs to the face that comes first in: walls with friction, inlet, outlet, free slip. It bounces
// back whole, plus the terms of both faces that have a velocity; at an outlet it obeys the outlet's rule, between two
// outlets the mean of both. Two free-slip faces reflect both components, which is the same. Populations with three
// components do not exist, so corners need no rule.
#pragma once

#include "core/base/archive.hpp"
#include "core/parallel/decomposition.hpp"
#include "core/sums/fixed_point.hpp"
#include "lbm/collision/collision.hpp"
#include "lbm/collision/sweep.hpp"
#include "lbm/lattice/cell_map.hpp"
#include "lbm/lattice/populations.hpp"
#include "lbm/walls/boundary.hpp"
#include "lbm/walls/outlet_density.hpp"
#include "lbm/walls/recycled_inflow.hpp"
#include "lbm/walls/wall_stress.hpp"

#include <mpi.h>

#include <optional>
#include <string>
#include <vector>

namespace thalweg::lbm {

// Field with one value for every cell at a face and a ring of ghosts. The axes (u, v) are the two others in ascending
// order.
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
  // Throws InputError where a moving wall would move out of its plane, a slip length is negative, a slip coefficient is
  // not positive, or a block at a law of the wall does not hold all cells that the law looks at.
  Walls(const Decomposition& decomposition, int rank, const CellIndexing& indexing, const FaceConditions& faces,
        const CollisionParameters& parameters);

  // True if this rank's block has a wall at that face.
  bool present(int axis, bool high) const { return present_[face_of(axis, high)]; }

  // Number of cells next to a face that apply() reads.
  int depth() const;

  bool recycles() const;  // true if there is an inlet that recycles, on whatever rank

  // Fills the incoming populations of all owned cells at walls. The halo, which it reads, must be up to date, and no
  // row swept where an inlet recycles. Applied again before the next sweep, it fills in the same. Collective where
  // recycles().
  void apply(Populations<Real>& populations, const CellMap& cells, MPI_Comm communicator);

  // The momentum that each face takes from this rank's fluid in the next step, once apply() is done. Populations count
  // as f - w (1 + reference), so that a fluid at rest with rho = 1 + reference exerts no force. A population out of the
  // edge of two faces gives each the part of its momentum along the normal.
  // sides_by_height: where given, 2 n_z + 1 sums for the n_z planes of this rank, to which what the faces across x and
  // y take is added at the height half a link from its cell: entry h lies h half cells above the block's lower face.
  std::array<FixedVec3, 6> forces(const Populations<Real>& populations, const CellMap& cells, double reference,
                                  std::vector<FixedVec3>* sides_by_height = nullptr) const;

  // True if the shear rates of a row are wanted after the sweep.
  bool wants_shear(int y, int z) const;
  // Updates the bounced fraction of the wall cells in a row, just swept, from its shear rates (solid cells have none;
  // theirs goes back to the start value).
  void update_bounced(int y, int z, const RowShear<Real>& shear, const CellMap& cells);

  // True if the moments of a row are wanted after the sweep.
  bool wants_moments(int y, int z) const;
  // Takes the velocities at faces with a law of the wall from a row, just swept. half_force: of that collision.
  void take_moments(int y, int z, const RowMoments<Real>& moments, const CellMap& cells, const Vec3& half_force);
  // All rows have been swept.
  void end_sweep();
  // Populations have been set otherwise: the next apply() takes these velocities from them.
  void forget_sweep() { swept_ = false; }

  bool has_outlet() const;  // of the box, on whatever rank
  // Takes the mean momentum at each outlet from the populations that a step has left. Collective where has_outlet().
  void update_outlets(const Populations<Real>& populations, const CellMap& cells, MPI_Comm communicator);

  // The force density of the last collision, half of which post-collision populations carry beyond rho u.
  void set_carried_force(const Vec3& force) { half_force_ = 0.5 * force; }

  // Bounced fraction r at a face that slips, for the halo exchange; empty elsewhere.
  FaceField<Real>& bounced(int face) { return bounced_.at(static_cast<std::size_t>(face)); }

  void save(ArchiveWriter& archive, const Decomposition& decomposition, const Block& block) const;
  void load(ArchiveReader& archive, const Decomposition& decomposition, const Block& block);

private:
  // Cells begin to end of a row along a face, for one direction that enters there: its first cell, and the distances in
  // memory between its cells, and from each to the cell that its mirrored population comes from.
  struct RowPart {
    int face, direction, v, begin, end;
    std::ptrdiff_t first, stride, tangential;
  };

  // A direction that enters from a face: its components along the two axes of the face, and their numbers of cells.
  struct IncomingDirection {
    IncomingDirection(const CellIndexing& indexing, int from_face, int along);
    int face, direction;
    int axis, u_axis, v_axis, nu, nv, cu, cv;
    std::ptrdiff_t stride, tangential;  // of u in memory, and of the part of the direction along the face
  };

  void apply_face(Populations<Real>& populations, const CellMap& cells, int face);
  void apply_row(Populations<Real>& populations, const CellMap& cells, const IncomingDirection& incoming, int v) const;
  void reflect_row(Populations<Real>& populations, const CellMap& cells, const RowPart& part,
                   Reflection reflection) const;
  void update_bounced_cell(int face, int x, int y, int z, double shear_rate, const CellMap& cells);
  bool decides_edge(int face, int other) const;
  int edge_face(const IncomingDirection& incoming, int u, int v) const;
  Real from_edge(const Populations<Real>& populations, const IncomingDirection& incoming, std::ptrdiff_t cell,
                 int other) const;
  Real from_wall(const Populations<Real>& populations, const IncomingDirection& incoming, std::ptrdiff_t cell) const;
  int other_axis_of_edge(int face, int direction, const Index3& at) const;
  bool has_stress(int face) const { return faces_[face].type == FaceType::law_of_the_wall; }
  bool follows_shear(int face) const;
  double bounced_fraction(int face, double shear_rate) const;
  Real with_velocity(const Populations<Real>& populations, int direction, std::ptrdiff_t cell,
                     const Vec3& velocity) const;
  Real at_outlet(const Populations<Real>& populations, const IncomingDirection& incoming, std::ptrdiff_t cell) const;

  CellIndexing indexing_;
  FaceConditions faces_;
  double viscosity_;  // nu, lattice units
  Subgrid subgrid_;
  Vec3 half_force_ = Vec3::Zero();  // of the last collision
  std::array<bool, 6> present_{};
  mutable std::array<FaceField<Real>, 6> bounced_;
  std::array<std::optional<WallStress<Real>>, 6> stress_;        // at faces that obey the law of the wall
  std::array<std::optional<OutletDensity>, 6> outlets_;          // on all ranks
  std::array<std::optional<RecycledInflow<Real>>, 6> recycled_;  // on all ranks
  bool swept_ = false;
};

}  // namespace thalweg::lbm
