// Work that one rank does for all, such as creating a folder, with errors that every rank learns of.
#pragma once

#include <mpi.h>

#include <functional>

namespace thalweg {

// Runs `work` on rank 0. If it throws, every rank throws: InputError as InputError, anything else as RunError.
// Collective.
void on_first_rank(MPI_Comm communicator, const std::function<void()>& work);

}  // namespace thalweg
