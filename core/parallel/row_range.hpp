// Share of the rows of a dataset that each rank writes or reads: even, in order of rank.
#pragma once

#include "core/base/archive.hpp"
#include "core/base/check.hpp"
#include "core/parallel/mpi_session.hpp"

#include <cstdint>

namespace thalweg {

// The rows [first, last) of `count` that a rank writes or reads.
struct RowRange {
  RowRange(std::int64_t rows, int ranks, int rank)
      : count(rows), first(rows * rank / ranks), last(rows * (rank + 1) / ranks) {}

  // The range of the rows that this rank holds, all ranks' rows being numbered in order of rank. Collective.
  static RowRange of_rows(std::int64_t rows, MPI_Comm communicator) {
    RowRange share(sum_over_ranks(communicator, rows), 1, 0);
    MPI_Scan(&rows, &share.last, 1, MPI_INT64_T, MPI_SUM, communicator);
    share.first = share.last - rows;
    return share;
  }

  ArrayBox box(std::uint64_t columns) const {
    return {{static_cast<std::uint64_t>(count), columns},
            {static_cast<std::uint64_t>(first), 0},
            {static_cast<std::uint64_t>(last - first), columns}};
  }
  ArrayBox box() const {
    return {{static_cast<std::uint64_t>(count)},
            {static_cast<std::uint64_t>(first)},
            {static_cast<std::uint64_t>(last - first)}};
  }
  std::int64_t size() const { return last - first; }

  std::int64_t count, first, last;
};

// The rank in whose even share of `count` rows a row falls.
inline int rank_of_row(std::int64_t row, std::int64_t count, int ranks) {
  CHECK(row >= 0 && row < count);
  auto rank = static_cast<int>(row * ranks / count);
  while (row >= count * (rank + 1) / ranks) ++rank;
  return rank;
}

}  // namespace thalweg
