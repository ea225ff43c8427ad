// Work that one rank does for all, such as creating a folder, with errors that every rank learns of.
#pragma once

#include <mpi.h>

#include <functional>
#include <string>

namespace thalweg {

// Runs `work` on rank 0. If it throws, every rank throws: InputError as InputError, anything else as RunError.
// Collective.
void on_first_rank(MPI_Comm communicator, const std::function<void()>& work);

// Result of `work` on rank 0, handed to every rank: a path it has chosen, the text of a file. Ranks on several nodes
// would not all find the same, because a network file system shows each node what it was some seconds ago. Errors as
// above. MPI_COMM_NULL: this process alone, perhaps without MPI. Collective.
std::string told_by_first_rank(MPI_Comm communicator, const std::function<std::string()>& work);

}  // namespace thalweg
