// The grains of a case, as dem wants them: the same for dry grains and for grains in a fluid.
#pragma once

#include "beds/population_seeds.hpp"
#include "dem/grain_dynamics.hpp"
#include "driver/case/case.hpp"

#include <mpi.h>

namespace thalweg::driver {

// Box of the grains: the domain size of the case, or the size of its whole number of cells if that differs slightly.
// The same on any number of ranks.
PeriodicBox grain_box(const Case& c);

// Contact law, time step, sub-steps, skin, rigid assemblies, and the walls: a plane with the walls' friction at every
// non-periodic face, in the order of the case's faces, then those of the section walls. The body force, ghost width,
// attached columns, supplies and sinks are left to the caller.
dem::GrainParameters grain_parameters(const Case& c, const PeriodicBox& box);

// All grains at the start (beds/population_seeds.hpp), for one process.
dem::GrainSeeds grain_seeds(const Case& c);
// Initial grains of this rank: its own and all that may touch them. Collective.
dem::GrainSeeds grain_seeds(const Case& c, MPI_Comm communicator, const Decomposition& decomposition);

}  // namespace thalweg::driver
