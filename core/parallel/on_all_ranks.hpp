// Work that every rank does on its own part, with errors that every rank learns of.
#pragma once

#include <mpi.h>

#include <functional>

namespace thalweg {

// Runs `work` on every rank. If it throws on any, every rank throws what the first of them has thrown: InputError as
// InputError, anything else as RunError. `work` may not communicate. Collective.
void on_all_ranks(MPI_Comm communicator, const std::function<void()>& work);

}  // namespace thalweg
