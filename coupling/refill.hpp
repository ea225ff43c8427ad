// Gives cells that a grain has just uncovered the populations of equilibrium: the mean density of their fluid
// neighbours (those that were fluid before) and the velocity of the grain's surface motion at the cell.
//
// Neighbours may be on other ranks. Every rank that owns neighbours of an uncovered cell sees that cell in its ghost
// layer too, so both sides know without asking who sends what; sums are exact, so the result is the same on any ranks.
#pragma once

#include "core/decomposition.hpp"
#include "core/fixed_point.hpp"
#include "coupling/grain_map.hpp"
#include "lbm/fluid.hpp"

#include <mpi.h>

#include <vector>

namespace thalweg::coupling {

struct RefillTotals {
  std::int64_t cells = 0;        // this rank's uncovered cells
  Vec3 momentum = Vec3::Zero();  // they were given, lattice units
};

class Refill {
public:
  Refill(const Decomposition& decomposition, MPI_Comm communicator);

  // changes: from GrainMap::settle(); bodies: motion of the slots. Call after the map is settled and before the halo
  // exchange. Every rank calls it each step.
  template <typename Real>
  RefillTotals equilibrium(lbm::Fluid<Real>& fluid, const std::vector<GrainMap::Change>& changes,
                           const std::vector<lbm::LinkBody>& bodies);

private:
  struct DensitySum {      // of the fluid neighbours of one uncovered cell
    std::int64_t sum = 0;  // LatticeFixed of rho - 1
    std::int64_t count = 0;
  };
  struct Uncovered {
    Index3 global;        // inside the box
    Index3 local;         // one of its places in memory
    std::int32_t before;  // slot that covered it
    DensitySum density;
  };

  Index3 wrapped(Index3 cell) const;
  bool inside_box(const Index3& cell) const;
  int owner_of(const Index3& cell) const;
  std::vector<int> owners_of_neighbours(const Index3& cell) const;  // other than this rank, sorted
  std::vector<Uncovered> uncovered_cells(const std::vector<GrainMap::Change>& changes) const;
  template <typename Real>
  void add_own_neighbours(const lbm::Fluid<Real>& fluid, std::vector<Uncovered>& uncovered) const;
  void exchange_sums(std::vector<Uncovered>& uncovered) const;

  const Decomposition& decomposition_;
  MPI_Comm communicator_;
  int rank_;
  Block block_;
};

}  // namespace thalweg::coupling
