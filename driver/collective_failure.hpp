// After an exception: did every rank fail, so that all can end in good order, or this one alone?
#pragma once

#include <mpi.h>

#include <optional>

namespace thalweg::driver {

// How long a failed rank waits for the others before it takes them for stuck: longer than any step.
inline constexpr double seconds_to_wait_for_others = 10.0;

class FailureCouncil {
public:
  explicit FailureCouncil(MPI_Comm communicator);  // collective, while all is well
  ~FailureCouncil();
  FailureCouncil(const FailureCouncil&) = delete;
  FailureCouncil& operator=(const FailureCouncil&) = delete;

  // Called by a rank that has failed. True if all ranks get here within `patience` seconds. False: the others wait in
  // some exchange for this rank and will do so for ever; only MPI_Abort ends them. Asked again, it gives the same
  // answer.
  bool everybody_failed(double patience);

private:
  MPI_Comm communicator_ = MPI_COMM_NULL;
  std::optional<bool> answer_;
};

}  // namespace thalweg::driver
