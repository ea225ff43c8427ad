#include "core/parallel/failure_barrier.hpp"

#include <chrono>
#include <thread>

namespace thalweg {

FailureBarrier::FailureBarrier(MPI_Comm communicator) { MPI_Comm_dup(communicator, &communicator_); }

FailureBarrier::~FailureBarrier() {
  // A barrier that the others never reached is still pending on it.
  if (all_failed_.value_or(true)) MPI_Comm_free(&communicator_);
}

bool FailureBarrier::all_ranks_failed(double patience) {
  if (all_failed_) return *all_failed_;
  MPI_Request arrival;
  MPI_Ibarrier(communicator_, &arrival);
  const auto start = std::chrono::steady_clock::now();
  int all_here = 0;
  while (true) {
    MPI_Test(&arrival, &all_here, MPI_STATUS_IGNORE);
    if (all_here) return all_failed_.emplace(true);
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > patience)
      return all_failed_.emplace(false);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace thalweg
