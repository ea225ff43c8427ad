// Memory of the machine, memory needed by a run, and the refusal of a run that does not fit.
#pragma once

#include "driver/case/case.hpp"

#include <mpi.h>

#include <string>

namespace thalweg::driver {

// Memory of this node within the limits of container and job, bytes.
double memory_of_this_node();

// Memory of this node that nothing uses now, bytes.
double free_memory_for_runs();

// Memory of this node that a run may take, nine tenths, bytes; the rest is the system's.
double usable_memory_of_this_node();

// Memory needed by a case on one rank, bytes.
double memory_on_one_rank(const Case& c);

// Line of `thalweg check`: bytes needed, and bytes of each machine.
std::string memory_line(double needed, double there);

// Throws InputError where a run that takes `needed` bytes on all ranks, `on_node` of them on a node of `there` bytes,
// would not fit: nine tenths of a node are a run's, the rest is the system's.
void refuse_without_memory(double needed, double on_node, double there);

// Throws InputError if the case does not fit into this machine on one rank.
void refuse_without_memory(const Case& c);

// The same for a run on these ranks, before it allocates anything. Collective; all ranks throw.
void refuse_without_memory(const Case& c, MPI_Comm communicator, const Index3& layout);

// Peak memory of the processes of a run, as the system counts it, bytes; since the last call of
// forget_largest_memory(), where the system can reset it.
struct MemoryUse {
  double all_ranks, largest_rank;
};
MemoryUse memory_use(MPI_Comm communicator);  // collective
void forget_largest_memory();

}  // namespace thalweg::driver
