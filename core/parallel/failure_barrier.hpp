// After an exception: did every rank fail, so that all can end in good order, or this one alone?
#pragma once

#include <mpi.h>

#include <optional>

namespace thalweg {

// Time that a failed rank waits for the others before it considers them stuck: longer than any step.
inline constexpr double seconds_to_wait_for_others = 10.0;

class FailureBarrier {
public:
  explicit FailureBarrier(MPI_Comm communicator);  // collective, while all is well
  ~FailureBarrier();
  FailureBarrier(const FailureBarrier&) = delete;
  FailureBarrier& operator=(const FailureBarrier&) = delete;

  // Called by a rank that has failed. True if all ranks get here within `patience` seconds. False: the others wait in
  // some exchange for this rank and will do so for ever; only MPI_Abort ends them. Asked again, it gives the same
  // answer.
  bool all_ranks_failed(double patience);

private:
  MPI_Comm communicator_ = MPI_COMM_NULL;
  std::optional<bool> all_failed_;
};

}  // namespace thalweg
