#include "driver/machine.hpp"

#include "core/mpi_session.hpp"

#include <algorithm>
#include <chrono>
#include <vector>

namespace thalweg::driver {

double measure_bandwidth(MPI_Comm communicator) {
  // 256 MiB together, at least 32 MiB a rank: caches of a whole chip hold less than half of it.
  const std::size_t values = (std::size_t{1} << 25) / static_cast<std::size_t>(std::min(8, size_of(communicator)));
  constexpr double patience = 0.08;  // s
  std::vector<double> array(values, 1.0);
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  MPI_Barrier(communicator);
  const Clock::time_point begin = Clock::now();
  double fastest = 1e9;
  do {
    const Clock::time_point start = Clock::now();
    for (double& value : array) value = 0.5 * value + 0.5;
    fastest = std::min(fastest, seconds_since(start));
  } while (seconds_since(begin) < patience);
  return sum_over_ranks(communicator, 2.0 * sizeof(double) * static_cast<double>(values) / fastest);
}

}  // namespace thalweg::driver
