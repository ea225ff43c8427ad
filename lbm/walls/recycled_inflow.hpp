// Inflow that recycles: what enters at an inlet is the flow in a plane downstream, brought to the discharge asked for.
// So the flow enters with a profile and with turbulence that have developed in the box (Lund, Wu and Squires 1998,
// without their rescaling of a boundary layer that grows). Lattice units.
//
//   f_o(x, t+1) = f_o(p, t+1) + 6 w_o c_o.n (M - M_p)/N
//
// with the directions o that enter, along the normal n into the box, a fluid cell x of the inlet and the cell p of the
// plane that lies downstream of it. Where p or the cell that f_o(p) comes from is in a body, f_o'^c(x) takes its place,
// with the opposite direction o': a wall. M_p is the mass by which all that would enter exceeds all that leaves, and M
// that of a fluid of rho = 1 with the speed asked for over all cells of the face, so that the discharge does not depend
// on what covers the N fluid cells of the inlet. The last term is the pressure that is lost on the way to the plane,
// and starts the fluid from rest.
//
// Populations that enter carry what goes downstream: eddies with their pressure, and sound that has passed the plane
// downstream, as in a periodic box. Sound that comes back upstream leaves. An inlet that took the velocity alone from
// the plane would copy both, with more energy than they have, and reflect the second: sound between plane and inlet
// grows then.
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
  // into the box. Throws InputError for a plane outside the box or at the inlet itself.
  RecycledInflow(const Decomposition& decomposition, int rank, const CellIndexing& indexing, int face, int plane,
                 double speed);

  // Fills the populations that enter at the inlet, once those that enter the plane are there: after the halo exchange
  // and all other walls, before any row is swept. Collective.
  void apply(Populations<Real>& populations, const CellMap& cells, MPI_Comm communicator);

private:
  static constexpr int entering = 5;              // directions
  using Entering = std::array<double, entering>;  // populations of a cell; not a number: from a body

  template <typename Action>
  void for_cells(int layer, const Action& action) const;
  void take_from_plane(const Populations<Real>& populations, const CellMap& cells);
  void send_to_inlet(MPI_Comm communicator);

  CellIndexing indexing_;
  int axis_, inward_, nu_, nv_;
  std::array<int, entering> directions_;
  // Layers of cells, in this rank's coordinates; -1: on other ranks.
  int plane_ = -1, inlet_ = -1;
  int plane_rank_ = -1, inlet_rank_ = -1;  // where this rank's inlet takes f_o from, and its plane sends it to
  std::vector<Entering> recycled_;         // of the cells in the plane or at the inlet
  double mass_;                            // M
};

}  // namespace thalweg::lbm
