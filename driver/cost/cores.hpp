// How many cores the ranks of a node have: fewer cores than ranks cost far more than their share, because ranks that
// wait for a message do so busily.
#pragma once

#include <mpi.h>

#include <string>

namespace thalweg::driver {

// That this process may use, by the scheduler's set and the quota of its container and job. Needs no MPI.
int available_cores();

// A warning with what to do about it if ranks of this communicator outnumber the cores of their node, by the
// scheduler's set and the quota of container and job, and do not yield; empty otherwise. On the first rank, of the most
// crowded node. Collective.
std::string crowding_warning(MPI_Comm communicator);

}  // namespace thalweg::driver
