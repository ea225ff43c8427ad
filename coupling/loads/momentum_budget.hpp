// Records the momentum that a lattice fluid carries and hands over in one step, in SI units, as snapshots show it.
#pragma once

#include "bodies/links/momentum_by_height.hpp"
#include "core/base/units.hpp"
#include "core/state/snapshot.hpp"
#include "lbm/fluid/fluid.hpp"

namespace thalweg::coupling {

// Momentum budget of the coming step. Halo, walls and links must be ready for its sweep, with the cells as they will be
// then. given: what links and covered cells of this rank give to bodies. reference: rho - 1 that exerts no force.
// Collective; the same bits on every rank, and on any number of ranks.
template <typename Real>
MomentumBudget momentum_budget_of(lbm::Fluid<Real>& fluid, const Units& units, double reference,
                                  const bodies::MomentumByHeight& given);

}  // namespace thalweg::coupling
