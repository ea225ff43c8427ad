// How much memory there is, how much a run takes, and the refusal of one that cannot fit.
#pragma once

#include "driver/case/case.hpp"

#include <mpi.h>

#include <string>

namespace thalweg::driver {

// Of this node, within the limits of container and job, bytes.
double memory_of_this_node();

// Of that, what runs that are started now can have, bytes.
double free_memory_for_runs();

// The part of it that is a run's; the rest is the system's.
double usable_memory_of_this_node();

// What a case takes on one rank, bytes.
double memory_on_one_rank(const Case& c);

// What the report of `thalweg check` says: needed, in bytes, on machines that have `there` each.
std::string memory_line(double needed, double there);

// Throws InputError where a run that takes `needed` bytes on all ranks, `on_node` of them on a node of `there` bytes,
// would not fit: nine tenths of a node are a run's, the rest is the system's.
void refuse_without_memory(double needed, double on_node, double there);

// The same of a case on one rank of this machine.
void refuse_without_memory(const Case& c);

// The same of a run that is about to start on these ranks, before it takes any memory. Collective; all ranks throw.
void refuse_without_memory(const Case& c, MPI_Comm communicator, const Index3& layout);

// Peak memory of the processes of a run, as the system counts it, bytes; since the last call of
// forget_largest_memory(), where the system can reset it.
struct MemoryUse {
  double all_ranks, largest_rank;
};
MemoryUse memory_use(MPI_Comm communicator);  // collective
void forget_largest_memory();

}  // namespace thalweg::driver
