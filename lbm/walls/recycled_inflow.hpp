// Inflow that recycles: what enters at an inlet is the flow in a plane downstream, brought to the discharge asked for.
// So the flow enters with a profile and with turbulence that have developed in the box (Lund, Wu and Squires 1998,
// without their rescaling of a boundary layer that grows). Lattice units.
//
//   f_o(x, t+1) = f_o'^c(x, t) + s d_o + 6 w_o c_o.n (M - s M_d)/N
//   d_o = f_o(p, t+1) - f_o'^c(p, t)
//   s = M/M_d, at most 2, and 0 where M_d is not positive
//
// with the directions o that enter, their opposites o', a fluid cell x of the inlet and the cell p of the plane that
// lies downstream of it. d_o is 6 w_o rho c_o.U with the velocity U half-way to where f_o comes from: the term by which
// an inlet of known velocity differs from a wall, with the shear and with the walls beside it. It is zero where p or
// the cell that f_o comes from is in a body. M_d is the sum of d_o over the N fluid cells of the inlet and all o, the
// mass that they would bring, and M that of a fluid of rho = 1 with the speed asked for over all cells of the face, so
// that the discharge does not depend on what covers the inlet. The last term, along the normal n into the box, is zero
// once half the discharge flows through the plane; until then it starts the fluid from rest.
#pragma once

#include "core/parallel/decomposition.hpp"
#include "lbm/lattice/cell_map.hpp"
#include "lbm/lattice/populations.hpp"

#include <mpi.h>

#include <array>
#include <vector>

namespace thalweg::lbm {

template <typename Real>
class RecycledInflow {
public:
  // plane: coordinate of its cells along the normal of the face, in the whole box. speed: mean over the whole face,
  // into the box. Throws InputError for a plane outside the box.
  RecycledInflow(const Decomposition& decomposition, int rank, const CellIndexing& indexing, int face, int plane,
                 double speed);

  // Fills the populations that enter at the inlet, once those that enter the plane are there: after the halo exchange
  // and all other walls, before any row is swept. Collective.
  void apply(Populations<Real>& populations, const CellMap& cells, MPI_Comm communicator) const;

private:
  static constexpr int entering = 5;                 // directions
  using Differences = std::array<double, entering>;  // d_o of a cell

  template <typename Action>
  void for_cells(int layer, const Action& action) const;
  std::vector<Differences> differences_in_plane(const Populations<Real>& populations, const CellMap& cells) const;
  std::vector<Differences> differences_at_inlet(std::vector<Differences> in_plane, MPI_Comm communicator) const;

  CellIndexing indexing_;
  int axis_, inward_, nu_, nv_;
  std::array<int, entering> directions_;
  // Layers of cells, in this rank's coordinates; -1: on other ranks.
  int plane_ = -1, inlet_ = -1;
  int plane_rank_ = -1, inlet_rank_ = -1;  // where this rank's inlet takes d_o from, and its plane sends them to
  double mass_;                            // M
};

}  // namespace thalweg::lbm
