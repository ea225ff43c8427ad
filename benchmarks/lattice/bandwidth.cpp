#include "benchmarks/lattice/bandwidth.hpp"

#include "core/parallel/mpi_session.hpp"

#include <algorithm>

namespace thalweg::benchmark {

namespace {

constexpr std::size_t megabyte = std::size_t{1} << 20;

// Returns a value so that no pass can be left out.
double update_in_place(std::vector<double>& values) {
  double* __restrict a = values.data();
  const std::size_t count = values.size();
  for (std::size_t i = 0; i < count; ++i) a[i] = 0.999999 * a[i] + 1e-6;
  return a[count / 2];
}

}  // namespace

InPlaceBandwidth::InPlaceBandwidth(MPI_Comm communicator)
    : communicator_(communicator), values_(128 * megabyte / sizeof(double), 1.0) {}

double InPlaceBandwidth::measure(int passes) {
  double guard = 0.0;
  for (int pass = 0; pass < passes; ++pass) {
    MPI_Barrier(communicator_);
    const double start = MPI_Wtime();
    guard += update_in_place(values_);
    MPI_Barrier(communicator_);  // all work lies between the first start and the last end
    const double seconds = max_over_ranks(communicator_, MPI_Wtime() - start);
    const double bytes = 2.0 * sizeof(double) * static_cast<double>(values_.size()) * size_of(communicator_);
    best_ = std::max(best_, bytes / seconds);
  }
  return guard < 0.0 ? 0.0 : best_;
}

}  // namespace thalweg::benchmark
