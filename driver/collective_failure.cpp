#include "driver/collective_failure.hpp"

#include <chrono>
#include <thread>

namespace thalweg::driver {

FailureCouncil::FailureCouncil(MPI_Comm communicator) { MPI_Comm_dup(communicator, &communicator_); }

FailureCouncil::~FailureCouncil() {
  // A barrier the others never came to is still under way on it.
  if (answer_.value_or(true)) MPI_Comm_free(&communicator_);
}

bool FailureCouncil::everybody_failed(double patience) {
  if (answer_) return *answer_;
  MPI_Request arrival;
  MPI_Ibarrier(communicator_, &arrival);
  const auto start = std::chrono::steady_clock::now();
  int all_here = 0;
  while (true) {
    MPI_Test(&arrival, &all_here, MPI_STATUS_IGNORE);
    if (all_here) return answer_.emplace(true);
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > patience)
      return answer_.emplace(false);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace thalweg::driver
