// Processes that work together: the ranks of a communicator, or one process alone, perhaps without MPI.
#pragma once

#include "core/parallel/mpi_count.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_all_ranks.hpp"
#include "core/parallel/row_range.hpp"

#include <cstdint>
#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

namespace thalweg {

// Collective: everything but alone(), count(), number(), communicator() and share_of().
class Ranks {
public:
  Ranks() = default;                                                      // this process alone
  explicit Ranks(MPI_Comm communicator) : communicator_(communicator) {}  // MPI_COMM_NULL: the same

  bool alone() const { return communicator_ == MPI_COMM_NULL; }
  int count() const { return alone() ? 1 : size_of(communicator_); }
  int number() const { return alone() ? 0 : rank_of(communicator_); }
  MPI_Comm communicator() const { return communicator_; }

  // This rank's even share of rows numbered from 0; and the range of the rows it holds, numbered in order of rank.
  RowRange share_of(std::int64_t rows) const { return {rows, count(), number()}; }
  RowRange range_of(std::int64_t held) const {
    return alone() ? RowRange(held, 1, 0) : RowRange::of_rows(held, communicator_);
  }

  std::int64_t sum(std::int64_t value) const { return alone() ? value : sum_over_ranks(communicator_, value); }
  double largest(double value) const { return alone() ? value : max_over_ranks(communicator_, value); }
  double smallest(double value) const { return -largest(-value); }

  // Calls on_all_ranks(); a process alone throws the original error.
  void on_all(const std::function<void()>& work) const { alone() ? work() : on_all_ranks(communicator_, work); }

  // The rows of all ranks, in order of rank, on every rank. Rows are trivially copyable.
  template <typename Row>
  std::vector<Row> gathered(std::vector<Row> mine) const;

  // rows[i] to rank home[i] (mpi_session.hpp).
  template <typename Row>
  std::vector<Row> exchanged(std::vector<Row> rows, const std::vector<int>& home) const {
    return alone() ? std::move(rows) : exchange_rows(communicator_, std::move(rows), home);
  }

  // Passes `state` from rank to rank, from rank 0 on, each calling add(state); returns the last one on every rank. For
  // sums in the order of the rows with the bits that one process alone would give; it takes as long as that one would.
  template <typename State>
  State passed_on(State state, const std::function<void(State&)>& add) const;

private:
  MPI_Comm communicator_ = MPI_COMM_NULL;
};

template <typename Row>
std::vector<Row> Ranks::gathered(std::vector<Row> mine) const {
  static_assert(std::is_trivially_copyable_v<Row>);
  if (alone()) return mine;
  std::vector<std::int64_t> held(static_cast<std::size_t>(count()));
  const auto own = static_cast<std::int64_t>(mine.size());
  MPI_Allgather(&own, 1, MPI_INT64_T, held.data(), 1, MPI_INT64_T, communicator_);
  std::vector<int> counts, starts;
  std::int64_t sum = 0;
  for (const std::int64_t rows : held) {
    starts.push_back(mpi_count(sum));
    counts.push_back(mpi_count(rows));
    sum += rows;
  }
  std::vector<Row> all(static_cast<std::size_t>(mpi_count(sum)));
  MPI_Datatype row = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(sizeof(Row), MPI_BYTE, &row);
  MPI_Type_commit(&row);
  MPI_Allgatherv(mine.data(), mpi_count(own), row, all.data(), counts.data(), starts.data(), row, communicator_);
  MPI_Type_free(&row);
  return all;
}

template <typename State>
State Ranks::passed_on(State state, const std::function<void(State&)>& add) const {
  static_assert(std::is_trivially_copyable_v<State>);
  constexpr int tag = 0;
  const int me = number(), last = count() - 1;
  if (me > 0) MPI_Recv(&state, sizeof(State), MPI_BYTE, me - 1, tag, communicator_, MPI_STATUS_IGNORE);
  add(state);
  if (me < last) MPI_Send(&state, sizeof(State), MPI_BYTE, me + 1, tag, communicator_);
  if (!alone()) MPI_Bcast(&state, sizeof(State), MPI_BYTE, last, communicator_);
  return state;
}

}  // namespace thalweg
