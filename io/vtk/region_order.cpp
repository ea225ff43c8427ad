#include "io/vtk/region_order.hpp"

#include "core/parallel/mpi_count.hpp"
#include "core/parallel/mpi_session.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace thalweg::io {
namespace {

// Calls visit(first, last) with the places in the region of every row of a block, in their order.
template <typename Visit>
void for_each_row(const Block& block, const Block& region, Visit visit) {
  const int length = block.upper[0] - block.lower[0];
  if (block.volume() == 0) return;
  for (int k = block.lower[2]; k < block.upper[2]; ++k)
    for (int j = block.lower[1]; j < block.upper[1]; ++j) {
      const std::int64_t first = region.location_of({block.lower[0], j, k});
      visit(first, first + length);
    }
}

// Counts as MPI takes them; also their sum, where the last one ends.
std::vector<int> mpi_counts(const std::vector<std::int64_t>& cells) {
  mpi_count(std::accumulate(cells.begin(), cells.end(), std::int64_t{0}));
  return {cells.begin(), cells.end()};
}

std::vector<int> starts_of(const std::vector<int>& counts) {
  std::vector<int> starts(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
  return starts;
}

}  // namespace

RegionOrder::RegionOrder(MPI_Comm communicator, std::vector<Block> parts, const Block& region, const BlockShare& share)
    : communicator_(communicator),
      parts_(std::move(parts)),
      region_(region),
      share_(share),
      mine_(share.rows_of(rank_of(communicator))),
      sent_(cells_to_ranks()),
      received_(cells_from_ranks()) {}

// Number of cells of this rank's part of the region for each rank. Its rows lie in the order of the file, so the cells
// for one rank lie together.
std::vector<int> RegionOrder::cells_to_ranks() const {
  const int ranks = size_of(communicator_);
  std::vector<std::int64_t> cells(static_cast<std::size_t>(ranks), 0);
  int to = 0;
  for_each_row(parts_[static_cast<std::size_t>(rank_of(communicator_))], region_,
               [&](std::int64_t first, std::int64_t last) {
                 while (first < last) {
                   while (share_.rows_of(to).last <= first) ++to;
                   const std::int64_t end = std::min(last, share_.rows_of(to).last);
                   cells[static_cast<std::size_t>(to)] += end - first;
                   first = end;
                 }
               });
  return mpi_counts(cells);
}

// Calls visit(first, last) for what a rank sends here, in the order in which it does.
template <typename Visit>
void RegionOrder::for_each_row_from(int rank, Visit visit) const {
  if (mine_.size() == 0) return;
  Block block = parts_[static_cast<std::size_t>(rank)];
  const Index3 n = region_.size();
  const std::int64_t plane = static_cast<std::int64_t>(n[0]) * n[1];
  block.lower[2] = std::max(block.lower[2], region_.lower[2] + static_cast<int>(mine_.first / plane));
  block.upper[2] = std::min(block.upper[2], region_.lower[2] + static_cast<int>((mine_.last - 1) / plane) + 1);
  for_each_row(block, region_, [&](std::int64_t first, std::int64_t last) {
    first = std::max(first, mine_.first);
    last = std::min(last, mine_.last);
    if (first < last) visit(first, last);
  });
}

std::vector<int> RegionOrder::cells_from_ranks() const {
  std::vector<std::int64_t> cells(parts_.size(), 0);
  for (std::size_t rank = 0; rank < cells.size(); ++rank)
    for_each_row_from(static_cast<int>(rank),
                      [&](std::int64_t first, std::int64_t last) { cells[rank] += last - first; });
  return mpi_counts(cells);
}

template <typename Number>
std::vector<Number> RegionOrder::exchanged(const std::vector<Number>& values, int components, MPI_Datatype type) const {
  std::vector<Number> arrived(static_cast<std::size_t>(mine_.size() * components));
  MPI_Datatype cell_type;
  MPI_Type_contiguous(components, type, &cell_type);
  MPI_Type_commit(&cell_type);
  MPI_Alltoallv(values.data(), sent_.data(), starts_of(sent_).data(), cell_type, arrived.data(), received_.data(),
                starts_of(received_).data(), cell_type, communicator_);
  MPI_Type_free(&cell_type);

  std::vector<Number> result(arrived.size());
  const Number* next = arrived.data();
  for (int rank = 0; rank < size_of(communicator_); ++rank)
    for_each_row_from(rank, [&](std::int64_t first, std::int64_t last) {
      const std::int64_t numbers = (last - first) * components;
      std::copy_n(next, numbers, result.begin() + static_cast<std::ptrdiff_t>((first - mine_.first) * components));
      next += numbers;
    });
  return result;
}

std::vector<double> RegionOrder::share_of(const std::vector<double>& values, int components) const {
  return exchanged(values, components, MPI_DOUBLE);
}
std::vector<float> RegionOrder::share_of(const std::vector<float>& values, int components) const {
  return exchanged(values, components, MPI_FLOAT);
}
std::vector<std::int32_t> RegionOrder::share_of(const std::vector<std::int32_t>& values, int components) const {
  return exchanged(values, components, MPI_INT32_T);
}

}  // namespace thalweg::io
