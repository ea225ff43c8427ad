// The memory bandwidth an in-place update can reach on this machine, measured with the ranks of the run all at once.
#pragma once

#include <mpi.h>

#include <vector>

namespace thalweg::benchmark {

// Updates a large array in place, a[i] = s a[i] + t, over and over: the traffic of a lattice that streams in place,
// without its work. Each rank has its own array, far larger than its share of the caches.
class InPlaceBandwidth {
public:
  explicit InPlaceBandwidth(MPI_Comm communicator);

  // Best of so many passes so far and now: bytes read and written by all ranks per second, over the slowest rank's
  // time.
  double measure(int passes);

private:
  MPI_Comm communicator_;
  std::vector<double> values_;
  double best_ = 0.0;
};

}  // namespace thalweg::benchmark
