// The momentum that a lattice fluid carries and hands over, in SI units, as snapshots show it.
#pragma once

#include "core/fixed_point.hpp"
#include "core/snapshot.hpp"
#include "core/units.hpp"
#include "lbm/fluid.hpp"

#include <functional>
#include <vector>

namespace thalweg::coupling {

// apply_links: applies the links of bodies and adds what they take to 2 n_z + 1 sums (lbm/bouzidi.hpp, by_height).
// reference: rho - 1 that presses on nothing. Fills the slots that stream in from beyond walls and bodies, as the next
// step will do again: no post-collision population changes. Collective.
template <typename Real>
MomentumBudget sample_momentum(lbm::Fluid<Real>& fluid, const Units& units, double reference,
                               const std::function<void(std::vector<FixedVec3>&)>& apply_links,
                               const MomentumSource::MomentumVisitor& visit);

}  // namespace thalweg::coupling
