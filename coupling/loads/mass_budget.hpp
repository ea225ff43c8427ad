// The balance of the fluid's mass. It follows the excess E = sum over the fluid cells of rho - rho_rest (rho_rest = 1,
// or the hydrostatic density): the volume that grains cover on the lattice is a staircase that gains and loses a tenth
// of a per cent of the cells from step to step, and the sum of rho follows it; the excess, which is the pressure, must
// not. From one step to the next
//   E changes by  links:       sum over links of f_i' - f_i^c, what is returned (mass_return.hpp) among it
//                 covered:     less rho - rho_rest of every cell that becomes solid
//                 uncovered:   rho - rho_rest of every cell that becomes fluid
//                 corrections: what is regularly added to all cells (LatticeSystem)
//                 walls:       what passes through the faces; nothing, to round-off, where none is open
// In exact integers, so that the first four do not depend on the number of ranks. Lattice units.
#pragma once

#include "core/base/archive.hpp"
#include "core/base/units.hpp"
#include "core/state/system.hpp"
#include "core/sums/fixed_point.hpp"
#include "core/sums/wide_sum.hpp"

#include <mpi.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace thalweg::coupling {

class MassBudget {
public:
  enum Term { links, covered, uncovered, corrections, terms };

  explicit MassBudget(MPI_Comm communicator) : communicator_(communicator) {}

  // mass: what this rank adds, a LatticeFixed sum. Corrections concern the whole run and are recorded by one rank; they
  // may be larger than a LatticeFixed term.
  void record(Term term, std::int64_t mass) { sums_.at(term).add(mass); }
  void record(Term term, double mass) { sums_.at(term).add(WideSum::from(mass, LatticeFixed::bits)); }

  // Since the start of the run, over all ranks, by Term; all at once because a reduction is shared. Collective.
  std::array<double, terms> totals() const;

  // Starts a new budget, with the present excess and what grains taken over from another run owe, over all ranks.
  void open(double excess, double owed);
  double kept() const { return kept_; }  // excess and owed mass at the start of the run, which are to stay

  // Columns of the series (kg): excess: E as measured; owed: what is still to be returned, over all ranks. Collective.
  std::vector<Diagnostic> diagnostics(double excess, double owed, const Units& units) const;

  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);

private:
  std::array<WideSum, terms> totals_exact() const;

  MPI_Comm communicator_;
  std::array<WideSum, terms> sums_{};  // this rank's
  double kept_ = 0.0;                  // excess and owed mass
};

}  // namespace thalweg::coupling
