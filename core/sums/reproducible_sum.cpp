#include "core/sums/reproducible_sum.hpp"

#include "core/parallel/mpi_count.hpp"
#include "core/parallel/mpi_session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace thalweg {

namespace {

// Power of two by which a column is multiplied before rounding: |term| < 2^exponent, and 2^spare terms fit in 62 bits.
int shift_for(double largest, std::int64_t terms) {
  int exponent = 0;
  std::frexp(largest, &exponent);
  int spare = 0;
  while ((std::int64_t{1} << spare) < terms) ++spare;
  return 62 - exponent - spare;
}

}  // namespace

std::vector<double> reproducible_sums(MPI_Comm communicator, std::span<const double> terms, std::size_t columns) {
  const std::size_t rows = columns == 0 ? 0 : terms.size() / columns;
  return reproducible_sums_by_bin(communicator, 1, columns, [&](const TermTaker& take) {
    for (std::size_t row = 0; row < rows; ++row) take(0, terms.subspan(row * columns, columns));
  });
}

std::vector<double> reproducible_sums_by_bin(MPI_Comm communicator, int bins, std::size_t columns,
                                             const std::function<void(const TermTaker&)>& rows) {
  // Largest term of every column, by one reduction; infinity stands for anything not finite.
  std::vector<double> largest(columns, 0.0);
  std::int64_t rows_here = 0;
  rows([&](int, std::span<const double> row) {
    ++rows_here;
    for (std::size_t c = 0; c < columns; ++c) {
      const double size = std::abs(row[c]);
      largest[c] = std::isfinite(size) ? std::max(largest[c], size) : std::numeric_limits<double>::infinity();
    }
  });
  MPI_Allreduce(MPI_IN_PLACE, largest.data(), static_cast<int>(columns), MPI_DOUBLE, MPI_MAX, communicator);
  const std::int64_t all_rows = sum_over_ranks(communicator, rows_here);

  const std::size_t entries = columns * static_cast<std::size_t>(bins);
  std::vector<std::int64_t> sums(entries, 0);
  std::vector<int> shift(columns, 0);
  const auto has_sum = [&](std::size_t c) { return largest[c] != 0.0 && !std::isinf(largest[c]); };
  for (std::size_t c = 0; c < columns; ++c)
    if (has_sum(c)) shift[c] = shift_for(largest[c], all_rows);
  rows([&](int bin, std::span<const double> row) {
    std::int64_t* sum = sums.data() + static_cast<std::size_t>(bin) * columns;
    for (std::size_t c = 0; c < columns; ++c)
      if (has_sum(c)) sum[c] += std::llrint(std::ldexp(row[c], shift[c]));
  });
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), mpi_count(entries), MPI_INT64_T, MPI_SUM, communicator);

  std::vector<double> result(entries, 0.0);
  for (std::size_t e = 0; e < entries; ++e) {
    const std::size_t c = e % columns;
    result[e] = std::isinf(largest[c]) ? std::numeric_limits<double>::quiet_NaN()
                                       : std::ldexp(static_cast<double>(sums[e]), -shift[c]);
  }
  return result;
}

}  // namespace thalweg
