// The fields of a lattice fluid in SI units, as snapshots show them.
#pragma once

#include "core/base/units.hpp"
#include "core/state/snapshot.hpp"
#include "lbm/fluid/fluid.hpp"

#include <functional>
#include <vector>

namespace thalweg::coupling {

// Access of sampling to a system. Fields are zero in cells of bodies.
struct SampleContext {
  Units units;
  std::function<std::int32_t(std::int32_t body)> grain_id;  // of a body of the cell map
  std::function<void()> apply_links;                        // of bodies, where there are any
};

// The wanted fields of those cells of the region (global coordinates) that this rank owns. Only these cells are read,
// and for gradients their neighbours; but shear rate and eddy viscosity need all that streams in, so for them the slots
// that are filled from walls and bodies are filled everywhere. The next step fills them anew, once bodies have moved,
// so sampling changes no step. Collective.
template <typename Real>
FluidFields sample_fields(lbm::Fluid<Real>& fluid, const SampleContext& context, const std::vector<FluidField>& wanted,
                          const Block& region);

// Every owned fluid cell's velocity.
template <typename Real>
void visit_velocities(const lbm::Fluid<Real>& fluid, const Units& units, const FluidSource::VelocityVisitor& visit);

// State of one owned cell; none if a body covers it.
template <typename Real>
std::optional<FluidSource::State> state_of(const lbm::Fluid<Real>& fluid, const Units& units, const Index3& cell);

// Driving force of the fluid, and the force on the upper face in the coming step; reference: rho - 1 that exerts no
// force. Fills the slots at walls, which the next step fills anew. Collective.
template <typename Real>
FluidSource::Drive drive_of(lbm::Fluid<Real>& fluid, const Units& units, double reference);

}  // namespace thalweg::coupling
