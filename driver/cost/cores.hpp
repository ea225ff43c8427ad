// Number of cores available to the ranks of a node. With fewer cores than ranks a run is far slower than their ratio,
// because ranks poll while they wait for messages.
#pragma once

#include <mpi.h>

#include <string>

namespace thalweg::driver {

// Cores that this process may use: the scheduler's set, limited by the quota of container and job. Needs no MPI.
int available_cores();

// A warning with what to do about it if ranks of this communicator outnumber the cores of their node, by the
// scheduler's set and the quota of container and job, and do not yield; empty otherwise. On the first rank, of the most
// crowded node. Collective.
std::string crowding_warning(MPI_Comm communicator);

}  // namespace thalweg::driver
