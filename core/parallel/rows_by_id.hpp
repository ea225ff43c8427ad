// The rows of all grains in order of id, shared out among the ranks: for files that do not depend on the number of
// ranks and that no rank holds as a whole.
#pragma once

#include "core/parallel/row_range.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace thalweg {

// Rows in blocks of rows_per_block (the last may be shorter); whole blocks are shared evenly among the ranks.
class BlockShare {
public:
  BlockShare(std::int64_t rows, std::int64_t rows_per_block, int ranks)
      : rows_(rows), per_block_(rows_per_block), blocks_((rows + rows_per_block - 1) / rows_per_block), ranks_(ranks) {}

  std::int64_t rows() const { return rows_; }
  std::int64_t blocks() const { return blocks_; }

  // The blocks and the rows of a rank.
  RowRange blocks_of(int rank) const { return {blocks_, ranks_, rank}; }
  RowRange rows_of(int rank) const {
    RowRange range = blocks_of(rank);
    range.count = rows_;
    range.first = std::min(range.first * per_block_, rows_);
    range.last = std::min(range.last * per_block_, rows_);
    return range;
  }
  int rank_of(std::int64_t row) const { return rank_of_row(row / per_block_, blocks_, ranks_); }

private:
  std::int64_t rows_, per_block_, blocks_;
  int ranks_;
};

// Rows have a member `id`, and all ranks together have each id from 0 to share.rows() - 1 at most once. Returns the
// rows with the ids of share.rows_of(this rank), in their order. Collective.
template <typename Row>
std::vector<Row> rows_by_id(MPI_Comm communicator, std::vector<Row> rows, const BlockShare& share) {
  std::vector<int> home;
  home.reserve(rows.size());
  for (const Row& row : rows) home.push_back(share.rank_of(row.id));
  std::vector<Row> here = exchange_rows(communicator, std::move(rows), home);
  std::sort(here.begin(), here.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
  return here;
}

}  // namespace thalweg
