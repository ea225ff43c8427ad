// The fluid of another run as a start.
#pragma once

#include "core/base/archive.hpp"
#include "coupling/keys/fluid_parameters.hpp"
#include "lbm/fluid/fluid.hpp"

namespace thalweg::coupling {

// The fluid of a state that was saved on a lattice of `spacing` (m): its populations where cells and steps are the
// same, so that it goes on as that run would, else its flow (lbm::transfer_flow). A control of the flow begins with the
// force of that run's. Returns the factor that rho - 1 was multiplied by. Throws InputError where the boxes differ by
// more than a cell, or the precisions. Collective.
template <typename Real>
double import_fluid(lbm::Fluid<Real>& fluid, ArchiveReader& archive, double spacing, const FluidParameters& parameters);

}  // namespace thalweg::coupling
