// Records the momentum that a lattice fluid carries and hands over in one step, in SI units, as snapshots show it.
#pragma once

#include "core/base/units.hpp"
#include "core/state/snapshot.hpp"
#include "core/sums/fixed_point.hpp"
#include "lbm/fluid/fluid.hpp"

#include <vector>

namespace thalweg::coupling {

// Momentum budget of the coming step. Halo, walls and links must be ready for its sweep, with the cells as they will be
// then. on_grains: momentum (lattice units) that links and covered cells of this rank give to grains, in 2 n_z + 1 sums
// (bodies/links/interpolated_bounce_back.hpp, by_height) for the n_z planes of this block. reference: rho - 1 that
// exerts no force. Collective; the same bits on every rank, and on any number of ranks.
template <typename Real>
MomentumBudget momentum_budget_of(lbm::Fluid<Real>& fluid, const Units& units, double reference,
                                  const std::vector<FixedVec3>& on_grains);

}  // namespace thalweg::coupling
