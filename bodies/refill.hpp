// Gives cells that a body has just uncovered their populations. With rho_n the density at rest plus the mean excess
// over it of the neighbours that were fluid before (none: that of the fluid around a grain, no excess beside a solid),
// u_w the velocity of the body's rigid motion at the cell, F the body force:
//   f_i^c = f_i^eq(rho_n, u_w) + 3/2 w_i c_i.F
// These are post-collision populations, whose momentum is rho u + F/2. Lattice units.
//
// Neighbours may be on other ranks. Every rank that owns neighbours of an uncovered cell sees that cell in its ghost
// layer too, so both sides know without asking who sends what; sums are exact, so the result does not depend on the
// ranks.
#pragma once

#include "bodies/map/body_map.hpp"
#include "bodies/map/hydrostatic.hpp"
#include "core/parallel/decomposition.hpp"
#include "core/sums/fixed_point.hpp"
#include "lbm/fluid/fluid.hpp"

#include <mpi.h>

#include <array>
#include <span>
#include <vector>

namespace thalweg::bodies {

struct RefillTotals {
  std::int64_t cells = 0;                // this rank's uncovered cells
  Vec3 momentum = Vec3::Zero();          // they were given, lattice units
  Vec3 angular_momentum = Vec3::Zero();  // the same about the origin
  std::int64_t mass = 0;                 // LatticeFixed: the sum of what the bodies' masses got
};

class Refill {
public:
  Refill(const Decomposition& decomposition, MPI_Comm communicator);

  // changes: from BodyMap::settle(); surrounding: rho - rho_rest of the fluid around the body of each slot; bodies:
  // centre and motion of the slots, to whose mass rho - rho_rest of the
  // cells that each has uncovered is added. Call after the map is settled and before the halo exchange. Every rank
  // calls it each step.
  template <typename Real>
  RefillTotals fill(lbm::Fluid<Real>& fluid, const std::vector<CellChange>& changes, const Hydrostatic& rest,
                    std::span<const double> surrounding, std::vector<LinkBody>& bodies);

private:
  // Sums over the fluid neighbours of one uncovered cell; sent between ranks as it is.
  struct Neighbours {
    std::int64_t count = 0, excess = 0;  // LatticeFixed sum of rho - rho_rest

    void add(const Neighbours& others);
  };
  struct Uncovered {
    Index3 global;        // inside the box
    std::int32_t before;  // slot that covered it
    Neighbours neighbours;
  };

  Index3 wrapped(Index3 cell) const;
  bool inside_box(const Index3& cell) const;
  int owner_of(const Index3& cell) const;
  std::vector<int> owners_of_neighbours(const Index3& cell) const;  // other than this rank, sorted
  std::ptrdiff_t index_of(const lbm::CellIndexing& indexing, const Index3& global) const;
  std::vector<Uncovered> uncovered_cells(const std::vector<CellChange>& changes) const;
  template <typename Real>
  void add_own_neighbours(const lbm::Fluid<Real>& fluid, const Hydrostatic& rest,
                          std::vector<Uncovered>& uncovered) const;
  void exchange(std::vector<Uncovered>& uncovered) const;
  static double excess_of(const Neighbours& neighbours, double surrounding);
  static std::array<double, 19> populations_of(double deviation, const Vec3& velocity, const Vec3& force);

  const Decomposition& decomposition_;
  MPI_Comm communicator_;
  int rank_;
  Block block_;
  PeriodicBox box_;  // cells
};

}  // namespace thalweg::bodies
