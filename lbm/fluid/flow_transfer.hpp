// The flow of another lattice as the start of this one.
#pragma once

#include "core/base/archive.hpp"
#include "lbm/fluid/fluid.hpp"

namespace thalweg::lbm {

// Fills `fluid` with the density and velocity that a Fluid<Real> of another number of cells, or another step, saved: at
// the centre of each cell, linear along each axis between the centres of the eight cells around the same fraction of
// the box; periodic where `fluid` is, and constant from the last centre to a wall. Solid cells count as fluid at rest,
// as they were saved. Populations become their equilibrium (Fluid::initialise()); the stress of shear follows within
// a few steps.
//
// The velocity is the saved momentum, which is that after a collision, over the density: it has the whole force F of
// the saved flow, of which state_at() has half, because the archive does not say what F was. The flow therefore begins
// F/(2 rho) too fast, which is half of what the force does in a step of the saved flow (gravity: g dt/2, m/s).
//
// velocity_unit: that of the saved lattice, dx/dt, over that of `fluid`; rho - 1 is multiplied by its square, which
// keeps the pressure in SI units. Throws InputError where the archive has populations of another precision. Collective.
template <typename Real>
void transfer_flow(Fluid<Real>& fluid, ArchiveReader& archive, double velocity_unit);

}  // namespace thalweg::lbm
