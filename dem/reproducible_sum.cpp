#include "dem/reproducible_sum.hpp"

#include "core/mpi_session.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::dem {

double reproducible_sum(MPI_Comm communicator, std::span<const double> terms) {
  double largest = 0.0;
  for (const double term : terms)
    largest = std::max(largest, std::isfinite(term) ? std::abs(term) : std::numeric_limits<double>::infinity());
  largest = max_over_ranks(communicator, largest);
  const std::int64_t count = sum_over_ranks(communicator, static_cast<std::int64_t>(terms.size()));
  if (std::isinf(largest)) return std::numeric_limits<double>::quiet_NaN();
  if (largest == 0.0) return 0.0;

  int term_exponent = 0, count_exponent = 0;   // largest < 2^term_exponent, count < 2^count_exponent
  std::frexp(largest, &term_exponent);
  std::frexp(static_cast<double>(count), &count_exponent);
  const int bits = 62 - term_exponent - count_exponent;
  std::int64_t sum = 0;
  for (const double term : terms) sum += std::llrint(std::ldexp(term, bits));
  return std::ldexp(static_cast<double>(sum_over_ranks(communicator, sum)), -bits);
}

}  // namespace thalweg::dem
