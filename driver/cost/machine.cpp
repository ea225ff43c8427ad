#include "driver/cost/machine.hpp"

#include "core/base/huge_pages.hpp"
#include "core/parallel/mpi_session.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <span>

namespace thalweg::driver {

namespace {

constexpr std::size_t all_values = std::size_t{1} << 25;  // 256 MiB: caches of a whole chip hold less than half of it

double seconds_of_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double seconds_of_process() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Bytes per second that this process reads and writes updating the array, which lies in huge pages as the lattice does.
// seconds: of a clock.
double bandwidth_on(std::span<double> array, double (*seconds)()) {
  constexpr double patience = 0.03;  // s, two passes or three
  const double begin = seconds();
  double fastest = 1e9;
  do {
    const double start = seconds();
    for (double& value : array) value = 0.5 * value + 0.5;
    fastest = std::min(fastest, seconds() - start);
  } while (seconds() - begin < patience);
  return 2.0 * sizeof(double) * static_cast<double>(array.size()) / fastest;
}

}  // namespace

double measure_bandwidth() {
  const HugePages<double> array = in_huge_pages(all_values, 1.0);
  return bandwidth_on({array.get(), all_values}, seconds_of_process);
}

double measure_bandwidth(MPI_Comm communicator) {
  const std::size_t count = all_values / static_cast<std::size_t>(std::min(8, size_of(communicator)));
  const HugePages<double> array = in_huge_pages(count, 1.0);
  MPI_Barrier(communicator);
  return sum_over_ranks(communicator, bandwidth_on({array.get(), count}, seconds_of_clock));
}

}  // namespace thalweg::driver
